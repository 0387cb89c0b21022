#include "app/control/report/cut_away.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace elbowroom::control {
namespace {

// Whether the segment crosses the triangle (Moeller and Trumbore, 1997). One that only grazes it may not
// count.
bool Crosses(const Eigen::Vector3d& from, const Eigen::Vector3d& way, const Eigen::Vector3d& a,
             const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, p = way.cross(ac);
  const double volume = ab.dot(p);
  if (volume == 0.0) return false;
  const Eigen::Vector3d t = from - a, q = t.cross(ab);
  const double u = t.dot(p) / volume, v = way.dot(q) / volume, share = ac.dot(q) / volume;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && share >= 0.0 && share <= 1.0;
}

bool Crosses(const core::TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d way = to - from;
  return std::ranges::any_of(mesh.triangles, [&](const auto& triangle) {
    const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& {
      return mesh.vertices_mm[static_cast<std::size_t>(triangle[i])];
    };
    return Crosses(from, way, corner(0), corner(1), corner(2));
  });
}

bool IsHidden(const FrameResult& result, const Eigen::Vector3d& eye, const Eigen::Vector3d& place) {
  for (core::PartIndex part = 0; part < result.layout->parts.size(); ++part) {
    if (const core::SharedMesh cloth = result.response ? result.response->meshes_in_world[part] : nullptr) {
      if (Crosses(*cloth, eye, place)) return true;
      continue;
    }
    const core::RigidTransform part_from_world = result.world_from_parts[part].Inverse();
    if (Crosses(*result.layout->parts[part].mesh, part_from_world * eye, part_from_world * place))
      return true;
  }
  return false;
}

}  // namespace

std::optional<sessions::TopicCut> CutBefore(const FrameResult& result, const Eigen::Vector3d& eye_in_world_mm,
                                            const Eigen::Vector3d& place_in_world_mm) {
  const Eigen::Vector3d way = place_in_world_mm - eye_in_world_mm;
  if (way.norm() <= kCutBeforeMm) return std::nullopt;
  const Eigen::Vector3d direction = way.normalized(), cut = place_in_world_mm - kCutBeforeMm * direction;
  if (!IsHidden(result, eye_in_world_mm, cut)) return std::nullopt;
  return sessions::TopicCut{cut, -direction};
}

}  // namespace elbowroom::control
