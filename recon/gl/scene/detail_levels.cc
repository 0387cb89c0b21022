#include "recon/gl/scene/detail_levels.h"

#include <meshoptimizer.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "core/part_distance.h"

namespace elbowroom::recon::gl {
namespace {

using Eigen::Vector3f;
using Indices = std::vector<unsigned>;  // three a triangle

constexpr std::size_t kFewer = 2;  // a level has this many times fewer triangles than the last
constexpr std::size_t kFewTriangles = 500;
// meshoptimizer's quadrics have single precision: they can't tell distances below about a thousandth of the
// size of what they simplify. So large meshes are simplified in pieces.
constexpr std::size_t kTrianglesAPiece = 8'000;
constexpr std::size_t kFewestPieces = 8;
// A level that keeps a larger share of the one before isn't worth its memory.
constexpr double kMostKept = 0.7;
constexpr std::size_t kFloatsPerTriangle = 18;
constexpr float kAnyError = 1.0F;  // of the mesh's extent: the number of triangles is the aim

// The normals that the whole mesh's corners have at a place.
class NormalsAtPlaces {
 public:
  explicit NormalsAtPlaces(const std::vector<float>& corners) : corners_(corners.size() / 6) {
    for (std::size_t i = 0; i < corners_.size(); ++i)
      std::copy_n(corners.begin() + static_cast<std::ptrdiff_t>(6 * i), 6, corners_[i].begin());
    std::ranges::sort(corners_);
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  }

  // The one most like `normal`; `normal` itself where the whole mesh has none.
  [[nodiscard]] Vector3f MostLike(const Vector3f& normal, const Vector3f& place) const {
    constexpr float kLowest = -std::numeric_limits<float>::infinity();
    Vector3f best = normal;
    float best_cosine = -2.0F;
    for (auto corner = std::ranges::lower_bound(
             corners_, Corner{place.x(), place.y(), place.z(), kLowest, kLowest, kLowest});
         corner != corners_.end() && Vector3f(corner->data()) == place; ++corner) {
      const Vector3f here(corner->data() + 3);
      if (normal.dot(here) <= best_cosine) continue;
      best_cosine = normal.dot(here);
      best = here;
    }
    return best;
  }

 private:
  using Corner = std::array<float, 6>;  // place, normal

  std::vector<Corner> corners_;  // in order, each once
};

// Triangles by vertices of which no two are at one place.
Indices WeldedIndices(const core::TriangleMesh& mesh) {
  Indices loose;
  loose.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::int32_t i : triangle) loose.push_back(static_cast<unsigned>(i));
  Indices welded(loose.size());
  meshopt_generateShadowIndexBuffer(welded.data(), loose.data(), loose.size(), mesh.vertices_mm.data(),
                                    mesh.vertices_mm.size(), sizeof(Eigen::Vector3d),
                                    sizeof(Eigen::Vector3d));
  return welded;
}

// A piece of a level: its triangles by numbers of their own for its vertices.
struct Piece {
  Indices indices;
  std::vector<std::int32_t> vertices;  // of the mesh, by own number
  std::vector<float> places;           // from the first, so that no digits are lost
};

// Cuts pieces out of a tree's mesh.
class Cutter {
 public:
  explicit Cutter(const core::TriangleTree& tree) : tree_(tree), own_(tree.mesh().vertices_mm.size(), -1) {}

  [[nodiscard]] Piece Cut(const core::TriangleTree::Node& node) {
    const core::TriangleMesh& mesh = tree_.mesh();
    Piece piece;
    for (const std::uint32_t triangle : tree_.order().subspan(node.begin, node.end - node.begin)) {
      for (const std::int32_t vertex : mesh.triangles[triangle]) {
        std::int32_t& own = own_[static_cast<std::size_t>(vertex)];
        if (own < 0) {
          own = static_cast<std::int32_t>(piece.vertices.size());
          piece.vertices.push_back(vertex);
        }
        piece.indices.push_back(static_cast<unsigned>(own));
      }
    }
    const auto at = [&](std::int32_t vertex) { return mesh.vertices_mm[static_cast<std::size_t>(vertex)]; };
    for (const std::int32_t vertex : piece.vertices) {
      const Vector3f place = (at(vertex) - at(piece.vertices.front())).cast<float>();
      piece.places.insert(piece.places.end(), {place.x(), place.y(), place.z()});
      own_[static_cast<std::size_t>(vertex)] = -1;
    }
    return piece;
  }

 private:
  const core::TriangleTree& tree_;
  std::vector<std::int32_t> own_;  // by the mesh's number; -1: not of this piece
};

// The topmost nodes with at most `most_triangles` triangles.
std::vector<core::TriangleTree::Node> NodesOf(const core::TriangleTree& tree, std::size_t most_triangles) {
  std::vector<core::TriangleTree::Node> nodes;
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const core::TriangleTree::Node& node = tree.nodes()[open.back()];
    open.pop_back();
    if (node.end - node.begin <= most_triangles || node.left == 0) {
      nodes.push_back(node);
    } else {
      open.insert(open.end(), {node.left, node.left + 1});
    }
  }
  return nodes;
}

// Simplifies a large mesh piece by piece. The borders of pieces stay as they are, so that the pieces still
// fit together.
Indices Simplified(const core::TriangleTree& tree) {
  const std::size_t triangles = tree.mesh().triangles.size();
  const bool is_in_pieces = triangles >= kFewestPieces * kTrianglesAPiece;
  Cutter cutter(tree);
  Indices fewer;
  for (const core::TriangleTree::Node& node : NodesOf(tree, is_in_pieces ? kTrianglesAPiece : triangles)) {
    const Piece piece = cutter.Cut(node);
    const std::size_t aim = piece.indices.size() / 3 / kFewer * 3;
    Indices kept(piece.indices.size());
    kept.resize(meshopt_simplify(kept.data(), piece.indices.data(), piece.indices.size(), piece.places.data(),
                                 piece.vertices.size(), 3 * sizeof(float), aim, kAnyError,
                                 is_in_pieces ? meshopt_SimplifyLockBorder : 0, nullptr));
    for (const unsigned own : kept) fewer.push_back(static_cast<unsigned>(piece.vertices[own]));
  }
  return fewer;
}

core::SharedMesh MeshOf(const Indices& indices, const core::TriangleMesh& mesh) {
  auto level = std::make_shared<core::TriangleMesh>();
  level->vertices_mm = mesh.vertices_mm;
  for (std::size_t i = 0; i < indices.size(); i += 3)
    level->triangles.push_back({static_cast<std::int32_t>(indices[i]),
                                static_cast<std::int32_t>(indices[i + 1]),
                                static_cast<std::int32_t>(indices[i + 2])});
  return level;
}

// How far the farthest of the vertices in use is from the level's surface.
double FarthestMm(const core::TriangleMesh& mesh, const Indices& used, const core::TriangleTree& level) {
  std::vector<bool> is_used(mesh.vertices_mm.size(), false);
  for (const unsigned i : used) is_used[i] = true;
  double farthest_mm = 0.0;
  std::uint32_t likely = 0;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) continue;
    const core::NearestOnPart nearest = core::FindNearest(level, {.center = mesh.vertices_mm[i]}, likely);
    farthest_mm = std::max(farthest_mm, nearest.distance_mm);
    likely = nearest.triangle;
  }
  return farthest_mm;
}

void Append(std::vector<float>& floats, const Vector3f& vector) {
  floats.insert(floats.end(), {vector.x(), vector.y(), vector.z()});
}

// Triangles without area are left out.
std::vector<float> DrawnCorners(const Indices& indices, const core::TriangleMesh& mesh,
                                const NormalsAtPlaces& normals) {
  std::vector<float> corners;
  corners.reserve(6 * indices.size());
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const auto at = [&](std::size_t k) -> const Eigen::Vector3d& { return mesh.vertices_mm[indices[i + k]]; };
    const Eigen::Vector3d across = (at(1) - at(0)).cross(at(2) - at(0));
    if (!(across.norm() > 0.0)) continue;
    const Vector3f own = across.normalized().cast<float>();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3f place = at(k).cast<float>();
      Append(corners, place);
      Append(corners, normals.MostLike(own, place));
    }
  }
  return corners;
}

}  // namespace

std::vector<DetailLevel> MakeDetailLevels(const core::TriangleMesh& mesh, const SurfaceMesh& whole,
                                          const std::stop_token& stop) {
  std::vector<DetailLevel> levels;
  const Indices all = WeldedIndices(mesh);
  const NormalsAtPlaces normals(whole.corners);
  core::TriangleTree last(MeshOf(all, mesh));
  while (last.mesh().triangles.size() > kFewTriangles && !stop.stop_requested()) {
    const Indices fewer = Simplified(last);
    const auto most = kMostKept * static_cast<double>(3 * last.mesh().triangles.size());
    if (fewer.empty() || static_cast<double>(fewer.size()) > most) break;
    last = core::TriangleTree(MeshOf(fewer, mesh));
    std::vector<float> corners = DrawnCorners(fewer, mesh, normals);
    const auto triangles = static_cast<std::int64_t>(corners.size() / kFloatsPerTriangle);
    levels.push_back({std::move(corners), triangles, FarthestMm(mesh, all, last)});
  }
  return levels;
}

}  // namespace elbowroom::recon::gl
