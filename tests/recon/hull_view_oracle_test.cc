// The exact view's depth against a brute-force march at 0.02 mm that knows no polygon, no distance and no
// undistorted picture: each step is projected through the lens and looked up in the mask's lattice.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "recon/hull_view.h"
#include "tests/recon/lattice.h"
#include "tests/recon/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMarchMm = 0.02;
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

// A label, and that of the silhouette grown and shrunk by kGrazePx.
struct Labels {
  bool shrunk = false;
  bool as_is = false;
  bool grown = false;
};

Labels LabelsAt(const Lattice& lattice, const Vector2d& pixel) {
  const bool here = lattice.At(pixel);
  if (!lattice.MayChangeNear(pixel)) return {here, here, here};
  Labels labels{here, here, here};
  constexpr int kDirections = 8;
  for (int k = 0; k < kDirections; ++k) {
    const double angle_rad = 2.0 * M_PI * k / kDirections;
    const bool aside = lattice.At(pixel + kGrazePx * Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
    labels.shrunk = labels.shrunk && aside;
    labels.grown = labels.grown || aside;
  }
  return labels;
}

class MarchingOracle {
 public:
  explicit MarchingOracle(const RandomScene& scene) : rig_(*scene.rig) {
    for (const core::BitMask& mask : scene.masks) lattices_.emplace_back(core::SoftMask{mask, {}}, false);
  }

  // Depths of the first hits: of the shrunk, the given, the grown silhouettes; infinite for a miss.
  [[nodiscard]] std::array<double, 3> FirstDepths(const Vector3d& eye_in_world, const Vector3d& direction,
                                                  double mm_per_depth_mm) const {
    constexpr double kMiss = std::numeric_limits<double>::infinity();
    std::array<double, 3> depths_mm = {kMiss, kMiss, kMiss};
    constexpr double kFarMm = 1500.0;
    for (double t_mm = 0.0; t_mm < kFarMm && depths_mm[0] == kMiss; t_mm += kMarchMm) {
      const Vector3d x = eye_in_world + t_mm * direction;
      if (!rig_.workspace_mm.contains(x)) continue;
      const Labels labels = Ask(x);
      const double depth_mm = t_mm / mm_per_depth_mm;
      if (labels.shrunk) depths_mm[0] = std::min(depths_mm[0], depth_mm);
      if (labels.as_is) depths_mm[1] = std::min(depths_mm[1], depth_mm);
      if (labels.grown) depths_mm[2] = std::min(depths_mm[2], depth_mm);
    }
    return depths_mm;
  }

 private:
  [[nodiscard]] Labels Ask(const Vector3d& x_in_world) const {
    Labels all{true, true, true};
    for (std::size_t i = 0; i < lattices_.size() && all.grown; ++i) {
      const std::optional<Vector2d> pixel = rig_.cameras[i].Project(x_in_world);
      if (!pixel) return {};
      const Labels labels = LabelsAt(lattices_[i], *pixel);
      all = {all.shrunk && labels.shrunk, all.as_is && labels.as_is, all.grown && labels.grown};
    }
    return all;
  }

  const core::Rig& rig_;
  std::vector<Lattice> lattices_;
};

struct Tally {
  int rays = 0;
  int hits = 0;
  int grazing = 0;
  int wrong = 0;  // hit or miss, of rays that don't graze
  double worst_mm = 0.0;
  double sum_mm = 0.0;

  void Add(const Tally& other) {
    rays += other.rays, hits += other.hits, grazing += other.grazing, wrong += other.wrong;
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

void CompareRay(const MarchingOracle& oracle, const ViewRays& rays, const HullView& view, int x, int y,
                Tally* tally) {
  const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
  const Vector3d d = rays.At(x, y).homogeneous();
  const std::array<double, 3> truth_mm = oracle.FirstDepths(
      world_from_view.translation_mm, world_from_view.rotation * d.normalized(), d.norm());
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
  // The march finds the step behind the crossing: half a step is its own.
  const double error_mm = std::abs(depth_mm - (truth_mm[1] - 0.5 * kMarchMm / d.norm()));
  tally->worst_mm = std::max(tally->worst_mm, error_mm);
  tally->sum_mm += error_mm;
}

Tally CompareRig(int cameras, std::uint64_t seed) {
  Random random(seed);
  const RandomScene scene = MakeRingScene(&random, cameras, core::UnseenPolicy::kOutside);
  const ViewRays rays(RandomView(&random));
  const HullView view = ViewHull(MakeVisualHull(scene.rig, scene.masks), rays);
  const MarchingOracle oracle(scene);
  Tally tally;
  // Mostly rays that hit, or pass near by.
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
  RecordProperty("rays", sum.rays);
  RecordProperty("hits", sum.hits);
  RecordProperty("grazing", sum.grazing);
  RecordProperty("worst_mm", std::to_string(sum.worst_mm));
  RecordProperty("mean_mm", std::to_string(sum.sum_mm / std::max(sum.hits, 1)));
}

INSTANTIATE_TEST_SUITE_P(Cameras, ViewAgainstMarch, testing::Values(3, 4, 8), testing::PrintToStringParamName());

}  // namespace
}  // namespace elbowroom::recon
