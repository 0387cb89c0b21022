// The empty room: a table draped with dark cloth in front of dark walls, and the light on it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

// Grey levels (B, G, R) where the ray meets the table (z = 0) or the walls: procedural cloth, 18 to 60
// levels.
[[nodiscard]] Eigen::Vector3f EmptySceneColor(std::uint64_t seed, const Ray& ray);

// Grey levels of a solid's surface under one diffuse lamp and ambient light.
[[nodiscard]] Eigen::Vector3f ShadedColor(const Eigen::Vector3d& color_bgr,
                                          const Eigen::Vector3d& normal_in_world);

// Share of the lamp's light (0 to 1) that reaches the table where the ray meets it; 1 where it meets no
// table. `spheres` are the bounding spheres of the solids, in order.
[[nodiscard]] float TableLight(const Ray& ray, std::span<const Solid> solids,
                               std::span<const BoundingSphere> spheres);

}  // namespace elbowroom::recon
