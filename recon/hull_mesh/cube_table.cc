#include "recon/hull_mesh/cube_table.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Triangles = std::vector<std::array<std::uint8_t, 3>>;

// The corners of each face in a round, counter-clockwise seen from outside the cube.
constexpr std::array<std::array<int, 4>, 6> kFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

int EdgeBetween(int a, int b) {
  for (std::size_t i = 0; i < kCubeEdges.size(); ++i) {
    const CubeEdge& edge = kCubeEdges[i];
    if ((edge.low == a && edge.high == b) || (edge.low == b && edge.high == a)) return static_cast<int>(i);
  }
  throw core::PreconditionError("neighbouring corners of a cube");
}

bool IsOnFace(int edge, const std::array<int, 4>& face) {
  const auto has = [&](int corner) { return std::find(face.begin(), face.end(), corner) != face.end(); };
  return has(kCubeEdges[static_cast<std::size_t>(edge)].low) &&
         has(kCubeEdges[static_cast<std::size_t>(edge)].high);
}

bool ShareFace(int a, int b) {
  return std::any_of(kFaces.begin(), kFaces.end(),
                     [&](const auto& face) { return IsOnFace(a, face) && IsOnFace(b, face); });
}

// For each edge of the cube, the edge to which the surface's outline goes on; -1 if it doesn't cross this
// one. Round each face, each run of inside corners is cut off by one segment, from where the run begins to
// where it ends. Two inside corners across from each other are two runs, so each is cut off alone.
std::array<int, 12> OutlineOf(unsigned inside) {
  std::array<int, 12> next;
  next.fill(-1);
  const auto is_inside = [&](int corner) { return ((inside >> static_cast<unsigned>(corner)) & 1U) != 0; };
  for (const std::array<int, 4>& face : kFaces) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (is_inside(face[i]) || !is_inside(face[(i + 1) % 4])) continue;
      std::size_t end = i + 1;
      while (is_inside(face[(end + 1) % 4])) ++end;
      next[static_cast<std::size_t>(EdgeBetween(face[i], face[(i + 1) % 4]))] =
          EdgeBetween(face[end % 4], face[(end + 1) % 4]);
    }
  }
  return next;
}

// Cuts polygon[first..last] into triangles without an inner side between two points of one face.
std::optional<Triangles> Triangulate(const std::vector<int>& polygon, std::size_t first, std::size_t last) {
  if (last - first < 2) return Triangles{};
  const auto is_fine = [&](std::size_t a, std::size_t b) {
    const bool is_side = b - a == 1 || (a == 0 && b + 1 == polygon.size());
    return is_side || !ShareFace(polygon[a], polygon[b]);
  };
  for (std::size_t middle = first + 1; middle < last; ++middle) {
    if (!is_fine(first, middle) || !is_fine(middle, last)) continue;
    std::optional<Triangles> left = Triangulate(polygon, first, middle);
    const std::optional<Triangles> right = Triangulate(polygon, middle, last);
    if (!left || !right) continue;
    left->insert(left->end(), right->begin(), right->end());
    left->push_back({static_cast<std::uint8_t>(polygon[first]), static_cast<std::uint8_t>(polygon[middle]),
                     static_cast<std::uint8_t>(polygon[last])});
    return left;
  }
  return std::nullopt;
}

CubeTriangles TrianglesOf(unsigned inside) {
  std::array<int, 12> next = OutlineOf(inside);
  Triangles triangles;
  for (std::size_t start = 0; start < next.size(); ++start) {
    std::vector<int> polygon;
    for (int edge = static_cast<int>(start); next[static_cast<std::size_t>(edge)] >= 0;) {
      polygon.push_back(edge);
      edge = std::exchange(next[static_cast<std::size_t>(edge)], -1);
    }
    if (polygon.empty()) continue;
    const std::optional<Triangles> cut = Triangulate(polygon, 0, polygon.size() - 1);
    core::Require(cut.has_value(), "every outline on a cube has a triangulation");
    triangles.insert(triangles.end(), cut->begin(), cut->end());
  }
  core::Require(triangles.size() <= CubeTriangles::kMost, "five triangles a cube at most");
  CubeTriangles result;
  result.count = triangles.size();
  std::copy(triangles.begin(), triangles.end(), result.all.begin());
  return result;
}

}  // namespace

const std::array<CubeTriangles, 256>& CubeTable() {
  static const std::array<CubeTriangles, 256> table = [] {
    std::array<CubeTriangles, 256> result;
    for (unsigned inside = 0; inside < 256; ++inside) result[inside] = TrianglesOf(inside);
    return result;
  }();
  return table;
}

}  // namespace elbowroom::recon
