#include "recon/paper_methods/sweep_cameras.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

void RequireFit(const core::Rig& rig, std::span<const core::SoftMask> masks) {
  core::Require(masks.size() == rig.cameras.size(), "a volume query has one mask a camera");
  if (rig.cameras.size() > kMostSweepCameras) {
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("rig '{}' has {} cameras; silhouettes as textures take {}, use the exact methods",
                    rig.name, rig.cameras.size(), kMostSweepCameras));
  }
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const core::CameraModel& camera = rig.cameras[i];
    const core::BitMask& mask = masks[i].mask;
    if (mask.width_px() == camera.width_px() && mask.height_px() == camera.height_px()) continue;
    throw core::Error(
        core::ErrorKind::kCamera,
        fmt::format("camera '{}': its mask has {} x {} pixels and it has {} x {}; take the mask "
                    "from this camera's picture",
                    camera.name(), mask.width_px(), mask.height_px(), camera.width_px(), camera.height_px()));
  }
}

}  // namespace

SweepLensCoefficients LensCoefficientsOf(const core::CameraModel& camera) {
  const core::CameraCalibration& c = camera.calibration();
  // OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4, or k1 k2 k3 k4.
  const auto at = [&](std::size_t i) {
    return i < c.distortion_coefficients.size() ? static_cast<float>(c.distortion_coefficients[i]) : 0.0F;
  };
  if (c.distortion_model == core::DistortionModel::kFisheye) {
    return {true, {at(0), at(1), at(2), at(3), 0.0F, 0.0F}, {}, {}};
  }
  return {false, {at(0), at(1), at(4), at(5), at(6), at(7)}, {at(2), at(3)}, {at(8), at(9), at(10), at(11)}};
}

bool IsMatterOfRounding(const SweepCamera& camera, const Eigen::Vector2d& position_px) {
  constexpr double kPositionPx = 0.01;
  constexpr double kBandLevels = 255.0 * (4.0 / 256.0 + 2.0 * kPositionPx);
  const Eigen::Vector2d picture_px(camera.model.width_px(), camera.model.height_px());
  const Eigen::Vector2d center_px = 0.5 * (picture_px - Eigen::Vector2d::Ones());
  const double inside_border_px = (0.5 * picture_px - (position_px - center_px).cwiseAbs()).minCoeff();
  return std::abs(CoverageAt(camera.coverage, position_px) - kObjectLevel) <= kBandLevels ||
         std::abs(inside_border_px) <= kPositionPx;
}

std::vector<SweepCamera> MakeSweepCameras(const core::Rig& rig, std::span<const core::SoftMask> masks,
                                          const core::RigidTransform& world_from_view) {
  RequireFit(rig, masks);
  std::vector<std::optional<SweepCamera>> cameras(rig.cameras.size());
  tbb::parallel_for(std::size_t{0}, cameras.size(), [&](std::size_t i) {
    const core::CameraModel& camera = rig.cameras[i];
    cameras[i] = {camera, camera.cam_from_world() * world_from_view, MakeCoverageTexture(masks[i]),
                  BlockOccupancy(masks[i].mask)};
  });
  std::vector<std::size_t> order(cameras.size());
  std::iota(order.begin(), order.end(), 0);
  const auto texels = [&](std::size_t i) { return cameras[i]->coverage.texels.size(); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return texels(a) < texels(b); });
  std::vector<SweepCamera> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(*cameras[i]));
  return sorted;
}

}  // namespace elbowroom::recon
