// A frame set whose pictures aren't all there.
#include "recon/segmentation/frame_segmenter.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"
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

}  // namespace
}  // namespace elbowroom::recon
