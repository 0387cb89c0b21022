#include "recon/swept_volume/kuhn_cell.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "core/triangle_mesh.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/recon/scenes/vertex_fans.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

Vector3d CornerOf(unsigned corner) { return Vector3d(corner & 1U, corner >> 1U & 1U, corner >> 2U); }

// A grid of random labels, its border outside.
class Labels {
 public:
  static constexpr int kSide = 7;
  Labels(Random* random, double share) {
    for (int z = 1; z + 1 < kSide; ++z)
      for (int y = 1; y + 1 < kSide; ++y)
        for (int x = 1; x + 1 < kSide; ++x) inside_[x][y][z] = random->Chance(share);
  }
  [[nodiscard]] bool At(int x, int y, int z) const { return inside_[x][y][z]; }
  [[nodiscard]] unsigned Cell(int x, int y, int z) const {
    unsigned inside = 0;
    for (unsigned c = 0; c < kCellCorners; ++c)
      if (At(x + static_cast<int>(c & 1U), y + static_cast<int>(c >> 1U & 1U), z + static_cast<int>(c >> 2U)))
        inside |= 1U << c;
    return inside;
  }

 private:
  bool inside_[kSide][kSide][kSide] = {};
};

// Vertices in the middle of their edges.
core::TriangleMesh MeshOf(const Labels& labels) {
  core::TriangleMesh mesh;
  std::map<std::array<int, 3>, std::int32_t> numbers;  // by twice the place
  for (int z = 0; z + 1 < Labels::kSide; ++z) {
    for (int y = 0; y + 1 < Labels::kSide; ++y) {
      for (int x = 0; x + 1 < Labels::kSide; ++x) {
        for (const CellTriangle& triangle : CellTriangles(labels.Cell(x, y, z))) {
          auto& numbered = mesh.triangles.emplace_back();
          for (std::size_t k = 0; k < 3; ++k) {
            const Vector3d place =
                Vector3d(x, y, z) + 0.5 * (CornerOf(triangle[k].low) + CornerOf(triangle[k].high));
            const Eigen::Vector3i twice = (2.0 * place).cast<int>();
            const auto [at, is_new] = numbers.try_emplace({twice.x(), twice.y(), twice.z()},
                                                          static_cast<std::int32_t>(numbers.size()));
            if (is_new) mesh.vertices_mm.push_back(place);
            numbered[k] = at->second;
          }
        }
      }
    }
  }
  return mesh;
}

TEST(KuhnCell, RandomLabelsGiveAClosedManifoldFacingOut) {
  Random random(2401);
  for (int trial = 0; trial < 60; ++trial) {
    const Labels labels(&random, random.Uniform(0.05, 0.95));
    const core::TriangleMesh mesh = MeshOf(labels);
    if (mesh.triangles.empty()) continue;
    EXPECT_TRUE(core::IsWatertight(mesh));
    EXPECT_TRUE(EveryVertexHasOneFan(mesh));
    EXPECT_GT(core::VolumeMm3(mesh), 0.0);
  }
}

// The mesh of one corner is the polyhedron of the middles of its 14 edges; its volume by hand: each of the 24
// tetrahedra around a corner gives an eighth of its sixth.
TEST(KuhnCell, OneCornerHasTheVolumeOfItsTetrahedra) {
  double volume_mm3 = 0.0;
  for (unsigned corner = 0; corner < kCellCorners; ++corner)
    for (const CellTriangle& t : CellTriangles(1U << corner)) {
      std::array<Vector3d, 3> p;
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = 0.5 * (CornerOf(t[k].low) + CornerOf(t[k].high)) - CornerOf(corner);
      volume_mm3 += p[0].dot(p[1].cross(p[2])) / 6.0;
    }
  EXPECT_NEAR(volume_mm3, 24.0 / 48.0, 1e-12);
}

TEST(KuhnCell, NoTrianglesWithoutASurface) {
  EXPECT_TRUE(CellTriangles(0).empty());
  EXPECT_TRUE(CellTriangles(255).empty());
}

}  // namespace
}  // namespace elbowroom::recon
