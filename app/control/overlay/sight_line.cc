#include "app/control/overlay/sight_line.h"

#include "core/mesh_queries/mesh_ray.h"

namespace elbowroom::control {
namespace {

constexpr double kBeforePoint = 1e-6;

}  // namespace

bool IsHidden(const core::TriangleTree& part, const Eigen::Vector3d& eye_in_part,
              const Eigen::Vector3d& x_in_part, double from_share) {
  return core::MeetsAny(part, {eye_in_part, x_in_part - eye_in_part, from_share, 1.0 - kBeforePoint});
}

}  // namespace elbowroom::control
