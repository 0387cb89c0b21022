#include "recon/gl/scene/surface_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>

namespace elbowroom::recon::gl {
namespace {

using Triangle = std::array<std::int32_t, 3>;

// With more triangles than this around one vertex (fans of caps and cones) each keeps its own normal:
// averaging is quadratic in their number.
constexpr std::size_t kMaxAveragedFan = 512;

struct WeldedMesh {
  std::vector<Triangle> triangles;       // into the mesh's vertices, first of those at one place
  std::vector<Eigen::Vector3d> normals;  // unit, one a triangle
};

std::vector<std::int32_t> FirstVertexAtSamePlace(const std::vector<Eigen::Vector3d>& vertices) {
  const auto place = [&](std::int32_t i) {
    const Eigen::Vector3d& v = vertices[static_cast<std::size_t>(i)];
    return std::make_tuple(v.x(), v.y(), v.z());
  };
  std::vector<std::int32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return place(a) < place(b); });
  std::vector<std::int32_t> first(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && place(order[i - 1]) == place(order[i]);
    first[static_cast<std::size_t>(order[i])] =
        same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return first;
}

WeldedMesh Weld(const core::TriangleMesh& mesh) {
  const std::vector<std::int32_t> first = FirstVertexAtSamePlace(mesh.vertices_mm);
  WeldedMesh welded;
  for (const Triangle& triangle : mesh.triangles) {
    Triangle joined{};
    std::array<Eigen::Vector3d, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
      joined[i] = first[static_cast<std::size_t>(triangle[i])];
      corner[i] = mesh.vertices_mm[static_cast<std::size_t>(joined[i])];
    }
    const Eigen::Vector3d area_normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double length = area_normal.norm();
    if (length <= 0.0) continue;
    welded.triangles.push_back(joined);
    welded.normals.emplace_back(area_normal / length);
  }
  return welded;
}

// One triangle's corner at a vertex.
struct Corner {
  std::int32_t vertex = 0;
  std::size_t triangle = 0;
  std::size_t place = 0;  // 0, 1, 2 within the triangle
  double angle_rad = 0.0;
};

std::vector<Corner> CornersByVertex(const core::TriangleMesh& mesh, const WeldedMesh& welded) {
  std::vector<Corner> corners;
  corners.reserve(3 * welded.triangles.size());
  for (std::size_t t = 0; t < welded.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = [&](std::size_t k) -> const Eigen::Vector3d& {
        return mesh.vertices_mm[static_cast<std::size_t>(welded.triangles[t][(i + k) % 3])];
      };
      const Eigen::Vector3d a = at(1) - at(0);
      const Eigen::Vector3d b = at(2) - at(0);
      corners.push_back({welded.triangles[t][i], t, i, std::atan2(a.cross(b).norm(), a.dot(b))});
    }
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
  return corners;
}

Eigen::Vector3d CornerNormal(const WeldedMesh& welded, const Corner* begin, const Corner* end,
                             const Corner& corner, double min_cosine) {
  const Eigen::Vector3d& own = welded.normals[corner.triangle];
  if (static_cast<std::size_t>(end - begin) > kMaxAveragedFan) return own;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Corner* other = begin; other != end; ++other) {
    const Eigen::Vector3d& normal = welded.normals[other->triangle];
    if (own.dot(normal) >= min_cosine) sum += other->angle_rad * normal;
  }
  const double length = sum.norm();
  return length > 0.0 ? Eigen::Vector3d(sum / length) : own;
}

void AppendPoint(std::vector<float>& floats, const Eigen::Vector3d& point) {
  for (int axis = 0; axis < 3; ++axis) floats.push_back(static_cast<float>(point[axis]));
}

std::vector<float> DrawnCorners(const core::TriangleMesh& mesh, const WeldedMesh& welded, double min_cosine) {
  const std::vector<Corner> corners = CornersByVertex(mesh, welded);
  std::vector<std::array<Eigen::Vector3d, 3>> normals(welded.triangles.size());
  for (std::size_t begin = 0; begin < corners.size();) {
    std::size_t end = begin;
    while (end < corners.size() && corners[end].vertex == corners[begin].vertex) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      normals[corners[i].triangle][corners[i].place] =
          CornerNormal(welded, corners.data() + begin, corners.data() + end, corners[i], min_cosine);
    }
    begin = end;
  }
  std::vector<float> floats;
  floats.reserve(18 * welded.triangles.size());
  for (std::size_t t = 0; t < welded.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      AppendPoint(floats, mesh.vertices_mm[static_cast<std::size_t>(welded.triangles[t][i])]);
      AppendPoint(floats, normals[t][i]);
    }
  }
  return floats;
}

// An edge as one triangle runs along it.
struct HalfEdge {
  std::int32_t low = 0;
  std::int32_t high = 0;
  std::size_t triangle = 0;
  bool ascending = false;
};

std::vector<float> FeatureEdges(const core::TriangleMesh& mesh, const WeldedMesh& welded, double min_cosine) {
  std::vector<HalfEdge> halves;
  halves.reserve(3 * welded.triangles.size());
  for (std::size_t t = 0; t < welded.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t from = welded.triangles[t][i];
      const std::int32_t to = welded.triangles[t][(i + 1) % 3];
      halves.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  const auto ends = [](const HalfEdge& half) { return std::make_pair(half.low, half.high); };
  std::stable_sort(halves.begin(), halves.end(),
                   [&](const HalfEdge& a, const HalfEdge& b) { return ends(a) < ends(b); });
  std::vector<float> floats;
  for (std::size_t begin = 0; begin < halves.size();) {
    std::size_t end = begin;
    while (end < halves.size() && ends(halves[end]) == ends(halves[begin])) ++end;
    bool feature = end - begin != 2;
    if (!feature) {
      const HalfEdge& a = halves[begin];
      const HalfEdge& b = halves[begin + 1];
      const double cosine = welded.normals[a.triangle].dot(welded.normals[b.triangle]);
      feature = (a.ascending == b.ascending ? -cosine : cosine) < min_cosine;  // same way: one is turned over
    }
    if (feature) {
      AppendPoint(floats, mesh.vertices_mm[static_cast<std::size_t>(halves[begin].low)]);
      AppendPoint(floats, mesh.vertices_mm[static_cast<std::size_t>(halves[begin].high)]);
    }
    begin = end;
  }
  return floats;
}

}  // namespace

SurfaceMesh PrepareSurface(const core::TriangleMesh& mesh, double crease_rad) {
  const WeldedMesh welded = Weld(mesh);
  const double min_cosine = std::cos(crease_rad);
  return {DrawnCorners(mesh, welded, min_cosine), FeatureEdges(mesh, welded, min_cosine)};
}

}  // namespace elbowroom::recon::gl
