// Meshes, views and ray-cast hulls whose pictures can be worked out by hand.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "core/triangle_mesh.h"
#include "recon/gl/scene/scene.h"

namespace elbowroom::recon::gl {

[[nodiscard]] core::SharedMesh BoxMesh(const Eigen::Vector3d& low_mm, const Eigen::Vector3d& high_mm);

// Standing on z = 0 around the z axis.
[[nodiscard]] core::SharedMesh TubeMesh(double outer_radius_mm, double inner_radius_mm, double height_mm,
                                        int sides);

struct Capsule {
  Eigen::Vector3d a_in_world;
  Eigen::Vector3d b_in_world;
  double radius_mm = 0.0;
};

struct RayHit {
  double depth_mm = 0.0;  // along the camera's z axis
  Eigen::Vector3d normal_in_world;
};

// First surface on the ray through the pixel's centre.
[[nodiscard]] std::optional<RayHit> CastRay(const SceneView& view, const Eigen::Vector2d& pixel,
                                            const std::vector<Capsule>& capsules);
[[nodiscard]] std::optional<double> BoxDepth(const SceneView& view, const Eigen::Vector2d& pixel,
                                             const Eigen::AlignedBox3d& box_in_world);

// The capsules as a layer of the given size for the view.
[[nodiscard]] std::shared_ptr<const HullView> CastLayer(const SceneView& view, int width_px, int height_px,
                                                        const std::vector<Capsule>& capsules);

// A forearm and hand with five fingers.
[[nodiscard]] std::vector<Capsule> Hand(const Eigen::Vector3d& palm_in_world);

// A box with a receptacle, a payload above, a pipe, and a hand between them that touches the payload.
[[nodiscard]] Scene TrialScene(int width_px, int height_px);

}  // namespace elbowroom::recon::gl
