#include "recon/tile_cast.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstring>
#include <vector>

#include "recon/hull_view.h"
#include "tests/recon/random_scene.h"

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
      for (std::size_t i = 0; i < best.surface.size(); ++i) {
        ASSERT_EQ(view.surface[i].camera, best.surface[i].camera) << hwy::TargetName(target);
        ASSERT_EQ(view.surface[i].edge, best.surface[i].edge) << hwy::TargetName(target);
      }
    });
    EXPECT_GE(targets, 2) << "the portable one and this processor's";
    RecordProperty("targets", targets);
  }
}

// One ray by hand: in by an entry, out, and in again behind the second camera's entry.
TEST(CastTile, FindsTheFirstKeyAtWhichAllAgree) {
  const auto edge = [](float key, std::uint32_t index) {
    TileEdge e;
    e.key.at_centre = key, e.edge = index;
    return e;
  };
  const auto entry = [&](float key, std::uint32_t index) {
    TileEdge e = edge(key, index);
    e.from.at_centre = 1.0F, e.to.at_centre = -1.0F;
    return e;
  };
  const auto exit = [&](float key, std::uint32_t index) {
    TileEdge e = edge(key, index);
    e.from.at_centre = -1.0F, e.to.at_centre = 1.0F;
    return e;
  };
  const auto cast = [&](Tile* tile) {
    for (int i = 0; i < kTileRays; ++i)
      tile->u[i] = tile->v[i] = 0.0F, tile->key_from[i] = -10.0F, tile->key_to[i] = -0.1F;
    CastTile(tile);
  };
  ForEachTarget([&](std::int64_t target) {
    SCOPED_TRACE(hwy::TargetName(target));
    Tile tile;
    tile.cameras.resize(2);
    tile.cameras[0].entries = {entry(-3.0F, 7), entry(-9.0F, 8)};
    tile.cameras[0].exits = {exit(-6.0F, 9)};
    tile.cameras[1].entries = {entry(-5.0F, 4)};
    cast(&tile);
    for (int i = 0; i < kTileRays; ++i) {
      ASSERT_EQ(tile.key[i], -3.0F);
      ASSERT_EQ(tile.camera[i], 0);
      ASSERT_EQ(tile.entry[i], 0);
    }
    // Inside from the start: a face of the workspace.
    tile.cameras[1] = {};
    tile.cameras[1].starts_inside = ~std::uint64_t{0};
    tile.cameras[0].starts_inside = ~std::uint64_t{0};
    tile.cameras[0].entries.clear();
    cast(&tile);
    EXPECT_EQ(tile.key[63], -10.0F);
    EXPECT_EQ(tile.camera[63], Tile::kNoCamera);
    // One ray of them starts outside, and enters nothing.
    tile.cameras[1].starts_inside = ~(std::uint64_t{1} << 37U);
    cast(&tile);
    EXPECT_EQ(tile.key[36], -10.0F);
    EXPECT_EQ(tile.key[37], std::numeric_limits<float>::infinity());
  });
}

}  // namespace
}  // namespace elbowroom::recon
