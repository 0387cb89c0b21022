// The synthetic rig's images: reproducible, as noisy as asked, and true to the solids.
#include "recon/synthetic/synthetic_rig.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/error.h"
#include "recon/synthetic/actors.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// A moment with hand, tongs, cable and pipe in view.
constexpr core::FrameIndex kBusyFrame = 180;

SyntheticRig DemoRig(SyntheticRigOptions options = {}) {
  return SyntheticRig(
      FourCameraRig(), [](double time_s) { return DemoSceneAt(time_s).objects; }, options);
}

bool SameImages(const FrameSet& a, const FrameSet& b) {
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    if (cv::norm(a.cameras[i].image_bgr, b.cameras[i].image_bgr, cv::NORM_INF) != 0.0) return false;
  }
  return a.cameras.size() == b.cameras.size();
}

TEST(SyntheticRig, AFrameIsAFunctionOfSeedAndIndexAlone) {
  SyntheticRig rig = DemoRig();
  const FrameSet first = rig.Read(kBusyFrame);
  (void)rig.Read(3);
  EXPECT_TRUE(SameImages(first, rig.Read(kBusyFrame))) << "whatever was read before";
  {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    SyntheticRig alone = DemoRig();
    EXPECT_TRUE(SameImages(first, alone.Read(kBusyFrame))) << "on one thread";
    EXPECT_EQ(alone.TrueMasks(alone.ObjectsAt(kBusyFrame)), rig.TrueMasks(rig.ObjectsAt(kBusyFrame)));
  }
  SyntheticRigOptions other_seed;
  other_seed.seed = 2;
  SyntheticRig other = DemoRig(other_seed);
  EXPECT_FALSE(SameImages(first, other.Read(kBusyFrame)));
  EXPECT_EQ(first.index, kBusyFrame);
  EXPECT_DOUBLE_EQ(first.time_s, 12.0) << "15 frames a second";
}

TEST(SyntheticRig, AnotherSceneBeforeTheSameCamerasIsAsOneMadeAnew) {
  SyntheticRig empty(FourCameraRig(), [](double) { return std::vector<SyntheticObject>(); });
  const auto demo = [](double time_s) { return DemoSceneAt(time_s).objects; };
  SyntheticRig shared = empty.Before(demo, 200, 0), anew = DemoRig();
  EXPECT_TRUE(SameImages(shared.Read(kBusyFrame), anew.Read(kBusyFrame)));
  EXPECT_FALSE(shared.TryRead(200, {}));
  const auto of_shared = shared.ReadBackgrounds({}, {}), of_anew = anew.ReadBackgrounds({}, {}),
             of_empty = empty.ReadBackgrounds({}, {});
  for (std::size_t i = 0; i < of_anew.size(); ++i) {
    EXPECT_EQ(cv::norm(of_shared[i].mean_bgr, of_anew[i].mean_bgr, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(of_empty[i].sigma_bgr, of_anew[i].sigma_bgr, cv::NORM_INF), 0.0);
    EXPECT_NE(of_shared[i].mean_bgr.data, of_empty[i].mean_bgr.data) << "nobody changes another's";
  }
  EXPECT_FALSE(SameImages(empty.Before(demo, 200, 1000).Read(kBusyFrame), anew.Read(kBusyFrame)))
      << "noise of its own";
}

TEST(SyntheticRig, TheBackgroundReferenceHasTheNoiseThatWasAskedFor) {
  SyntheticRigOptions options;
  options.noise_sigma_levels = 2.0;
  options.flicker_share = 0.0;
  SyntheticRig rig = DemoRig(options);
  const auto references = rig.ReadBackgrounds({}, {});
  ASSERT_EQ(references.size(), 4U);
  for (const BackgroundReference& reference : references) {
    EXPECT_EQ(reference.frames, options.background_frames);
    ASSERT_EQ(reference.mean_bgr.type(), CV_32FC3);
    // Rounding to whole levels adds 1/12 to the variance. A sample deviation of 30 has a bias of -0.9 %.
    const double expected = std::sqrt(4.0 + 1.0 / 12.0);
    EXPECT_NEAR(cv::mean(reference.sigma_bgr)[0], expected, 0.03 * expected);
    const cv::Scalar level = cv::mean(reference.mean_bgr);
    EXPECT_TRUE(level[0] > 15.0 && level[0] < 60.0) << "dark cloth and walls";
    cv::Mat texture;
    cv::meanStdDev(reference.mean_bgr, cv::noArray(), texture);
    EXPECT_GT(texture.at<double>(0), 2.0) << "a pattern, not a flat grey";
  }
}

TEST(SyntheticRig, FlickerChangesTheWholePictureByItsShareAtMost) {
  SyntheticRigOptions options;
  options.noise_sigma_levels = 0.0;
  options.flicker_share = 0.2;  // strong, so that rounding to whole levels doesn't hide it
  SyntheticRig rig(
      FourCameraRig(), [](double) { return std::vector<SyntheticObject>{}; }, options);
  double lowest = 1e9;
  double highest = 0.0;
  for (core::FrameIndex frame = 0; frame < 20; ++frame) {
    const double level = cv::mean(rig.Read(frame).cameras[0].image_bgr)[0];
    lowest = std::min(lowest, level);
    highest = std::max(highest, level);
  }
  EXPECT_GT(highest / lowest, 1.15);
  EXPECT_LT(highest / lowest, 1.2 / 0.8 + 0.02);
}

TEST(SyntheticRig, SegmentationByPlainSubtractionFindsTheTrueMask) {
  // Seven deviations of the noise and a few for the flicker; the darkest object is 40 levels off the
  // background.
  constexpr double kThresholdLevels = 14.0;
  SyntheticRig rig = DemoRig();
  const auto references = rig.ReadBackgrounds({}, {});
  for (const core::FrameIndex frame : {core::FrameIndex{20}, core::FrameIndex{70}, kBusyFrame}) {
    const FrameSet set = rig.Read(frame);
    const auto truth = rig.TrueMasks(rig.ObjectsAt(frame));
    for (std::size_t i = 0; i < set.cameras.size(); ++i) {
      ASSERT_GT(truth[i].CountObjectPixels(), 1500U);
      std::size_t wrong = 0;
      for (int y = 0; y < truth[i].height_px(); ++y) {
        for (int x = 0; x < truth[i].width_px(); ++x) {
          const cv::Vec3f difference = cv::Vec3f(set.cameras[i].image_bgr.at<cv::Vec3b>(y, x)) -
                                       references[i].mean_bgr.at<cv::Vec3f>(y, x);
          const bool object = cv::norm(difference, cv::NORM_INF) > kThresholdLevels;
          wrong += object != truth[i].At(x, y);
        }
      }
      EXPECT_EQ(wrong, 0U) << "frame " << frame << ", camera " << i;
    }
  }
}

TEST(SyntheticRig, APixelOfTheTrueMaskIsThereBecauseASolidProjectsToIt) {
  // The exact inverse of the lens and the angle between two directions decide, without any of the rig's code.
  constexpr int kStridePx = 5;  // the exact inverse of a lens is slow
  const core::Rig cameras = FourCameraRig();
  const SyntheticRig rig(cameras, [](double) { return std::vector<SyntheticObject>{}; });
  for (const Vector3d& center_in_world : {Vector3d(200.0, 100.0, 250.0), Vector3d(-120.0, -90.0, 60.0)}) {
    const std::vector<SyntheticObject> ball{
        {"ball",
         {{Sphere{30.0}, {Eigen::Matrix3d::Identity(), center_in_world}, Vector3d::Constant(200.0)}}}};
    const auto masks = rig.TrueMasks(ball);
    for (std::size_t i = 0; i < masks.size(); ++i) {
      const core::CameraModel& camera = cameras.cameras[i];
      std::size_t disagreements = 0;
      for (int y = 0; y < masks[i].height_px(); y += kStridePx) {
        for (int x = 0; x < masks[i].width_px(); x += kStridePx) {
          const Eigen::Vector2d normalised = camera.NormalisedFromPixel({x, y}).value();
          const Vector3d ray = camera.cam_from_world().rotation.transpose() *
                               Vector3d(normalised.x(), normalised.y(), 1.0).normalized();
          const Vector3d to_ball = center_in_world - camera.center_in_world();
          const bool hits = (to_ball - to_ball.dot(ray) * ray).norm() <= 30.0;
          disagreements += hits != masks[i].At(x, y);
        }
      }
      EXPECT_EQ(disagreements, 0U) << camera.name();
      const Eigen::Vector2d pixel = camera.Project(center_in_world).value();
      EXPECT_TRUE(
          masks[i].At(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))));
    }
  }
}

TEST(SyntheticRig, AShadowDarkensTheTableOnlyWhenAskedFor) {
  SyntheticRigOptions plain;
  plain.noise_sigma_levels = 0.0;
  plain.flicker_share = 0.0;
  SyntheticRigOptions shadowed = plain;
  shadowed.table_shadow = true;
  const auto ball = [](double) {
    return std::vector<SyntheticObject>{
        {"ball",
         {{Sphere{60.0}, {Eigen::Matrix3d::Identity(), Vector3d(0, 0, 100)}, Vector3d::Constant(220.0)}}}};
  };
  SyntheticRig without(FourCameraRig(), ball, plain);
  SyntheticRig with(FourCameraRig(), ball, shadowed);
  const cv::Mat difference =
      without.Read(0).cameras[0].image_bgr - with.Read(0).cameras[0].image_bgr;  // saturates at zero
  EXPECT_GT(cv::countNonZero(difference.reshape(1) > 8), 300);
  EXPECT_LT(cv::countNonZero(difference.reshape(1) > 8), 20000) << "a spot, not the whole table";
  EXPECT_EQ(cv::norm(without.Read(0).cameras[0].image_bgr(cv::Rect(0, 0, 50, 50)),
                     with.Read(0).cameras[0].image_bgr(cv::Rect(0, 0, 50, 50)), cv::NORM_INF),
            0.0);
}

TEST(SyntheticRig, BadFramesAndOptionsAreRefused) {
  SyntheticRigOptions options;
  options.frame_count = 5;
  SyntheticRig rig = DemoRig(options);
  EXPECT_EQ(rig.frame_count(), 5);
  EXPECT_NO_THROW((void)rig.Read(4));
  EXPECT_THROW((void)rig.Read(5), core::Error);
  EXPECT_THROW((void)rig.Read(-1), core::Error);
  options.noise_sigma_levels = -1.0;
  EXPECT_THROW((void)DemoRig(options), core::PreconditionError);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)rig.ReadBackgrounds({}, stop.get_token()), core::Error);
}

}  // namespace
}  // namespace elbowroom::recon
