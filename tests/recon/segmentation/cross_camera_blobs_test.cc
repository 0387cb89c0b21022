#include "recon/segmentation/cross_camera_blobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "recon/segmentation/mask_regions.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::recon {
namespace {

std::vector<const core::BitMask*> Pointers(const std::vector<core::BitMask>& masks) {
  std::vector<const core::BitMask*> pointers;
  for (const core::BitMask& mask : masks) pointers.push_back(&mask);
  return pointers;
}

void Draw(core::BitMask& mask, int x0, int y0, int width, int height) {
  for (int y = std::max(y0, 0); y < std::min(y0 + height, mask.height_px()); ++y)
    for (int x = std::max(x0, 0); x < std::min(x0 + width, mask.width_px()); ++x) mask.Set(x, y, true);
}

// A hand at work, seen by four cameras.
std::vector<core::BitMask> HandMasks(const core::Rig& rig) {
  const SyntheticRig simulated(rig, [](double time_s) { return DemoSceneAt(time_s).objects; });
  return simulated.TrueMasks(simulated.ObjectsAt(100));
}

TEST(CrossCameraBlobs, DropsWhatOneCameraAloneSees) {
  const core::Rig rig = FourCameraRig();
  std::vector<core::BitMask> masks = HandMasks(rig);
  const CrossCameraBlobs cross_camera_blobs(rig);
  for (const ConfirmedBlobs& camera : cross_camera_blobs.Confirm(Pointers(masks)))
    EXPECT_EQ(std::ranges::count(camera.is_confirmed, false), 0) << "all cameras see the hand";
  Draw(masks[1], 2, 2, 25, 25);  // in the picture's corner, far from the hand
  const auto blobs = cross_camera_blobs.Confirm(Pointers(masks));
  EXPECT_EQ(std::ranges::count(blobs[1].is_confirmed, false), 1);
  EXPECT_FALSE(blobs[1].is_confirmed.front()) << "regions are in the order of their first rows";
  EXPECT_EQ(std::ranges::count(blobs[0].is_confirmed, false), 0);
}

TEST(CrossCameraBlobs, KeepsEverythingWhereNothingIsConfirmed) {
  const core::Rig rig = FourCameraRig();
  std::vector<core::BitMask> masks(4, core::BitMask(640, 480));
  Draw(masks[0], 300, 200, 50, 50);
  EXPECT_EQ(CrossCameraBlobs(rig).Confirm(Pointers(masks))[0].is_confirmed, std::vector<bool>{true});
  EXPECT_THROW((void)CrossCameraBlobs(rig).Confirm({}), core::PreconditionError);
}

// The certificate: points of the hull stay in it, whatever blobs there are and whoever can't see them.
TEST(CrossCameraBlobs, NeverTakesAPointFromTheHull) {
  std::mt19937 random(11);
  std::size_t dropped = 0, inside = 0;
  for (int round = 0; round < 40; ++round) {
    core::Rig rig = FourCameraRig();
    if (round % 2 == 1) rig.unseen = core::UnseenPolicy::kAbstain;
    if (round % 4 >= 2) rig.workspace_mm.max() *= 3.0;  // reaches past cameras, and out of their pictures
    std::vector<core::BitMask> masks(4, core::BitMask(640, 480));
    for (core::BitMask& mask : masks) {
      for (int i = 0; i < 6; ++i) {
        Draw(mask, static_cast<int>(random() % 640U), static_cast<int>(random() % 480U),
             5 + static_cast<int>(random() % 90U), 5 + static_cast<int>(random() % 90U));
      }
    }
    const auto blobs = CrossCameraBlobs(rig).Confirm(Pointers(masks));
    const auto shared_rig = std::make_shared<const core::Rig>(rig);
    const VisualHull before = MakeVisualHull(shared_rig, masks);
    for (std::size_t c = 0; c < masks.size(); ++c) {
      dropped += static_cast<std::size_t>(std::ranges::count(blobs[c].is_confirmed, false));
      ClearRegions(masks[c], blobs[c].blobs, blobs[c].is_confirmed);
    }
    const VisualHull after = MakeVisualHull(shared_rig, masks);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int i = 0; i < 20'000; ++i) {
      const Eigen::Vector3d at(share(random), share(random), share(random));
      const Eigen::Vector3d x_in_world = rig.workspace_mm.min() + at.cwiseProduct(rig.workspace_mm.sizes());
      inside += before.Contains(x_in_world) ? 1 : 0;
      ASSERT_EQ(before.Contains(x_in_world), after.Contains(x_in_world)) << "round " << round;
    }
  }
  EXPECT_GT(dropped, 20U) << "or the test shows nothing";
  EXPECT_GT(inside, 100U);
}

}  // namespace
}  // namespace elbowroom::recon
