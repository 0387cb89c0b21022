// The empty room: a table draped with dark cloth in front of dark walls, and the light on it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

// Grey levels (B, G, R) where the ray meets the table (z = 0) or the walls: procedural cloth, 18 to 60
// levels.
[[nodiscard]] Eigen::Vector3f EmptySceneColor(std::uint64_t seed, const Ray& ray);

// Grey levels of a solid's surface under one diffuse lamp and ambient light.
[[nodiscard]] Eigen::Vector3f ShadedColor(const Eigen::Vector3d& color_bgr,
                                          const Eigen::Vector3d& normal_in_world);

// A disc on the table that holds the points where some rays meet it.
struct TableDisc {
  Eigen::Vector3d center_in_world = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
};

// Nothing if none of the rays meets the table.
[[nodiscard]] std::optional<TableDisc> DiscOnTable(std::span<const Ray> rays);

// False only if the sphere takes no light of the lamp from any point of the disc.
[[nodiscard]] bool MayShade(const BoundingSphere& sphere, const TableDisc& disc);

// Share of the lamp's light (0 to 1) that reaches the table where the ray meets it; 1 where it meets no
// table. `spheres` are the bounding spheres of the solids, in order.
[[nodiscard]] float TableLight(const Ray& ray, std::span<const Solid> solids,
                               std::span<const BoundingSphere> spheres);

}  // namespace elbowroom::recon
