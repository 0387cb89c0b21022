// A frame set whose pictures aren't all there.
#include "recon/segmentation/frame_segmenter.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::recon {
namespace {

constexpr std::size_t kMissing = 1;

class MissingPicture : public testing::Test {
 protected:
  MissingPicture()
      : source_(FourCameraRig(), [](double time_s) { return DemoSceneAt(time_s).objects; }),
        segmenter_(source_.ReadBackgrounds({}, {}), {}, source_.rig()),
        frames_(source_.Read(100)) {}

  void Stamp() {
    for (CameraFrame& camera : frames_.cameras) camera.stamp = core::CameraStamp{7, frames_.time_s};
  }

  SyntheticRig source_;
  FrameSegmenter segmenter_;
  FrameSet frames_;
};

TEST_F(MissingPicture, IsAllObjectAndLeavesTheOtherCamerasMasksAsTheyAre) {
  Stamp();
  const std::vector<core::SoftMask> whole = segmenter_.SegmentSoft(frames_);
  frames_.cameras[kMissing] = {};
  const std::vector<core::SoftMask> masks = segmenter_.SegmentSoft(frames_);
  const std::vector<core::BitMask> bits = segmenter_.Segment(frames_);
  core::BitMask all_object = whole[kMissing].mask;
  all_object.SetAll();
  EXPECT_EQ(masks[kMissing], (core::SoftMask{all_object, {}}));
  EXPECT_EQ(bits[kMissing], all_object);
  for (std::size_t i = 0; i < masks.size(); ++i) {
    if (i == kMissing) continue;
    // A camera less confirms more blobs, never fewer.
    for (int y = 0; y < whole[i].mask.height_px(); ++y)
      for (int x = 0; x < whole[i].mask.width_px(); ++x)
        ASSERT_LE(whole[i].mask.At(x, y), masks[i].mask.At(x, y)) << i;
  }
}

TEST_F(MissingPicture, OfFootageWithoutStampsIsACallersBug) {
  frames_.cameras[kMissing] = {};
  EXPECT_ANY_THROW((void)segmenter_.SegmentSoft(frames_));
  std::vector<BackgroundReference> ready(4);
  const FrameSegmenter of_masks(ready, {}, source_.rig());
  FrameSet masks;
  for (core::BitMask& mask : source_.TrueMasks(source_.ObjectsAt(100)))
    masks.cameras.push_back({{}, std::move(mask)});
  masks.cameras[kMissing] = {};
  EXPECT_THROW((void)of_masks.SegmentSoft(masks), core::PreconditionError);
}

TEST_F(MissingPicture, AReadyMaskOrAPictureWithoutAStampIsNotMissing) {
  Stamp();
  const std::vector<core::SoftMask> whole = segmenter_.SegmentSoft(frames_);
  frames_.cameras[kMissing].stamp.reset();
  EXPECT_EQ(segmenter_.SegmentSoft(frames_), whole);
  frames_.cameras[kMissing] = {{}, whole[kMissing].mask};
  EXPECT_EQ(segmenter_.SegmentSoft(frames_)[kMissing].mask, whole[kMissing].mask);
}

// A rod of 7 mm that points at one camera, for which it is a blob far below min_blob_px. Of the others one
// may see less than that, too.
class PointedAt : public testing::TestWithParam<std::size_t> {
 protected:
  static constexpr double kRadiusMm = 3.5, kLengthMm = 160.0;

  PointedAt()
      : rig_(FourCameraRig()),
        eye_(rig_.cameras[GetParam()].center_in_world()),
        end_(rig_.workspace_mm.center() + Eigen::Vector3d(0.0, 0.0, -40.0)),
        source_(rig_, [this](double) { return Objects(); }) {}

  [[nodiscard]] std::vector<SyntheticObject> Objects() const {
    const Eigen::Vector3d along = (eye_ - end_).normalized();
    Eigen::Matrix3d rotation;
    rotation.col(2) = along;
    rotation.col(0) = along.unitOrthogonal();
    rotation.col(1) = along.cross(rotation.col(0));
    return {
        {"rod", {{Tube{kRadiusMm, 0.0, kLengthMm}, {rotation, end_}, Eigen::Vector3d(90.0, 200.0, 235.0)}}}};
  }

  core::Rig rig_;
  Eigen::Vector3d eye_, end_;
  SyntheticRig source_;
};

TEST_P(PointedAt, ARodKeepsItsHull) {
  const FrameSet frames = source_.Read(0);
  const FrameSegmenter segmenter(source_.ReadBackgrounds({}, {}), {}, rig_);
  SegmentationStats stats;
  const std::vector<core::SoftMask> masks = segmenter.SegmentSoft(frames, &stats);
  const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig_), masks);
  const Eigen::Vector3d along = (eye_ - end_).normalized();
  int inside = 0;
  constexpr int kPlaces = 40;
  for (int i = 0; i < kPlaces; ++i)
    inside += hull.Contains(end_ + along * (kLengthMm * (i + 0.5) / kPlaces)) ? 1 : 0;
  EXPECT_GE(inside, kPlaces - 2);  // an end may lie on a boundary
  EXPECT_GE(stats.second_looks, 1);
}

INSTANTIATE_TEST_SUITE_P(Cameras, PointedAt, testing::Values(0U, 1U, 2U, 3U));

// The demo's hand with its pipe, cable and tongs: parts of them are blobs that not all cameras see.
TEST(SecondLook, IsRareOfAHandAtWork) {
  SyntheticRig source(FourCameraRig(), [](double time_s) { return DemoSceneAt(time_s).objects; });
  const FrameSegmenter segmenter(source.ReadBackgrounds({}, {}), {}, source.rig());
  SegmentationStats stats;
  constexpr core::FrameIndex kStep = 40;
  std::int64_t pictures = 0;
  for (core::FrameIndex frame = kStep; frame < 400; frame += kStep, pictures += 4)
    (void)segmenter.SegmentSoft(source.Read(frame), &stats);
  EXPECT_LE(stats.second_looks, pictures / 6);
}

}  // namespace
}  // namespace elbowroom::recon
