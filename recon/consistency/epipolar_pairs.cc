#include "recon/consistency/epipolar_pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kLeastBaselineMm = 1.0;

EpipolarPair PairOf(core::CameraIndex a, core::CameraIndex b, const core::CameraModel& camera_a,
                    const core::CameraModel& camera_b, const Vector3d& towards_in_world) {
  EpipolarPair pair;
  pair.a = a, pair.b = b;
  const Vector3d baseline = camera_b.center_in_world() - camera_a.center_in_world();
  pair.baseline_mm = baseline.norm();
  if (pair.baseline_mm < kLeastBaselineMm) return pair;
  pair.axis = baseline / pair.baseline_mm;
  const Vector3d towards = towards_in_world - camera_a.center_in_world();
  Vector3d across = towards - towards.dot(pair.axis) * pair.axis;
  // The middle of the workspace may be on the line: any direction will do then.
  if (across.norm() < kLeastBaselineMm) across = pair.axis.unitOrthogonal();
  pair.zero = across.normalized();
  pair.quarter = pair.axis.cross(pair.zero);
  Eigen::Matrix<double, 2, 3> rows;
  rows << pair.zero.transpose(), pair.quarter.transpose();
  pair.from_a = rows * camera_a.cam_from_world().rotation.transpose();
  pair.from_b = rows * camera_b.cam_from_world().rotation.transpose();
  return pair;
}

// Where a ray is in the box, as distances along it; nothing: nowhere.
std::optional<std::pair<double, double>> StretchInBox(const Eigen::AlignedBox3d& box, const Vector3d& from,
                                                      const Vector3d& direction) {
  double first = 0.0, last = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (from[axis] < box.min()[axis] || from[axis] > box.max()[axis]) return std::nullopt;
      continue;
    }
    const double to_low = (box.min()[axis] - from[axis]) / direction[axis];
    const double to_high = (box.max()[axis] - from[axis]) / direction[axis];
    first = std::max(first, std::min(to_low, to_high));
    last = std::min(last, std::max(to_low, to_high));
  }
  if (first >= last) return std::nullopt;
  return std::pair(first, last);
}

}  // namespace

EpipolarPairs::EpipolarPairs(const core::Rig& rig, UndistortedPlanes planes)
    : workspace_mm_(rig.workspace_mm), planes_(std::move(planes)) {
  core::Require(planes_.size() == rig.cameras.size(), "there is one undistorted plane a camera");
  for (core::CameraIndex a = 0; a < planes_.size(); ++a)
    for (core::CameraIndex b = a + 1; b < planes_.size(); ++b) {
      EpipolarPair pair = PairOf(a, b, plane(a).camera(), plane(b).camera(), workspace_mm_.center());
      if (pair.baseline_mm >= kLeastBaselineMm) pairs_.push_back(std::move(pair));
    }
}

bool EpipolarPairs::SeesSight(core::CameraIndex camera, const Vector3d& from_in_world, const Vector3d& sight,
                              double margin_px) const {
  constexpr int kPlaces = 4;  // the sight's picture may be bent by the lens, so its ends alone don't do
  const auto stretch = StretchInBox(workspace_mm_, from_in_world, sight);
  if (!stretch) return false;
  const core::CameraModel& model = plane(camera).camera();
  for (int i = 0; i <= kPlaces; ++i) {
    const double share = static_cast<double>(i) / kPlaces;
    const double along_mm = (1.0 - share) * stretch->first + share * stretch->second;
    const std::optional<Eigen::Vector2d> pixel = model.Project(from_in_world + along_mm * sight);
    if (!pixel || !IsWithin(model, *pixel, margin_px)) return false;
  }
  return true;
}

bool IsWithin(const core::CameraModel& camera, const Eigen::Vector2d& pixel, double margin_px) {
  return pixel.x() >= margin_px - 0.5 && pixel.y() >= margin_px - 0.5 &&
         pixel.x() <= camera.width_px() - 0.5 - margin_px &&
         pixel.y() <= camera.height_px() - 0.5 - margin_px;
}

}  // namespace elbowroom::recon
