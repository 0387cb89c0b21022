// The demo's CAD parts, modelled by us (docs/demo_parts.md): those of the paper's payload task.
#pragma once

#include <span>

#include "core/layout.h"
#include "core/triangle_mesh.h"

namespace elbowroom::control {

// Dimensions that the motion of the simulated task is built around.
inline constexpr double kPmtSizeMm = 300.0;  // square
inline constexpr double kPmtHeightMm = 120.0;
inline constexpr double kWellRadiusMm = 50.0;  // the receptacle, about the box's middle axis
inline constexpr double kWellDepthMm = 100.0;
inline constexpr double kOutletHeightMm = 8.0;  // boss on the well's floor
inline constexpr double kGapInitialMm = 140.0;  // the paper: before the tongs came
inline constexpr double kGapNeededMm = 240.0;   // the paper: with tongs, on average

// One level of a part's profile, centred on the z axis.
struct ProfileRing {
  bool is_round = false;   // else a rectangle
  double half_x_mm = 0.0;  // of a circle: the radius, like half_y_mm
  double half_y_mm = 0.0;
  double z_mm = 0.0;
};
[[nodiscard]] ProfileRing RectangleRing(double size_x_mm, double size_y_mm, double z_mm);
[[nodiscard]] ProfileRing CircleRing(double radius_mm, double z_mm);

// The surface through the rings in order, closed by a fan of triangles at either end. Triangles face outwards
// if the profile goes from the middle of the underside out, up and back in.
[[nodiscard]] core::TriangleMesh MeshThrough(std::span<const ProfileRing> rings);

// Part frame of each: z up, z = 0 at its lower side, x = y = 0 in its middle. Closed, oriented outwards.
[[nodiscard]] core::TriangleMesh PmtBox();
[[nodiscard]] core::TriangleMesh PayloadA();
[[nodiscard]] core::TriangleMesh PayloadB();

// Parts "pmt" on the table about the world's z axis, "payload_a" above it on the spacing "payload_a_gap" (z,
// 60 to 400 mm, initially 140), "payload_b" beside the PMT box; a rule for each pair.
inline constexpr const char* kDemoGap = "payload_a_gap";
[[nodiscard]] core::Layout DemoLayout();

}  // namespace elbowroom::control
