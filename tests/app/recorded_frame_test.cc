// A frame that was recorded is the frame that was judged.
#include <gtest/gtest.h>

#include "app/control/demo_parts.h"
#include "app/control/frame_pipeline.h"
#include "app/control/recorded_frame.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "sessions/session_writer.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

constexpr core::FrameIndex kTouchingFrame = 60;  // the pipe is being lowered

// The demo, segmented from pictures with noise whose pixels on edges are mixed.
class RecordedFrameTest : public testing::Test {
 protected:
  static recon::SyntheticRigOptions Sensor() {
    recon::SyntheticRigOptions options;
    options.samples_per_pixel_side = 4;
    options.background_frames = 8;
    return options;
  }

  recon::SyntheticRig source_{recon::FourCameraRig(),
                              [](double time_s) { return recon::DemoSceneAt(time_s).objects; }, Sensor()};
  FramePipeline pipeline_{source_.rig(), DemoLayout(), source_.ReadBackgrounds({}, {}), {}};
  const std::vector<double> gap_{kGapInitialMm};
};

void ExpectSameContact(const core::PartContact& a, const core::PartContact& b) {
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.contact_area_mm2, b.contact_area_mm2);
  EXPECT_EQ(a.contact_point_count, b.contact_point_count);
  EXPECT_EQ(a.count.queries, b.count.queries);
  ASSERT_EQ(a.deepest.has_value(), b.deepest.has_value());
  if (a.deepest) {
    EXPECT_EQ(a.deepest->depth_mm, b.deepest->depth_mm);
    EXPECT_EQ(a.deepest->position_in_world_mm, b.deepest->position_in_world_mm);
  }
}

TEST_F(RecordedFrameTest, ComesBackWithTheSameHullToTheLastBit) {
  const test_support::TemporaryFolder folder;
  const SharedFrameResult judged = pipeline_.Process(source_.Read(kTouchingFrame), gap_);
  {
    core::SessionHeader header;
    header.rig = source_.rig();
    header.layout = DemoLayout();
    sessions::SessionWriter writer(folder / "s.db", header);
    writer.Append(judged->record);
    writer.Finish({});
  }
  const SharedFrameResult rebuilt = RebuildFrame(sessions::SessionReader(folder / "s.db"), kTouchingFrame);
  for (std::size_t i = 0; i < source_.rig().cameras.size(); ++i) {
    EXPECT_FALSE((*judged->record.masks)[i].levels.empty());
    EXPECT_EQ((*judged->record.masks)[i], (*rebuilt->record.masks)[i]);
    EXPECT_EQ(judged->hull->silhouettes()[i]->labels().contour().vertices,
              rebuilt->hull->silhouettes()[i]->labels().contour().vertices);
  }
  ASSERT_EQ(judged->record.contacts[1].verdict, core::Verdict::kContact);
  for (core::PartIndex i = 0; i < judged->record.contacts.size(); ++i) {
    const core::TriangleTree part(judged->layout->parts[i].mesh);
    const review::ContactOptions options;
    review::ReviewScratch scratch;
    scratch.stretches = review::ContactStretches::Make(part, options.point_spacing_mm);
    ExpectSameContact(judged->record.contacts[i],
                      review::FindContacts(*rebuilt->hull, part, rebuilt->world_from_parts[i], i, options,
                                           nullptr, &scratch));
  }
}

// The payload over the gap slides up while the pipe is lowered onto it.
TEST_F(RecordedFrameTest, APushedPartComesBackWhereItWas) {
  core::Layout layout = DemoLayout();
  layout.parts[1].recovery = {core::RecoveryKind::kSlider, {}, Eigen::Vector3d::UnitZ(), {}};
  layout.parts[1].gives_way = core::PushRule{};
  FramePipeline pipeline(source_.rig(), layout, source_.ReadBackgrounds({}, {}), {});
  const test_support::TemporaryFolder folder;
  core::SessionHeader header;
  header.rig = source_.rig();
  header.layout = layout;
  sessions::SessionWriter writer(folder / "s.db", header);
  SharedFrameResult judged;
  for (core::FrameIndex frame = kTouchingFrame - 2; frame <= kTouchingFrame; ++frame) {
    judged = pipeline.Process(source_.Read(frame), gap_);
    writer.Append(judged->record);
  }
  writer.Finish({});
  ASSERT_EQ(judged->record.rest_from_parts.size(), layout.parts.size());
  EXPECT_GT(judged->record.rest_from_parts[1].translation_mm.norm(), 1.0);
  const SharedFrameResult rebuilt = RebuildFrame(sessions::SessionReader(folder / "s.db"), kTouchingFrame);
  EXPECT_EQ(rebuilt->world_from_parts, judged->world_from_parts);
  EXPECT_EQ(rebuilt->layout->parts[1].gives_way, layout.parts[1].gives_way);
}

TEST_F(RecordedFrameTest, ABoundaryThatMovesBetweenTwoPixelsIsAChange) {
  recon::FrameSet frames = source_.Read(kTouchingFrame);
  const SharedFrameResult first = pipeline_.Process(frames, gap_);
  // Other grey levels in one pixel that is neither all object nor nearly background: no label changes.
  const core::SoftMask& before = (*first->record.masks)[2];
  const core::BitMask boundary = core::BoundaryPixels(before.mask);
  cv::Mat picture = frames.cameras[2].image_bgr.clone();
  std::size_t next = 0;
  for (int y = 0, changed = 0; y < picture.rows && changed == 0; ++y) {
    for (int x = 0; x < picture.cols && changed == 0; ++x) {
      if (!boundary.At(x, y)) continue;
      const std::uint8_t level = before.levels[next++];
      if (level < 170 || level > 220) continue;
      for (int i = 0; i < 3; ++i) picture.at<cv::Vec3b>(y, x)[i] ^= 4U;
      ++changed;
    }
  }
  frames.cameras[2].image_bgr = picture;
  const SharedFrameResult second = pipeline_.Process(frames, gap_);
  ASSERT_EQ((*second->record.masks)[2].mask, before.mask);
  ASSERT_NE((*second->record.masks)[2].levels, before.levels);
  EXPECT_EQ(second->skipped.hull.unchanged_silhouettes, 3);
  EXPECT_EQ(second->skipped.segmentation.pixels, 4 * 640 * 480);
  EXPECT_GT(second->skipped.segmentation.skipped_pixels, 4 * 640 * 480 / 4) << "most of the table is empty";
  EXPECT_NE(second->hull, first->hull);
  EXPECT_NE(second->hull->silhouettes()[2]->labels().contour().vertices,
            first->hull->silhouettes()[2]->labels().contour().vertices);
}

}  // namespace
}  // namespace elbowroom::control
