// The recon input on real recordings: an XviD rig of four cameras and rigs of ready masks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <opencv2/core.hpp>

#include "recon/footage/container_check.h"
#include "recon/footage/image_source.h"
#include "recon/footage/recorded_rig.h"
#include "recon/images/mask_image.h"
#include "recon/segmentation/frame_segmenter.h"
#include "recon/segmentation/segmentation.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/places.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::filesystem::path kData = test_support::SharedDataFolder();

class RealFootage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kData / "four_cameras" / "rig.yml")) {
      GTEST_SKIP() << "NOT TESTED on real footage: " << kData << " is absent";
    }
  }
};

TEST_F(RealFootage, AWholeVideoIsNeverCalledCutShort) {
  const RigFile rig_file = ReadRigFile(kData / "four_cameras" / "rig.yml");
  for (std::size_t i = 0; i < 4; ++i) {
    const core::CameraModel& camera = rig_file.rig.cameras[i];
    const auto background = OpenImageSource(rig_file.sources[i].background, camera);
    EXPECT_FALSE(background->Read(500).has_value()) << i;
    EXPECT_THAT(background->frame_count(), AllOf(::testing::Ge(132), ::testing::Le(133))) << i;
    const auto video = OpenImageSource(rig_file.sources[i].frames, camera);
    EXPECT_EQ(video->frame_count(), 428) << i;  // as promised
    EXPECT_FALSE(video->Read(427).has_value()) << i;
    EXPECT_EQ(video->frame_count(), 426) << i;
    EXPECT_EQ(video->Read(425).value().image_bgr.cols, 644) << i;
  }
}

TEST_F(RealFootage, AVideoCutAnywhereIsCalledCutShort) {
  const testing::TestFolder folder;
  const RigFile rig_file = ReadRigFile(kData / "four_cameras" / "rig.yml");
  for (std::size_t i = 0; i < 4; ++i) {
    for (const std::string& whole : {rig_file.sources[i].background, rig_file.sources[i].frames}) {
      for (const double share : {0.001, 0.03, 0.3, 0.6, 0.95}) {
        testing::CutFile(whole, folder.File("cut.avi"), share);
        const std::string message = testing::ErrorOf(ErrorKind::kFile, [&] {
          (void)OpenImageSource(folder.File("cut.avi"), rig_file.rig.cameras[i]);
        });
        EXPECT_THAT(message, AllOf(HasSubstr(rig_file.rig.cameras[i].name()), HasSubstr("cut.avi")));
        if (share >= 0.3) {
          EXPECT_THAT(message, AllOf(HasSubstr("breaks off at frame"), HasSubstr("promised")));
        }
      }
    }
  }
}

TEST_F(RealFootage, RandomAccessGivesTheSamePictureAsReadingOn) {
  RigFile rig_file = ReadRigFile(kData / "four_cameras" / "rig.yml");
  const auto source = OpenImageSource(rig_file.sources[2].frames, rig_file.rig.cameras[2]);
  const auto other = OpenImageSource(rig_file.sources[2].frames, rig_file.rig.cameras[2]);
  std::vector<cv::Mat> in_order;
  for (int i = 0; i < 120; ++i) in_order.push_back(source->Read(i).value().image_bgr);
  for (const int i : {117, 3, 0, 64, 65, 12}) {
    EXPECT_EQ(cv::norm(other->Read(i).value().image_bgr, in_order[static_cast<std::size_t>(i)], cv::NORM_INF),
              0.0)
        << i;
  }
}

TEST_F(RealFootage, SegmentationAgreesWithHandDrawnMasks) {
  // The figures are in docs/segmentation.md. The checkerboard that camera 3 alone shows is no part of the
  // hull, so that it is dropped; without that 0.88.
  constexpr double kLeastMeanIou = 0.91;
  constexpr double kLeastIou = 0.885;
  RecordedRig rig(ReadRigFile(kData / "four_cameras" / "rig.yml"));
  RecordedRig truth(ReadRigFile(kData / "four_cameras" / "hand_masks" / "rig.yml"));
  const FrameSegmenter segmenter(rig.ReadBackgrounds(core::Progress(), {}), SegmentationOptions(), rig.rig());
  const std::vector<core::SoftMask> masks = segmenter.SegmentSoft(rig.Read(0));
  const FrameSet drawn = truth.Read(0);
  double mean_iou = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    masks[i].Validate();
    const cv::Mat found = ImageFromMask(masks[i].mask);
    const cv::Mat wanted = ImageFromMask(drawn.cameras[i].ready_mask.value());
    const double iou =
        cv::countNonZero(found & wanted) / static_cast<double>(cv::countNonZero(found | wanted));
    RecordProperty("iou_" + std::to_string(i + 1), std::to_string(iou));
    EXPECT_GE(iou, kLeastIou) << "camera " << i + 1;
    mean_iou += iou / 4.0;
  }
  RecordProperty("mean_iou", std::to_string(mean_iou));
  EXPECT_GE(mean_iou, kLeastMeanIou);
}

TEST_F(RealFootage, AdaptiveHoldsTheMasksThroughAnExposureChange) {
  // The picture 15 % brighter: the masks must stay nearly those of the picture as it is. Measured 0.95 to
  // 0.98.
  constexpr double kLeastIou = 0.95;
  RecordedRig rig(ReadRigFile(kData / "four_cameras" / "rig.yml"));
  const auto backgrounds = rig.ReadBackgrounds(core::Progress(), {});
  const FrameSet frames = rig.Read(0);
  SegmentationOptions adaptive;
  adaptive.method = SegmentationMethod::kAdaptive;
  for (std::size_t i = 0; i < 4; ++i) {
    const cv::Mat& picture = frames.cameras[i].image_bgr;
    cv::Mat brighter;
    picture.convertTo(brighter, CV_8U, 1.15, -4.0);
    const Segmenter segmenter(backgrounds[i], adaptive);
    const cv::Mat plain = ImageFromMask(segmenter.Segment(picture));
    const cv::Mat followed = ImageFromMask(segmenter.Segment(brighter));
    EXPECT_GE(cv::countNonZero(plain & followed) / static_cast<double>(cv::countNonZero(plain | followed)),
              kLeastIou)
        << i;
  }
}

TEST_F(RealFootage, EveryRigOfReadyMasksIsRead) {
  for (const char* name : {"bunny6", "bunny36", "elephant", "teapot"}) {
    SCOPED_TRACE(name);
    RecordedRig rig(ReadRigFile(kData / name / "rig.yml"));
    EXPECT_EQ(rig.frame_count(), 1);
    const FrameSet set = rig.Read(0);
    for (const CameraFrame& camera : set.cameras) {
      ASSERT_TRUE(camera.ready_mask.has_value());
      EXPECT_GT(camera.ready_mask->CountObjectPixels(), 100U);
    }
    EXPECT_EQ(rig.rig().unseen == core::UnseenPolicy::kAbstain, std::string(name) == "bunny36");
  }
}

}  // namespace
}  // namespace elbowroom::recon
