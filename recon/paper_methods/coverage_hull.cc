#include "recon/paper_methods/coverage_hull.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace elbowroom::recon {
namespace {

constexpr double kBorderMm = 0.01;

// True if the camera's label at a point may come out either way.
bool IsClose(const SweepCamera& camera, const Eigen::Vector3d& x_in_world) {
  const auto pixel = camera.model.ProjectInCam(camera.cam_from_view * x_in_world);
  return pixel && IsMatterOfRounding(camera, *pixel);
}

}  // namespace

CoverageHull::CoverageHull(const core::Rig& rig, std::span<const core::SoftMask> masks)
    : cameras_(MakeSweepCameras(rig, masks, {})),
      workspace_mm_(rig.workspace_mm),
      exterior_is_object_(rig.unseen == core::UnseenPolicy::kAbstain) {}

bool CoverageHull::Contains(const Eigen::Vector3d& x_in_world) const {
  if (!workspace_mm_.contains(x_in_world)) return false;
  bool is_seen = false;
  for (const SweepCamera& camera : cameras_) {
    const auto pixel = camera.model.ProjectInCam(camera.cam_from_view * x_in_world);
    const bool sees = pixel && (pixel->array() >= -0.5).all() && pixel->x() < camera.model.width_px() - 0.5 &&
                      pixel->y() < camera.model.height_px() - 0.5;
    is_seen |= sees;
    if (!sees && exterior_is_object_) continue;
    if (!sees || CoverageAt(camera.coverage, *pixel) < kObjectLevel) return false;
  }
  return is_seen;
}

bool CoverageHull::IsAtFace(const Eigen::Vector3d& x_in_world) const {
  const Eigen::Vector3d to_face =
      (x_in_world - workspace_mm_.min()).cwiseMin(workspace_mm_.max() - x_in_world);
  return std::abs(to_face.minCoeff()) <= kBorderMm;
}

bool CoverageHull::IsMatterOfRounding(const Eigen::Vector3d& x_in_world) const {
  return IsAtFace(x_in_world) ||
         std::any_of(cameras_.begin(), cameras_.end(),
                     [&](const SweepCamera& camera) { return IsClose(camera, x_in_world); });
}

}  // namespace elbowroom::recon
