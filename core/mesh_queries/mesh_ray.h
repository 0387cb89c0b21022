// Where a ray meets a mesh.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/bvh.h"
#include "core/infinity.h"

namespace elbowroom::core {

// The places origin + s * direction with from <= s <= to, in the mesh's frame.
struct MeshRay {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // of any length but 0
  double from = 0.0;
  double to = kInfinity;
};

struct MetTriangle {
  std::uint32_t triangle = 0;
  double at = 0.0;  // s
};

// The nearest triangle that the ray meets, from either side; of two that are equally far, the earlier one.
// Edges and corners belong to their triangles, so that no ray slips between two of them but for rounding. A
// triangle without area, or seen edge on, is never met. Exact but for double's rounding (pick_test holds it
// against all triangles). Thread: any.
[[nodiscard]] std::optional<MetTriangle> FirstMet(const TriangleTree& tree, const MeshRay& ray);

// Whether FirstMet would find one; it ends with the first that it comes across.
[[nodiscard]] bool MeetsAny(const TriangleTree& tree, const MeshRay& ray);

// The place s >= 0 on the ray from `origin` at which it meets the triangle a, b, c; nothing where it doesn't,
// or lies in its plane. Source: Möller and Trumbore 1997.
[[nodiscard]] std::optional<double> MeetTriangle(const Eigen::Vector3d& origin,
                                                 const Eigen::Vector3d& direction, const Eigen::Vector3d& a,
                                                 const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace elbowroom::core
