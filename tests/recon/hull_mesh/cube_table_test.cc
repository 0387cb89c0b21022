#include "recon/hull_mesh/cube_table.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr unsigned kCases = 256;

std::span<const std::array<std::uint8_t, 3>> TrianglesOf(std::size_t inside) {
  const CubeTriangles& triangles = CubeTable()[inside];
  return std::span(triangles.all).first(triangles.count);
}

using Segment = std::pair<int, int>;  // from one cube edge to another

bool IsInside(unsigned inside, int corner) { return ((inside >> static_cast<unsigned>(corner)) & 1U) != 0; }

Vector3d CornerAt(int corner) {
  return Eigen::Vector3i(corner & 1, (corner >> 1) & 1, corner >> 2).cast<double>();
}

// A vertex anywhere on its edge but the ends.
Vector3d PointOn(int edge, double share) {
  const CubeEdge& e = kCubeEdges[static_cast<std::size_t>(edge)];
  return (1.0 - share) * CornerAt(e.low) + share * CornerAt(e.high);
}

bool Changes(unsigned inside, int edge) {
  const CubeEdge& e = kCubeEdges[static_cast<std::size_t>(edge)];
  return IsInside(inside, e.low) != IsInside(inside, e.high);
}

// Face 2 a: coordinate 0 along axis a; 2 a + 1: coordinate 1.
bool IsOnFace(int corner, int face) { return ((corner >> (face / 2)) & 1) == face % 2; }
bool IsEdgeOnFace(int edge, int face) {
  const CubeEdge& e = kCubeEdges[static_cast<std::size_t>(edge)];
  return IsOnFace(e.low, face) && IsOnFace(e.high, face);
}

// The face that holds both edges; -1 if none does.
int SharedFace(int a, int b) {
  for (int face = 0; face < 6; ++face)
    if (IsEdgeOnFace(a, face) && IsEdgeOnFace(b, face)) return face;
  return -1;
}

// The triangles' sides that no other triangle of the case runs along the other way.
std::vector<Segment> OutlineOf(unsigned inside) {
  std::map<Segment, int> sides;
  for (const auto& triangle : TrianglesOf(inside))
    for (std::size_t i = 0; i < 3; ++i) ++sides[{triangle[i], triangle[(i + 1) % 3]}];
  std::vector<Segment> outline;
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1) << "case " << inside << ": a side twice the same way";
    if (!sides.contains({side.second, side.first})) outline.push_back(side);
  }
  return outline;
}

std::set<Segment> OnFace(unsigned inside, int face) {
  std::set<Segment> found;
  for (const Segment& segment : OutlineOf(inside))
    if (SharedFace(segment.first, segment.second) == face) found.insert(segment);
  return found;
}

// As the cube beyond the face names its edges.
Segment SeenFromBeyond(const Segment& segment, int face) {
  const int bit = 1 << (face / 2);
  const auto beyond = [&](int edge) {
    const CubeEdge& e = kCubeEdges[static_cast<std::size_t>(edge)];
    const int low = std::min(e.low ^ bit, e.high ^ bit), high = std::max(e.low ^ bit, e.high ^ bit);
    for (int i = 0; i < 12; ++i) {
      const CubeEdge& other = kCubeEdges[static_cast<std::size_t>(i)];
      if (other.low == low && other.high == high) return i;
    }
    return -1;
  };
  return {beyond(segment.first), beyond(segment.second)};
}

TEST(CubeTable, TrianglesUseEveryEdgeThatChangesAndNoOther) {
  for (unsigned inside = 0; inside < kCases; ++inside) {
    std::set<int> used;
    for (const auto& triangle : TrianglesOf(inside)) {
      used.insert(triangle.begin(), triangle.end());
      EXPECT_TRUE(triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
          << "case " << inside;
    }
    for (int edge = 0; edge < 12; ++edge) EXPECT_EQ(used.contains(edge), Changes(inside, edge)) << inside;
  }
}

TEST(CubeTable, OutlinesLieInFacesAndInnerSidesInNone) {
  for (unsigned inside = 0; inside < kCases; ++inside) {
    const std::vector<Segment> outline = OutlineOf(inside);
    std::map<int, int> starts, ends;
    for (const auto& [from, to] : outline) {
      EXPECT_GE(SharedFace(from, to), 0) << "case " << inside;
      ++starts[from], ++ends[to];
    }
    // Closed: one segment begins and one ends on every edge that changes.
    for (int edge = 0; edge < 12; ++edge) {
      EXPECT_EQ(starts[edge], Changes(inside, edge) ? 1 : 0) << "case " << inside;
      EXPECT_EQ(ends[edge], starts[edge]) << "case " << inside;
    }
    for (const auto& triangle : TrianglesOf(inside)) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Segment side{triangle[i], triangle[(i + 1) % 3]};
        const bool is_outline = std::ranges::find(outline, side) != outline.end();
        EXPECT_EQ(SharedFace(side.first, side.second) >= 0, is_outline) << "case " << inside;
      }
    }
  }
}

// The disc (or discs) of a case: Euler's formula, each piece with one outline; so one fan round each vertex.
TEST(CubeTable, EveryPieceIsADisc) {
  for (unsigned inside = 0; inside < kCases; ++inside) {
    std::array<int, 12> piece{};
    for (int i = 0; i < 12; ++i) piece[static_cast<std::size_t>(i)] = i;
    const auto join = [&](int a, int b) {
      const int from = piece[static_cast<std::size_t>(a)], to = piece[static_cast<std::size_t>(b)];
      std::ranges::replace(piece, from, to);
    };
    for (const auto& [a, b, c] : TrianglesOf(inside)) join(a, b), join(b, c);
    std::map<int, int> vertices, triangles, outline_sides;
    for (int edge = 0; edge < 12; ++edge)
      if (Changes(inside, edge)) ++vertices[piece[static_cast<std::size_t>(edge)]];
    for (const auto& triangle : TrianglesOf(inside)) ++triangles[piece[triangle[0]]];
    for (const Segment& side : OutlineOf(inside))
      ++outline_sides[piece[static_cast<std::size_t>(side.first)]];
    for (const auto& [name, count] : vertices) {
      // All of a polygon's corners are on its outline, so n corners make n - 2 triangles.
      EXPECT_EQ(outline_sides[name], count) << "case " << inside;
      EXPECT_EQ(triangles[name], count - 2) << "case " << inside;
    }
  }
}

TEST(CubeTable, NeighboursDrawTheSameSegmentsTheOtherWayRound) {
  int segments = 0;
  for (int face = 0; face < 6; ++face) {
    const int bit = 1 << (face / 2);
    for (unsigned a = 0; a < kCases; ++a) {
      const std::set<Segment> here = OnFace(a, face);
      // Every neighbour with the same labels on the face: its other four corners are free.
      for (unsigned free = 0; free < 16; ++free) {
        unsigned b = 0, next = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const bool is_shared = IsOnFace(corner, face ^ 1);
          const bool value = is_shared ? IsInside(a, corner ^ bit) : ((free >> next) & 1U) != 0;
          if (!is_shared) ++next;
          if (value) b |= 1U << static_cast<unsigned>(corner);
        }
        std::set<Segment> beyond;
        for (const Segment& segment : OnFace(b, face ^ 1)) {
          const Segment seen = SeenFromBeyond(segment, face);
          beyond.insert({seen.second, seen.first});
        }
        ASSERT_EQ(here, beyond) << "cases " << a << " and " << b << ", face " << face;
      }
      segments += static_cast<int>(here.size());
    }
  }
  EXPECT_GT(segments, static_cast<int>(kCases));
}

// Wherever on the edges the vertices stand, no triangle is a line, and the outline has the object on its
// proper side: on a face, seen from outside the cube, the inside corners are to the right of the segments.
TEST(CubeTable, NormalsPointOutOfTheObject) {
  std::mt19937_64 engine(8001);
  std::uniform_real_distribution<double> share(1.0 / 2048, 1.0 - 1.0 / 2048);
  for (unsigned inside = 0; inside < kCases; ++inside) {
    for (int trial = 0; trial < 20; ++trial) {
      std::array<Vector3d, 12> at;
      for (int edge = 0; edge < 12; ++edge) at[static_cast<std::size_t>(edge)] = PointOn(edge, share(engine));
      for (const auto& [a, b, c] : TrianglesOf(inside))
        EXPECT_GT((at[b] - at[a]).cross(at[c] - at[a]).norm(), 0.0) << "case " << inside;
      for (const auto& [from, to] : OutlineOf(inside)) {
        const int face = SharedFace(from, to);
        Vector3d outward = Vector3d::Zero();
        outward[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
        // A corner of the first edge: inside ones are on the segment's inner side.
        const CubeEdge& edge = kCubeEdges[static_cast<std::size_t>(from)];
        const Vector3d way = at[static_cast<std::size_t>(to)] - at[static_cast<std::size_t>(from)];
        const Vector3d to_corner = CornerAt(edge.low) - at[static_cast<std::size_t>(from)];
        const double side = outward.dot(way.cross(to_corner));
        EXPECT_EQ(side < 0.0, IsInside(inside, edge.low)) << "case " << inside << ", face " << face;
      }
    }
  }
}

TEST(CubeTable, OneCornerInsideIsCutOffFacingAwayFromIt) {
  for (int corner = 0; corner < 8; ++corner) {
    const auto triangles = TrianglesOf(std::size_t{1} << static_cast<unsigned>(corner));
    ASSERT_EQ(triangles.size(), 1U);
    const Vector3d a = PointOn(triangles[0][0], 0.5), b = PointOn(triangles[0][1], 0.5),
                   c = PointOn(triangles[0][2], 0.5);
    EXPECT_LT((b - a).cross(c - a).dot(CornerAt(corner) - a), 0.0) << corner;
  }
}

}  // namespace
}  // namespace elbowroom::recon
