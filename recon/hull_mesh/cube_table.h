// How a surface cuts a cube whose corners are inside or outside: marching cubes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace elbowroom::recon {

// Corner c stands at (c & 1, c >> 1 & 1, c >> 2). Edge 4 a + i runs along axis a; its ends are kCubeEdges'.
struct CubeEdge {
  int low = 0;  // corner with the smaller coordinate
  int high = 0;
};
inline constexpr std::array<CubeEdge, 12> kCubeEdges = {
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

// Triangles whose corners stand on cube edges, counter-clockwise seen from outside.
struct CubeTriangles {
  static constexpr std::size_t kMost = 5;
  std::size_t count = 0;
  std::array<std::array<std::uint8_t, 3>, kMost> all{};
};

// The index has a bit for each corner that is inside. On a face with two inside corners across from each
// other these are kept apart, in both cubes that share the face. No triangle's inner side joins two points of
// one face. So the surface of a grid of cubes is a closed 2-manifold (cube_table_test).
[[nodiscard]] const std::array<CubeTriangles, 256>& CubeTable();

}  // namespace elbowroom::recon
