#include "recon/calibration/pixel_response.h"

#include "recon/calibration/rotation.h"

namespace elbowroom::recon {

std::optional<PixelResponse> PixelResponseAt(const LensParameters& lens,
                                             const core::RigidTransform& cam_from_world,
                                             const Eigen::Vector3d& x_in_world) {
  const Eigen::Vector3d turned = cam_from_world.rotation * x_in_world;
  const auto projected = ProjectWithDerivatives(lens, turned + cam_from_world.translation_mm);
  if (!projected) return std::nullopt;
  const ParameterBlock block{0, lens.count()};
  PixelResponse response{projected->by_x_in_cam * cam_from_world.rotation,
                         Eigen::Matrix2Xd::Zero(2, block.size())};
  response.by_parameters.leftCols(block.intrinsics) = projected->by_values;
  // A turn w of the camera moves the point in its frame by w x turned.
  response.by_parameters.middleCols<3>(block.rotation()) = -projected->by_x_in_cam * Hat(turned);
  response.by_parameters.middleCols<3>(block.translation()) = projected->by_x_in_cam;
  return response;
}

}  // namespace elbowroom::recon
