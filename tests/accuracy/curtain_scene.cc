#include "tests/accuracy/curtain_scene.h"

#include <cmath>
#include <utility>

#include "core/error.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/synthetic/view_scene.h"
#include "review/contacts.h"
#include "tests/support/panel_mesh.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

bool IsTouching(const recon::VisualHull& hull, const core::TriangleTree& part,
                const core::RigidTransform& world_from_part, double resolution_mm) {
  review::ContactOptions options;
  options.resolution_mm = resolution_mm;
  return !review::FindContacts(hull, part, world_from_part, 0, options).points.empty();
}

}  // namespace

core::SharedMesh MakeCurtain() {
  return std::make_shared<const core::TriangleMesh>(
      test_support::PanelMesh(12, 30, {0.0, -450.0, -450.0}, {0.0, 900.0, 0.0}, {0.0, 0.0, 900.0}));
}

core::SharedMesh MakeTabletopPanel(int across, int up) {
  return std::make_shared<const core::TriangleMesh>(
      test_support::PanelMesh(across, up, {0.0, -180.0, -200.0}, {0.0, 360.0, 0.0}, {0.0, 0.0, 400.0}));
}

HandSight HandSightOf(const core::Rig& rig, const std::vector<recon::SyntheticObject>& objects) {
  const auto shared = std::make_shared<const core::Rig>(rig);
  recon::UndistortedPlanes planes = recon::MakeUndistortedPlanes(rig);
  std::vector<core::SoftMask> masks = recon::TrueMasks(rig, objects);
  recon::VisualHull hull = recon::MakeVisualHull(shared, planes, masks);
  recon::CoverageHull textures(rig, masks);
  return {shared, std::move(planes), std::move(masks), std::move(hull), std::move(textures)};
}

core::RigidTransform PushedIn(const recon::VisualHull& hull, const core::TriangleTree& part,
                              const Eigen::Matrix3d& world_from_part, const Vector3d& center,
                              double depth_mm) {
  const auto at = [&](double x_mm) {
    return core::RigidTransform{world_from_part, center + x_mm * world_from_part.col(0)};
  };
  // Roughly the first touch of all, then to a hundredth of a millimetre. Farther away than the workspace is
  // long there is no hull.
  constexpr double kRoughMm = 1.0, kStepMm = 5.0;
  double clear_mm = -kStepMm * std::ceil(hull.rig().workspace_mm.diagonal().norm() / kStepMm),
         touching_mm = 0.0;
  core::Require(IsTouching(hull, part, at(touching_mm), kRoughMm), "a part through the hand touches it");
  for (double x_mm = clear_mm; x_mm < touching_mm; x_mm += kStepMm) {
    if (IsTouching(hull, part, at(x_mm), kRoughMm)) {
      touching_mm = x_mm;
      break;
    }
    clear_mm = x_mm;
  }
  while (touching_mm - clear_mm > 0.01) {
    const double middle_mm = 0.5 * (clear_mm + touching_mm);
    (IsTouching(hull, part, at(middle_mm), kTouchResolutionMm) ? touching_mm : clear_mm) = middle_mm;
  }
  return at(touching_mm + depth_mm);
}

}  // namespace elbowroom::accuracy
