// The demo's parts are sound CAD, and the demo's story holds on them: at 140 mm the task touches payload A,
// at 240 mm the hull of what is real (with all that it over-estimates) touches nothing.
#include "app/control/demo_parts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::control {
namespace {

using core::BitMask;
using Eigen::Vector3d;

// Of the regular 64-gon that stands for a circle.
double RoundArea(double radius_mm) {
  return 32.0 * std::sin(std::numbers::pi / 32.0) * radius_mm * radius_mm;
}

TEST(DemoParts, AreClosedAndHaveTheVolumesOfTheirDrawings) {
  constexpr double kShare = 1e-9;
  const double pmt = 300.0 * 300.0 * 120.0 - RoundArea(50.0) * 100.0 + RoundArea(15.0) * 8.0;
  const double a = 320.0 * 320.0 * 10.0 + 260.0 * 260.0 * 100.0 + RoundArea(70.0) * 50.0;
  const double b =
      130.0 * 300.0 * 10.0 + 110.0 * 240.0 * 160.0 + RoundArea(40.0) * 30.0 - RoundArea(25.0) * 15.0;
  EXPECT_TRUE(core::IsWatertight(PmtBox()));
  EXPECT_TRUE(core::IsWatertight(PayloadA()));
  EXPECT_TRUE(core::IsWatertight(PayloadB()));
  EXPECT_NEAR(core::VolumeMm3(PmtBox()), pmt, kShare * pmt);
  EXPECT_NEAR(core::VolumeMm3(PayloadA()), a, kShare * a);
  EXPECT_NEAR(core::VolumeMm3(PayloadB()), b, kShare * b);
}

TEST(DemoParts, TheLayoutStandsOnTheTableWithTheGapThatItNames) {
  const core::Layout layout = DemoLayout();
  const auto spacing = layout.FindSpacing("payload_a_gap");
  ASSERT_TRUE(spacing && layout.FindPart("payload_a") && layout.FindPart("pmt") &&
              layout.FindPart("payload_b"));
  for (const double gap_mm : {60.0, kGapInitialMm, kGapNeededMm, 400.0}) {
    const auto poses = core::PosesAt(layout, std::vector<double>{gap_mm});
    std::vector<Eigen::AlignedBox3d> bounds;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      bounds.push_back(core::BoundsOf(*layout.parts[i].mesh, poses[i]));
    }
    EXPECT_NEAR(bounds[*layout.FindPart("payload_a")].min().z() - bounds[*layout.FindPart("pmt")].max().z(),
                gap_mm, 1e-9);
    EXPECT_NEAR(bounds[*layout.FindPart("pmt")].min().z(), 0.0, 1e-9);
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      for (std::size_t k = i + 1; k < bounds.size(); ++k) EXPECT_FALSE(bounds[i].intersects(bounds[k]));
    }
  }
}

// Points every `spacing_mm` or closer on the part's surface, moved outwards by `offset_mm`, in the world.
std::vector<Vector3d> SurfacePoints(const core::Part& part, const core::RigidTransform& world_from_part,
                                    double spacing_mm, double offset_mm) {
  const core::TriangleMesh mesh = core::Transformed(*part.mesh, world_from_part);
  std::vector<Vector3d> points;
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t i) {
      return mesh.vertices_mm[static_cast<std::size_t>(triangle[i])];
    };
    const Vector3d u = corner(1) - corner(0);
    const Vector3d v = corner(2) - corner(0);
    const Vector3d offset = offset_mm * u.cross(v).normalized();
    const int along_u = std::max(1, static_cast<int>(std::ceil(u.norm() / spacing_mm)));
    const int along_v = std::max(1, static_cast<int>(std::ceil(v.norm() / spacing_mm)));
    for (int i = 0; i <= along_u; ++i) {
      for (int k = 0; k <= along_v; ++k) {
        const double s = static_cast<double>(i) / along_u;
        const double t = (1.0 - s) * k / along_v;  // ever closer towards the triangle's corner
        points.push_back(corner(0) + s * u + t * v + offset);
      }
    }
  }
  return points;
}

// Where one point falls in every camera's picture.
using PixelOfCamera = std::vector<Eigen::Vector2i>;

// Nearest pixels; nothing if some camera doesn't see the point, which then is outside the hull.
std::optional<PixelOfCamera> PixelsOf(const core::Rig& rig, const Vector3d& x_in_world) {
  PixelOfCamera pixels;
  for (const core::CameraModel& camera : rig.cameras) {
    const auto pixel = camera.Project(x_in_world);
    if (!pixel) return std::nullopt;
    pixels.emplace_back(static_cast<int>(std::lround(pixel->x())), static_cast<int>(std::lround(pixel->y())));
    const Eigen::Vector2i& last = pixels.back();
    const bool seen =
        last.x() >= 0 && last.y() >= 0 && last.x() < camera.width_px() && last.y() < camera.height_px();
    if (!seen) return std::nullopt;
  }
  return pixels;
}

// The hull as the paper defines it: an object pixel in every camera.
bool InHull(const std::vector<BitMask>& masks, const PixelOfCamera& pixels) {
  for (std::size_t i = 0; i < masks.size(); ++i) {
    if (!masks[i].At(pixels[i].x(), pixels[i].y())) return false;
  }
  return true;
}

BitMask Segmented(const cv::Mat& image_bgr, const recon::BackgroundReference& background) {
  constexpr double kThresholdLevels = 10.0;  // six deviations of the noise: a few wrong pixels a picture
  BitMask mask(image_bgr.cols, image_bgr.rows);
  for (int y = 0; y < image_bgr.rows; ++y) {
    for (int x = 0; x < image_bgr.cols; ++x) {
      const cv::Vec3f difference =
          cv::Vec3f(image_bgr.at<cv::Vec3b>(y, x)) - background.mean_bgr.at<cv::Vec3f>(y, x);
      if (cv::norm(difference, cv::NORM_INF) > kThresholdLevels) mask.Set(x, y, true);
    }
  }
  return mask;
}

// The demo's parts at one gap, as surface points already projected into the cameras of a rig.
class ProbedParts {
 public:
  ProbedParts(const core::Rig& rig, const core::Layout& layout, double gap_mm, double offset_mm) {
    constexpr double kSpacingMm = 4.0;  // about half the thinnest thing in the scene, the cable
    const auto poses = core::PosesAt(layout, std::vector<double>{gap_mm});
    for (std::size_t i = 0; i < poses.size(); ++i) {
      pixels_.emplace_back();
      for (const Vector3d& x_in_world : SurfacePoints(layout.parts[i], poses[i], kSpacingMm, offset_mm)) {
        if (auto pixels = PixelsOf(rig, x_in_world)) pixels_.back().push_back(std::move(*pixels));
      }
    }
  }

  // Points in the hull, one count a part, in the layout's order.
  [[nodiscard]] std::vector<std::size_t> Touched(const std::vector<BitMask>& masks) const {
    std::vector<std::size_t> counts;
    for (const auto& part : pixels_) {
      counts.push_back(static_cast<std::size_t>(
          std::ranges::count_if(part, [&](const PixelOfCamera& pixels) { return InHull(masks, pixels); })));
    }
    return counts;
  }

 private:
  std::vector<std::vector<PixelOfCamera>> pixels_;
};

recon::SyntheticRig DemoRig(core::Rig rig) {
  return recon::SyntheticRig(std::move(rig),
                             [](double time_s) { return recon::DemoSceneAt(time_s).objects; });
}

// The demo on the rig that it runs on.
class DemoHull : public testing::Test {
 protected:
  core::Layout layout_ = DemoLayout();
  core::PartIndex payload_a_ = layout_.FindPart("payload_a").value();
  recon::SyntheticRig rig_ = DemoRig(recon::FourCameraRig());
};

constexpr core::FrameIndex kTaskFrames = 240;  // at the rig's 15 a second
// How far every part keeps from the hull at 240 mm; far more than a pixel's 2 mm.
constexpr double kMarginMm = 10.0;

void ExpectNothingNear(recon::SyntheticRig& rig, core::FrameIndex every) {
  const core::Layout layout = DemoLayout();
  std::vector<ProbedParts> shells;  // a part grown by up to the margin, so that no thin thing slips between
  for (const double share : {0.0, 0.5, 1.0})
    shells.emplace_back(rig.rig(), layout, kGapNeededMm, share * kMarginMm);
  for (core::FrameIndex frame = 0; frame < kTaskFrames; frame += every) {
    const auto masks = rig.TrueMasks(rig.ObjectsAt(frame));
    for (std::size_t shell = 0; shell < shells.size(); ++shell) {
      const auto touched = shells[shell].Touched(masks);
      for (std::size_t part = 0; part < touched.size(); ++part) {
        EXPECT_EQ(touched[part], 0U) << layout.parts[part].name << ", shell " << shell << ", frame " << frame;
      }
    }
  }
}

TEST_F(DemoHull, At240MillimetresNothingComesNearAnyPartInAnyFrame) { ExpectNothingNear(rig_, 1); }

TEST(DemoHullOfEightCameras, At240MillimetresNothingComesNearAnyPart) {
  recon::SyntheticRig rig = DemoRig(recon::EightCameraRig());
  ExpectNothingNear(rig, 6);
}

TEST_F(DemoHull, At140MillimetresPayloadAIsTouchedByPipeAndTongsAndNothingElseIs) {
  const ProbedParts parts(rig_.rig(), layout_, kGapInitialMm, 0.0);
  core::FrameIndex frames_with_pipe = 0;
  core::FrameIndex frames_with_tongs = 0;
  std::size_t most_points = 0;
  for (core::FrameIndex frame = 0; frame < kTaskFrames; ++frame) {
    const auto touched = parts.Touched(rig_.TrueMasks(rig_.ObjectsAt(frame)));
    for (std::size_t part = 0; part < touched.size(); ++part) {
      if (part == payload_a_) continue;
      EXPECT_EQ(touched[part], 0U) << layout_.parts[part].name << " in frame " << frame;
    }
    most_points = std::max(most_points, touched[payload_a_]);
    const bool tongs = recon::DemoSceneAt(rig_.TimeOfFrameS(frame)).tongs_in_use;
    if (touched[payload_a_] > 0) ++(tongs ? frames_with_tongs : frames_with_pipe);
  }
  RecordProperty("frames_with_pipe", static_cast<int>(frames_with_pipe));
  RecordProperty("frames_with_tongs", static_cast<int>(frames_with_tongs));
  EXPECT_GT(frames_with_pipe, kTaskFrames / 5);
  EXPECT_GT(frames_with_tongs, kTaskFrames / 5);
  EXPECT_LT(frames_with_pipe + frames_with_tongs, kTaskFrames * 9 / 10) << "clear while nobody reaches in";
  EXPECT_GT(most_points, 100U);
}

TEST_F(DemoHull, At140MillimetresTheRealPipeItselfWouldHitPayloadA) {
  const auto poses = core::PosesAt(layout_, std::vector<double>{kGapInitialMm});
  const auto points = SurfacePoints(layout_.parts[payload_a_], poses[payload_a_], 2.0, 0.0);
  auto objects = recon::DemoSceneAt(4.0).objects;
  std::erase_if(objects, [](const recon::SyntheticObject& object) { return object.name != "pipe"; });
  const auto inside =
      std::ranges::count_if(points, [&](const Vector3d& x) { return recon::Contains(objects, x); });
  EXPECT_GT(inside, 0) << "not only the hull's excess";
}

TEST_F(DemoHull, TheStoryHoldsOnSegmentedNoisyImages) {
  constexpr core::FrameIndex kEvery = 6;
  const ProbedParts at_140(rig_.rig(), layout_, kGapInitialMm, 0.0);
  const ProbedParts at_240(rig_.rig(), layout_, kGapNeededMm, 0.5 * kMarginMm);
  const auto backgrounds = rig_.ReadBackgrounds({}, {});
  core::FrameIndex touched_at_140 = 0;
  for (core::FrameIndex frame = 0; frame < kTaskFrames; frame += kEvery) {
    const recon::FrameSet set = rig_.Read(frame);
    std::vector<BitMask> masks;
    for (std::size_t i = 0; i < backgrounds.size(); ++i) {
      masks.push_back(Segmented(set.cameras[i].image_bgr, backgrounds[i]));
    }
    const auto touched = at_240.Touched(masks);
    EXPECT_EQ(*std::ranges::max_element(touched), 0U) << "frame " << frame;
    touched_at_140 += at_140.Touched(masks)[payload_a_] > 0;
  }
  EXPECT_GT(touched_at_140, kTaskFrames / kEvery / 3);
}

}  // namespace
}  // namespace elbowroom::control
