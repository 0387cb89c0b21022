#include "core/triangle_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "tests/core/solids.h"

namespace elbowroom::core {
namespace {

using testing::Box;
using testing::CornerTetrahedron;

constexpr double kRelative = 1e-12;  // sums of a dozen doubles

TriangleMesh Reversed(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

TEST(TriangleMesh, BoxHasItsVolumeAreaAndBounds) {
  const TriangleMesh box = Box({10, 20, 30});
  EXPECT_NEAR(VolumeMm3(box), 6000.0, 6000.0 * kRelative);
  EXPECT_NEAR(AreaMm2(box), 2200.0, 2200.0 * kRelative);
  EXPECT_TRUE(IsWatertight(box));
  EXPECT_EQ(BoundsOf(box).min(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(BoundsOf(box).max(), Eigen::Vector3d(10, 20, 30));
}

TEST(TriangleMesh, TetrahedronHasItsVolumeAndArea) {
  const TriangleMesh tetrahedron = CornerTetrahedron(6.0);
  EXPECT_NEAR(VolumeMm3(tetrahedron), 36.0, 36.0 * kRelative);
  EXPECT_NEAR(AreaMm2(tetrahedron), 54.0 + 18.0 * std::sqrt(3.0), 100.0 * kRelative);
  EXPECT_TRUE(IsWatertight(tetrahedron));
}

TEST(TriangleMesh, VolumeSurvivesBeingFarFromTheOrigin) {
  const RigidTransform far_away = FromPositionAndRollPitchYaw({1e6, -2e6, 3e6}, {10, 20, 30});
  // Vertices at 4e6 mm are rounded to 5e-10 mm, 1e-10 of the edges.
  EXPECT_NEAR(VolumeMm3(Transformed(Box({10, 10, 10}), far_away)), 1000.0, 1e-6);
}

TEST(TriangleMesh, ReversedHasNegativeVolumeAndStaysClosed) {
  const TriangleMesh reversed = Reversed(Box({1, 1, 1}));
  EXPECT_NEAR(VolumeMm3(reversed), -1.0, kRelative);
  EXPECT_TRUE(IsWatertight(reversed));
}

TEST(IsWatertight, RefusesOpenInconsistentAndSharedEdges) {
  TriangleMesh open = Box({1, 1, 1});
  open.triangles.pop_back();
  EXPECT_FALSE(IsWatertight(open));

  TriangleMesh one_turned = Box({1, 1, 1});
  std::swap(one_turned.triangles[4][0], one_turned.triangles[4][1]);
  EXPECT_FALSE(IsWatertight(one_turned));

  TriangleMesh doubled = Box({1, 1, 1});
  doubled.triangles.push_back(doubled.triangles.front());
  EXPECT_FALSE(IsWatertight(doubled));

  EXPECT_FALSE(IsWatertight({}));
  EXPECT_FALSE(IsWatertight({{{0, 0, 0}}, {{0, 0, 0}}}));
}

TEST(TriangleMesh, AppendedSolidsKeepTheirPlacesAndAddUp) {
  TriangleMesh both = Box({10, 10, 10});
  Append(both, Transformed(CornerTetrahedron(6.0), FromPositionAndRollPitchYaw({100, 0, 0}, {0, 0, 0})));
  EXPECT_NO_THROW(ValidateMesh(both, "both"));
  EXPECT_TRUE(IsWatertight(both));
  EXPECT_NEAR(VolumeMm3(both), 1036.0, 1e-9);  // the offset of 100 mm costs two digits
  EXPECT_EQ(BoundsOf(both).max().x(), 106.0);
}

TEST(ValidateMesh, NamesWhereAndWhat) {
  const auto message_of = [](const TriangleMesh& mesh) -> std::string {
    try {
      ValidateMesh(mesh, "bracket.stl");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kGeometry);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message_of(Box({1, 1, 1})), "");
  EXPECT_NE(message_of({}).find("bracket.stl: the mesh has no triangles"), std::string::npos);
  TriangleMesh with_nan = Box({1, 1, 1});
  with_nan.vertices_mm[5].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of(with_nan).find("bracket.stl: vertex 5"), std::string::npos);
  TriangleMesh with_infinity = Box({1, 1, 1});
  with_infinity.vertices_mm[7].z() = std::numeric_limits<double>::infinity();
  EXPECT_NE(message_of(with_infinity).find("vertex 7"), std::string::npos);
  for (const std::int32_t index : {-1, 8}) {
    TriangleMesh out_of_range = Box({1, 1, 1});
    out_of_range.triangles[3][2] = index;
    EXPECT_NE(message_of(out_of_range).find("triangle 3"), std::string::npos);
  }
  for (const double deviation_mm :
       {-1e-9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TriangleMesh off = Box({1, 1, 1});
    off.deviation_mm = deviation_mm;
    EXPECT_NE(message_of(off).find("bracket.stl: a deviation"), std::string::npos);
  }
}

TEST(ContentHash, EqualForEqualMeshesOnly) {
  const TriangleMesh box = Box({1, 2, 3});
  const std::string hash = ContentHash(box);
  EXPECT_EQ(hash.size(), 32U);
  EXPECT_EQ(ContentHash(Box({1, 2, 3})), hash);
  TriangleMesh moved = box;
  moved.vertices_mm[0].x() = 1e-9;
  EXPECT_NE(ContentHash(moved), hash);
  EXPECT_NE(ContentHash(Reversed(box)), hash);
  TriangleMesh tessellated = box;
  tessellated.deviation_mm = 1e-9;
  EXPECT_NE(ContentHash(tessellated), hash);
}

TEST(Append, KeepsTheLargerDeviation) {
  TriangleMesh mesh = Box({1, 1, 1}), other = Box({2, 2, 2});
  other.deviation_mm = 0.2;
  Append(mesh, other);
  EXPECT_EQ(mesh.deviation_mm, 0.2);
  Append(mesh, Box({3, 3, 3}));
  EXPECT_EQ(mesh.deviation_mm, 0.2);
  EXPECT_EQ(Transformed(mesh, {}).deviation_mm, 0.2);
}

}  // namespace
}  // namespace elbowroom::core
