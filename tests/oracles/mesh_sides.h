// Which points a closed mesh holds, by CGAL: exact, and none of this project's code.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/triangle_mesh.h"

namespace elbowroom::oracles {

class MeshSides {
 public:
  // The mesh must be closed. Throws: PreconditionError when CGAL takes it for no closed 2-manifold.
  explicit MeshSides(const core::TriangleMesh& mesh);
  ~MeshSides();

  // Inside or on it. Thread: one at a time.
  [[nodiscard]] bool Holds(const Eigen::Vector3d& point) const;

  // How far a point is from the surface.
  [[nodiscard]] double DistanceMm(const Eigen::Vector3d& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::oracles
