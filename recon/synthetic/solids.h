// Analytic solids with exact ray hits and exact signed distances: the ground truth of the synthetic rig.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/rigid_transform.h"
#include "recon/hull/ray.h"

namespace elbowroom::recon {

// Shapes in their own frame.
struct Sphere {  // about the origin
  double radius_mm = 1.0;
};
struct Capsule {  // all points within radius_mm of the segment from the origin to (0, 0, length_mm)
  double radius_mm = 1.0;
  double length_mm = 1.0;
};
struct Tube {  // about the z axis from z = 0 to length_mm, open at both ends; inner radius 0: a full cylinder
  double outer_radius_mm = 1.0;
  double inner_radius_mm = 0.0;
  double length_mm = 1.0;
};
struct Box {  // about the origin
  Eigen::Vector3d size_mm = Eigen::Vector3d::Ones();
};

// One posed, coloured shape.
struct Solid {
  std::variant<Sphere, Capsule, Tube, Box> shape;
  core::RigidTransform world_from_solid;
  Eigen::Vector3d color_bgr = Eigen::Vector3d::Constant(200.0);  // grey levels under full light
};

// Something real on the table: a hand, a tool.
struct SyntheticObject {
  std::string name;
  std::vector<Solid> solids;
};

struct RayHit {
  double distance_mm = 0.0;
  Eigen::Vector3d normal_in_world = Eigen::Vector3d::UnitZ();  // unit, out of the solid
};

struct BoundingSphere {
  Eigen::Vector3d center_in_world = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
};

// First surface point at a distance >= 0 (from inside a solid: where the ray leaves it); nothing on a miss.
[[nodiscard]] std::optional<RayHit> FirstHit(const Solid& solid, const Ray& ray);

// Distance to the surface, negative inside. Exact for every shape.
[[nodiscard]] double SignedDistanceMm(const Solid& solid, const Eigen::Vector3d& x_in_world);

[[nodiscard]] bool Contains(const Solid& solid, const Eigen::Vector3d& x_in_world);
[[nodiscard]] bool Contains(std::span<const SyntheticObject> objects, const Eigen::Vector3d& x_in_world);

// The smallest sphere around the shape.
[[nodiscard]] BoundingSphere BoundingSphereOf(const Solid& solid);

// Capsule from a to b. Throws: PreconditionError if the points coincide.
[[nodiscard]] Solid CapsuleBetween(const Eigen::Vector3d& a_in_world, const Eigen::Vector3d& b_in_world,
                                   double radius_mm, const Eigen::Vector3d& color_bgr);

// The objects' solids in order, for loops that don't care whose they are.
[[nodiscard]] std::vector<Solid> AllSolids(std::span<const SyntheticObject> objects);

}  // namespace elbowroom::recon
