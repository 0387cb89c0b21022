// A view's pencils as tables that a shader reads. Values only: no OpenGL.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "recon/exact_view/view_pencils.h"

namespace elbowroom::recon::gl {

// The label that a caster gives to the start of a ray. kByPixel: it depends on the ray, and LabelsByPixel has
// it.
enum class RayLabel { kBackground = 0, kObject = 1, kByPixel = 2 };

// Casters are the cameras' pencils, then the visibility_outlines'. Every table becomes a buffer texture with
// these rows:
struct PencilTables {
  // A caster's three rows: x (du, dv, at_origin, least_angle); y (du, dv, at_origin, bins_per_angle); first
  // run of entries, of exits, bins, RayLabel. After the casters the faces of workspace and half-spaces, (du,
  // dv, at_origin, 0): not before, not after, beside.
  std::vector<Eigen::Vector4f> forms;
  // A run of crossings a bin, first and past the last: all that rays of the bin can meet.
  std::vector<std::array<std::uint32_t, 2>> runs;
  std::vector<Eigen::Vector2f> angles;  // from, to, of the interval
  std::vector<Eigen::Vector4f> keys;    // du, dv, at_origin, edge: exact, below 2^24
};

[[nodiscard]] PencilTables Tabulate(const ViewPencils& pencils);

// One float a pixel of the picture, for the cameras whose centre is the origin of the rays: 1 if all of them
// see object in that direction, plus 2 if one of their visibility_outlines does. 0 outside of `squares`.
// Empty when no camera is there.
[[nodiscard]] std::vector<float> LabelsByPixel(const ViewPencils& pencils,
                                               const std::vector<PixelBox>& squares);

}  // namespace elbowroom::recon::gl
