#include "recon/exact_view/tile_cast.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cstring>
#include <vector>

#include "recon/exact_view/cast_intervals.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

// Every kind of processor that this one can stand in for, one at a time.
template <typename Run>
int ForEachTarget(const Run& run) {
  int targets = 0;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    run(left & -left);
    ++targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  return targets;
}

TEST(CastTile, GivesTheSameBitsOnEveryTarget) {
  Random random(5501);
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    const RandomScene scene = MakeRingScene(&random, 4, unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    core::CameraCalibration c;
    c.image_width_px = 101, c.image_height_px = 77;
    c.camera_matrix << 110.0, 0.0, 50.0, 0.0, 110.0, 38.0, 0.0, 0.0, 1.0;
    c.cam_from_world = core::CamFromWorldLookingAt({500, 300, 200}, {0, 0, 0});
    const ViewRays rays{core::CameraModel(c)};
    const HullView best = ViewHull(hull, rays);
    EXPECT_GT(best.hit_pixels, 300);
    const int targets = ForEachTarget([&](std::int64_t target) {
      const HullView view = ViewHull(hull, rays);
      EXPECT_EQ(0, std::memcmp(view.depth_mm.data(), best.depth_mm.data(), 4 * best.depth_mm.size()))
          << hwy::TargetName(target);
      EXPECT_TRUE(view.surface == best.surface) << hwy::TargetName(target);
    });
    EXPECT_GE(targets, 2) << "the portable one and this processor's";
    RecordProperty("targets", targets);
  }
}

// Crossings of rays at angle 0, entries from the first on and exits in turn.
CastPencil PencilOf(const std::vector<float>& keys) {
  CastPencil pencil;
  pencil.x = {0.0F, 0.0F, 1.0F};
  std::vector<EdgeOrder> orders;
  for (const float key : keys) {
    const auto number = static_cast<std::uint32_t>(orders.size());
    pencil.edges.push_back({-0.5F, 0.5F, {0.0F, 0.0F, key}, number, number % 2 == 0});
    orders.push_back({key, 0.0});
  }
  (void)FillIntervals(orders, &pencil);
  return pencil;
}

// Rays by hand: in by an entry, out, and in again behind the second camera's entry.
TEST(CastTile, FindsTheFirstKeyAtWhichAllAgree) {
  constexpr std::uint32_t kAllRays = (1U << kTileRays) - 1;
  TileRays rays;
  for (int i = 0; i < kTileRays; ++i) rays.u[i] = rays.v[i] = 0.0F;
  const CastBox box{{{0.0F, 0.0F, -10.0F}}, {{0.0F, 0.0F, -0.1F}}, {}};
  const CastPencil twice = PencilOf({-9.0F, -6.0F, -3.0F}), once = PencilOf({-5.0F}), none = PencilOf({});
  ForEachTarget([&](std::int64_t target) {
    SCOPED_TRACE(hwy::TargetName(target));
    TileScratch scratch;
    TileHits hits;
    const auto cast = [&](const CastPencil& a, std::uint32_t a_inside, const CastPencil& b,
                          std::uint32_t b_inside) {
      const std::array<TileCamera, 2> cameras{{{&a, a_inside}, {&b, b_inside}}};
      CastTile(rays, box, cameras, {}, true, &scratch, &hits);
    };
    cast(twice, 0, once, 0);
    for (int i = 0; i < kTileRays; ++i) {
      ASSERT_EQ(hits.depth_mm[i], 1.0F / 3.0F);
      ASSERT_EQ(hits.camera[i], 0);
      ASSERT_EQ(twice.edges[static_cast<std::size_t>(hits.edge[i])].edge, 2U);
    }
    // Inside from the start: a face of the workspace.
    cast(none, kAllRays, none, kAllRays);
    EXPECT_EQ(hits.depth_mm[15], 1.0F / 10.0F);
    EXPECT_EQ(hits.camera[15], TileHits::kNoCamera);
    // One ray of them starts outside, and enters nothing.
    cast(none, kAllRays, none, kAllRays & ~(1U << 7U));
    EXPECT_EQ(hits.depth_mm[6], 1.0F / 10.0F);
    EXPECT_EQ(hits.depth_mm[7], 0.0F);
    EXPECT_EQ(hits.count, kTileRays - 1);
  });
}

}  // namespace
}  // namespace elbowroom::recon
