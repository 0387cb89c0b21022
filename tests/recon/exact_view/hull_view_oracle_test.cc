// The exact view's depth against a brute-force march at 0.02 mm that knows no polygon, no distance and no
// undistorted picture (tests/oracles/mask_hull_oracle.h).
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <mutex>
#include <vector>

#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "tests/oracles/mask_hull_oracle.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

// What the exact view must hold, on all rays that don't graze.
constexpr double kLargestErrorMm = 0.05;
// A ray grazes if moving every silhouette's boundary by this much, out or in, ...
constexpr double kGrazePx = 0.02;
// ... makes a hit a miss, or moves the first hit by more than this. Pixels here are 2 to 5 mm at the hull: a
// boundary that is crossed at more than 3 degrees moves the hit less.
constexpr double kGrazeMm = 2.0;
// Rigs in the ordinary run; ./dev soak has 20 times as many, of each number of cameras.
constexpr int kRigs = 50;
constexpr int kRaysARig = 6;
// The oracle passes over nothing under `abstain`, so that these take most of the time.
constexpr double kAbstainingRigs = 0.25;

struct Tally {
  int abstaining_rigs = 0;
  int rays = 0;
  int hits = 0;
  int grazing = 0;
  int wrong = 0;  // hit or miss, of rays that don't graze
  double worst_mm = 0.0;
  double sum_mm = 0.0;

  void Add(const Tally& other) {
    abstaining_rigs += other.abstaining_rigs, rays += other.rays, hits += other.hits,
        grazing += other.grazing, wrong += other.wrong;
    worst_mm = std::max(worst_mm, other.worst_mm), sum_mm += other.sum_mm;
  }
};

core::CameraModel RandomView(Random* random) {
  core::CameraCalibration c;
  c.name = "view";
  c.image_width_px = 64, c.image_height_px = 48;
  c.camera_matrix << 130.0, 0.0, 31.0, 0.0, 130.0, 24.5, 0.0, 0.0, 1.0;
  if (random->Chance(0.5)) c.distortion_coefficients = {-0.15, 0.03, 1e-3, -1e-3, 0.0};
  const Vector3d eye = random->Uniform(350.0, 700.0) * random->Direction();
  c.cam_from_world = core::CamFromWorldLookingAt(eye, 20.0 * random->Direction());
  return core::CameraModel(c);
}

// Depths of the first hits of a pixel's ray: of the shrunk, the given, the grown silhouettes; infinite for a
// miss.
std::array<double, 3> FirstDepths(const oracles::MaskHullOracle& oracle, const ViewRays& rays, int x, int y) {
  const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
  const Vector3d d = rays.At(x, y).homogeneous();
  const Ray ray{world_from_view.translation_mm, world_from_view.rotation * d.normalized()};
  std::array<double, 3> depths_mm{};
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> t_mm = oracle.FirstSurface(ray, (i - 1) * kGrazePx);
    depths_mm[static_cast<std::size_t>(i)] =
        t_mm ? *t_mm / d.norm() : std::numeric_limits<double>::infinity();
  }
  return depths_mm;
}

void CompareRay(const oracles::MaskHullOracle& oracle, const ViewRays& rays, const HullView& view, int x,
                int y, Tally* tally) {
  const std::array<double, 3> truth_mm = FirstDepths(oracle, rays, x, y);
  const double depth_mm = view.depth_mm[static_cast<std::size_t>(y * view.width_px + x)];
  ++tally->rays;
  const bool is_hit = std::isfinite(truth_mm[1]);
  const bool agree = std::isfinite(truth_mm[0]) == is_hit && std::isfinite(truth_mm[2]) == is_hit;
  if (!agree || (is_hit && truth_mm[0] - truth_mm[2] > kGrazeMm)) {
    ++tally->grazing;
    return;
  }
  if ((depth_mm > 0.0) != is_hit) {
    ++tally->wrong;
    ADD_FAILURE() << "depth " << depth_mm << " against " << truth_mm[1];
    return;
  }
  if (!is_hit) return;
  ++tally->hits;
  const double error_mm = std::abs(depth_mm - truth_mm[1]);
  tally->worst_mm = std::max(tally->worst_mm, error_mm);
  tally->sum_mm += error_mm;
}

Tally CompareRig(int cameras, std::uint64_t seed) {
  Random random(seed);
  const bool abstains = random.Chance(kAbstainingRigs);
  const RandomScene scene =
      MakeRingScene(&random, cameras, abstains ? core::UnseenPolicy::kAbstain : core::UnseenPolicy::kOutside);
  const ViewRays rays(RandomView(&random));
  std::vector<core::SoftMask> masks;
  for (const core::BitMask& mask : scene.masks)
    masks.push_back(random.Chance(0.5) ? RandomLevels(&random, mask) : core::SoftMask{mask, {}});
  const HullView view = ViewHull(MakeVisualHull(scene.rig, masks), rays);
  const oracles::MaskHullOracle oracle(*scene.rig, masks, oracles::BoundaryConvention::kMarchingSquares);
  Tally tally;
  tally.abstaining_rigs = abstains ? 1 : 0;
  // Half of them anywhere: what is missing altogether isn't near to anything that was found.
  while (tally.rays < kRaysARig / 2)
    CompareRay(oracle, rays, view, random.Whole(0, 63), random.Whole(0, 47), &tally);
  // The others hit, or pass near by.
  for (int tries = 0; tally.rays < kRaysARig && tries < 200; ++tries) {
    const int x = random.Whole(2, 61), y = random.Whole(2, 45);
    bool is_near = tries >= 100;
    for (const auto& [dx, dy] : {std::pair{0, 0}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}})
      is_near = is_near || view.depth_mm[static_cast<std::size_t>((y + dy) * 64 + x + dx)] > 0.0F;
    if (is_near) CompareRay(oracle, rays, view, x, y, &tally);
  }
  return tally;
}

class ViewAgainstMarch : public testing::TestWithParam<int> {};

TEST_P(ViewAgainstMarch, DepthIsWithinAFiftiethOfAMillimetreAndNoHitIsMissed) {
  const int cameras = GetParam();
  Tally sum;
  std::mutex mutex;
  tbb::parallel_for(0, kRigs * test_support::SoakScale(), [&](int rig) {
    const Tally tally = CompareRig(cameras, 5'600'000U + static_cast<std::uint64_t>(cameras * 100'000 + rig));
    const std::lock_guard lock(mutex);
    sum.Add(tally);
  });
  EXPECT_EQ(sum.wrong, 0);
  EXPECT_LE(sum.worst_mm, kLargestErrorMm);
  EXPECT_GT(sum.hits, sum.rays / 4);
  EXPECT_LT(sum.grazing, sum.rays / 10);
  EXPECT_GT(sum.abstaining_rigs, 0);
  std::cout << cameras << " cameras (" << sum.abstaining_rigs << " rigs abstain): " << sum.rays << " rays, "
            << sum.hits << " hits, " << sum.grazing << " grazing; error at most " << sum.worst_mm
            << " mm, mean " << sum.sum_mm / std::max(sum.hits, 1) << " mm\n";
}

INSTANTIATE_TEST_SUITE_P(Cameras, ViewAgainstMarch, testing::Values(3, 4, 8),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace elbowroom::recon
