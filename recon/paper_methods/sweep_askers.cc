#include "recon/paper_methods/sweep_askers.h"

#include <array>
#include <cstddef>

namespace elbowroom::recon {
namespace {

SweepAsker AskerOf(const SweepCamera& camera, bool exterior_is_object) {
  const core::CameraCalibration& c = camera.model.calibration();
  SweepAsker asker;
  asker.max_radius_squared = static_cast<float>(camera.model.max_radius() * camera.model.max_radius());
  asker.coefficients = LensCoefficientsOf(camera.model);
  asker.lens = asker.coefficients.is_fisheye
                   ? SweepLens::kFisheye
                   : (camera.model.is_ideal() ? SweepLens::kIdeal : SweepLens::kPolynomial);
  const CoverageTexture& coverage = camera.coverage;
  const Eigen::Vector2d first(coverage.left_px, coverage.top_px);
  asker.fx = static_cast<float>(c.camera_matrix(0, 0));
  asker.skew = static_cast<float>(c.camera_matrix(0, 1));
  asker.cx = static_cast<float>(c.camera_matrix(0, 2) - first.x());
  asker.fy = static_cast<float>(c.camera_matrix(1, 1));
  asker.cy = static_cast<float>(c.camera_matrix(1, 2) - first.y());
  const auto relative = [&](const Eigen::Vector2d& position_px) {
    const Eigen::Vector2f p = (position_px - first).cast<float>();
    return std::array<float, 2>{p.x(), p.y()};
  };
  asker.valid_min = relative(coverage.valid_px.min());
  asker.valid_max = relative(coverage.valid_px.max());
  asker.picture_min = relative(Eigen::Vector2d::Constant(-0.5));
  asker.picture_max = relative({c.image_width_px - 0.5, c.image_height_px - 0.5});
  asker.exterior_is_object = exterior_is_object;
  asker.texels = coverage.texels.data();
  asker.stride = coverage.width_texels;
  return asker;
}

}  // namespace

std::vector<SweepAsker> AskersOf(const SweepSpace& space) {
  std::vector<SweepAsker> askers;
  for (const SweepCamera& camera : space.cameras())
    askers.push_back(AskerOf(camera, space.exterior_is_object()));
  return askers;
}

SweepPoints PointsOf(const core::RigidTransform& b_from_view, const Eigen::Vector3d& center_in_view) {
  const Eigen::Vector3d origin = b_from_view * center_in_view;
  SweepPoints points;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    points.origin[axis] = static_cast<float>(origin[i]);
    points.along_x[axis] = static_cast<float>(center_in_view.z() * b_from_view.rotation(i, 0));
    points.along_y[axis] = static_cast<float>(center_in_view.z() * b_from_view.rotation(i, 1));
  }
  return points;
}

SweepBox BoxAt(const SweepSpace& space, const Eigen::Vector3d& center_in_view) {
  SweepBox box;
  box.points = PointsOf(space.world_from_view(), center_in_view);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = static_cast<float>(space.workspace_mm().min()[static_cast<Eigen::Index>(axis)]);
    box.max[axis] = static_cast<float>(space.workspace_mm().max()[static_cast<Eigen::Index>(axis)]);
  }
  return box;
}

}  // namespace elbowroom::recon
