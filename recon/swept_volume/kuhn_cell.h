// A cell cut into six tetrahedra, and the surface at value 0 in them: marching tetrahedra.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace elbowroom::recon {

// Corner c of a cell stands at (c & 1, c >> 1 & 1, c >> 2). Corners are joined by an edge of Kuhn's
// subdivision where the bits of one are among those of the other: along axes, faces' diagonals and one
// diagonal of the cell. Neighbouring cells cut the face that they share in the same way.
inline constexpr std::size_t kCellCorners = 8;

[[nodiscard]] constexpr bool AreJoined(unsigned a, unsigned b) {
  return a != b && ((a & b) == a || (a & b) == b);
}

// A point of the surface on the edge from corner `low` to corner `high`, whose bits are more.
struct EdgePoint {
  std::uint8_t low = 0;
  std::uint8_t high = 0;

  [[nodiscard]] bool operator==(const EdgePoint&) const = default;
};

using CellTriangle = std::array<EdgePoint, 3>;

// The triangles in a cell of whose corners those with a bit in `inside` are inside, counter-clockwise seen
// from outside. Over all cells of a grid whose outermost corners are outside they form a closed 2-manifold.
[[nodiscard]] std::span<const CellTriangle> CellTriangles(unsigned inside);

}  // namespace elbowroom::recon
