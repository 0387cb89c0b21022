// What a frame's hull takes over from the frame before, and what it never makes.
#include <gtest/gtest.h>

#include "recon/contours/silhouette.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

class NextHullTest : public testing::Test {
 protected:
  explicit NextHullTest(core::UnseenPolicy unseen = core::UnseenPolicy::kOutside)
      : scene_(MakeRingScene(&random_, 4, unseen)), planes_(MakeUndistortedPlanes(*scene_.rig)) {
    for (const core::BitMask& mask : scene_.masks) masks_.push_back({mask, {}});
  }

  [[nodiscard]] FrameHull Next(const std::shared_ptr<const VisualHull>& last) const {
    return NextHull(last, scene_.rig, planes_, masks_);
  }
  void EmptyCamera(std::size_t camera) {
    masks_[camera].mask = core::BitMask(masks_[camera].mask.width_px(), masks_[camera].mask.height_px());
  }

  Random random_{8801};
  RandomScene scene_;
  UndistortedPlanes planes_;
  std::vector<core::SoftMask> masks_;
};

TEST_F(NextHullTest, OfUnchangedMasksIsTheHullItself) {
  const FrameHull first = Next(nullptr), second = Next(first.hull);
  EXPECT_EQ(first.stats.unchanged_silhouettes, 0);
  EXPECT_EQ(second.stats.unchanged_silhouettes, 4);
  EXPECT_EQ(second.hull, first.hull);
}

TEST_F(NextHullTest, KeepsTheSilhouettesThatHaventChanged) {
  const FrameHull first = Next(nullptr);
  masks_[2].mask.Set(3, 5, !masks_[2].mask.At(3, 5));
  const FrameHull second = Next(first.hull);
  EXPECT_EQ(second.stats.unchanged_silhouettes, 3);
  for (const std::size_t i : {0U, 1U, 3U})
    EXPECT_EQ(second.hull->silhouettes()[i], first.hull->silhouettes()[i]);
  const VisualHull afresh = MakeVisualHull(scene_.rig, planes_, masks_);
  const ViewRays view(scene_.rig->cameras[0]);
  EXPECT_EQ(ViewHull(*second.hull, view).depth_mm, ViewHull(afresh, view).depth_mm);
}

TEST_F(NextHullTest, MovedLevelsAreAChange) {
  masks_[1] = RandomLevels(&random_, masks_[1].mask);
  const FrameHull first = Next(nullptr);
  masks_[1].levels[0] ^= 1U;
  EXPECT_EQ(Next(first.hull).stats.unchanged_silhouettes, 3);
}

TEST_F(NextHullTest, AnEmptyCameraMakesAllContoursSuperfluous) {
  EmptyCamera(1);
  const FrameHull next = Next(nullptr);
  EXPECT_TRUE(next.hull->IsEmpty());
  EXPECT_EQ(next.stats.empty_silhouettes, 1);
  EXPECT_EQ(next.stats.untraced_silhouettes, 4);
  const HullView view = ViewHull(*next.hull, ViewRays(scene_.rig->cameras[0]));
  EXPECT_EQ(view.hit_pixels, 0);
  EXPECT_EQ(view.skipped_pixels, std::int64_t{view.width_px} * view.height_px);
  EXPECT_FALSE(next.hull->silhouettes()[0]->is_traced()) << "nor does a view need them";
}

class NextHullThatAbstains : public NextHullTest {
 protected:
  NextHullThatAbstains() : NextHullTest(core::UnseenPolicy::kAbstain) {}
};

TEST_F(NextHullThatAbstains, AnEmptyCameraStillHasASay) {
  EmptyCamera(1);
  const FrameHull next = Next(nullptr);
  EXPECT_EQ(next.stats.empty_silhouettes, 1);
  EXPECT_EQ(next.stats.untraced_silhouettes, 0);
}

}  // namespace
}  // namespace elbowroom::recon
