#include "cad_import/normalisation/self_intersections.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/progress.h"

namespace elbowroom::cad_import {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
using Corners = std::array<std::int32_t, 3>;

// The corners of two triangles. Those that both have come first, in the same order.
struct Pair {
  Corners a, b;
  int shared = 0;
};

Pair SharedFirst(const Corners& a, const Corners& b) {
  Pair pair{a, b, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto shared = static_cast<std::ptrdiff_t>(pair.shared);
    const auto twin = std::find(pair.b.begin() + shared, pair.b.end(), pair.a[i]);
    if (twin == pair.b.end()) continue;
    std::iter_swap(pair.b.begin() + shared, twin);
    std::swap(pair.a[static_cast<std::size_t>(shared)], pair.a[i]);
    ++pair.shared;
  }
  return pair;
}

class PairTest {
 public:
  explicit PairTest(const core::TriangleMesh& mesh) : mesh_(mesh) {}

  [[nodiscard]] bool Meet(std::uint32_t one, std::uint32_t other) const {
    const Pair pair = SharedFirst(mesh_.triangles[one], mesh_.triangles[other]);
    const Point a0 = At(pair.a[0]), a1 = At(pair.a[1]), a2 = At(pair.a[2]);
    const Point b1 = At(pair.b[1]), b2 = At(pair.b[2]);
    switch (pair.shared) {
      case 0:
        return CGAL::do_intersect(Kernel::Triangle_3(a0, a1, a2), Kernel::Triangle_3(At(pair.b[0]), b1, b2));
      case 1:
        return MeetBesideCorner(a0, {a1, a2}, {b1, b2});
      case 2:  // folded onto each other
        return CGAL::orientation(a0, a1, a2, b2) == CGAL::COPLANAR &&
               CGAL::coplanar_orientation(a0, a1, a2, b2) == CGAL::POSITIVE;
      default:
        return false;
    }
  }

 private:
  struct Side {
    const Point &from, &to;
  };

  // If two triangles with a common corner have more points in common, these reach the opposite side of one of
  // the triangles. That is impossible if a triangle is wholly on one side of the other's plane, as most are:
  // this is tested first.
  static bool MeetBesideCorner(const Point& corner, const Side& a, const Side& b) {
    const auto is_apart = [&](const Side& plane, const Side& side) {
      const CGAL::Orientation from = CGAL::orientation(corner, plane.from, plane.to, side.from);
      return from != CGAL::COPLANAR && from == CGAL::orientation(corner, plane.from, plane.to, side.to);
    };
    const auto reaches = [&](const Side& side, const Side& across) {
      return CGAL::do_intersect(Kernel::Segment_3(side.from, side.to),
                                Kernel::Triangle_3(corner, across.from, across.to));
    };
    if (is_apart(a, b) || is_apart(b, a)) return false;
    return reaches(a, b) || reaches(b, a);
  }

  [[nodiscard]] Point At(std::int32_t corner) const {
    const Eigen::Vector3d& x = mesh_.vertices_mm[static_cast<std::size_t>(corner)];
    return {x.x(), x.y(), x.z()};
  }

  const core::TriangleMesh& mesh_;
};

// Triangles with area, in their boxes.
std::vector<Box> BoxesOf(const core::TriangleMesh& mesh) {
  std::vector<Box> boxes;
  boxes.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Point, 3> corners;
    CGAL::Bbox_3 box;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& x = mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[i][k])];
      corners[k] = {x.x(), x.y(), x.z()};
      box += corners[k].bbox();
    }
    if (!CGAL::collinear(corners[0], corners[1], corners[2])) boxes.emplace_back(box, i);
  }
  return boxes;
}

}  // namespace

SelfIntersections FindSelfIntersections(const core::TriangleMesh& mesh, const std::stop_token& stop) {
  SelfIntersections result;
  std::vector<Box> boxes = BoxesOf(mesh);
  const PairTest test(mesh);
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    core::ThrowIfStopped(stop, "the search for self-intersections");
    if (!test.Meet(a.info(), b.info())) return;
    ++result.pairs;
    result.triangles.insert(result.triangles.end(), {a.info(), b.info()});
  });
  std::ranges::sort(result.triangles);
  result.triangles.erase(std::unique(result.triangles.begin(), result.triangles.end()),
                         result.triangles.end());
  return result;
}

}  // namespace elbowroom::cad_import
