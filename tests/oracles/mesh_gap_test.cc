#include "tests/oracles/mesh_gap.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/core/solids.h"

namespace elbowroom::oracles {
namespace {

// Of a few operations on coordinates up to 100 in long double.
constexpr long double kRounding = 1e-16L;

// EXPECT_NEAR is one of doubles.
void ExpectNear(long double found, long double expected, long double tolerance) {
  EXPECT_LE(std::abs(found - expected), tolerance) << static_cast<double>(found);
}

LongTriangle Shifted(const LongTriangle& triangle, const LongVector& by) {
  return {triangle[0] + by, triangle[1] + by, triangle[2] + by};
}

const LongTriangle kFlat = {LongVector(0, 0, 0), LongVector(10, 0, 0), LongVector(0, 10, 0)};

TEST(MeshGap, CornersEdgesAndFacesOfTwoTrianglesMeasureByHand) {
  const LongTriangle spike = {LongVector(2, 2, 3), LongVector(2, 2, 9), LongVector(3, 2, 9)};
  ExpectNear(GapOfTriangles(kFlat, spike).distance_mm, 3.0L, kRounding);  // corner over face
  ExpectNear(GapOfTriangles(spike, kFlat).distance_mm, 3.0L, kRounding);  // and the other way
  EXPECT_EQ(GapOfTriangles(kFlat, spike).on_a, LongVector(2, 2, 0));
  EXPECT_EQ(GapOfTriangles(spike, kFlat).on_a, LongVector(2, 2, 3));
  const LongTriangle beside = Shifted(kFlat, {0, -14, 0});  // coplanar: corner, edge
  ExpectNear(GapOfTriangles(kFlat, beside).distance_mm, 4.0L, kRounding);
  const LongTriangle across = {LongVector(5, -3, -4), LongVector(5, -3, 4), LongVector(5, -9, 0)};
  ExpectNear(GapOfTriangles(kFlat, across).distance_mm, 3.0L, kRounding);      // edge, edge
  ExpectNear(GapOfTriangles(kFlat, Shifted(kFlat, {13, -14, 0})).distance_mm,  // corner, corner: 3 and 4
             5.0L, kRounding);
}

TEST(MeshGap, TrianglesThatCrossTouchOrLieInEachOtherAreNotApart) {
  const LongTriangle through = {LongVector(2, 2, -3), LongVector(2, 2, 9), LongVector(3, 2, 9)};
  EXPECT_EQ(GapOfTriangles(kFlat, through).distance_mm, 0.0L);
  EXPECT_EQ(GapOfTriangles(through, kFlat).distance_mm, 0.0L);
  EXPECT_EQ(GapOfTriangles(kFlat, kFlat).distance_mm, 0.0L);
  EXPECT_EQ(GapOfTriangles(kFlat, Shifted(kFlat, {10, 0, 0})).distance_mm, 0.0L);  // corner on corner
  const LongTriangle inner = {LongVector(1, 1, 0), LongVector(2, 1, 0), LongVector(1, 2, 0)};
  EXPECT_EQ(GapOfTriangles(kFlat, inner).distance_mm, 0.0L);
}

TEST(MeshGap, ATriangleWithoutAreaIsItsSegmentOrPoint) {
  const LongTriangle point = {LongVector(3, 3, 7), LongVector(3, 3, 7), LongVector(3, 3, 7)};
  ExpectNear(GapOfTriangles(kFlat, point).distance_mm, 7.0L, kRounding);
  const LongTriangle segment = {LongVector(3, 3, 7), LongVector(3, 3, 1), LongVector(3, 3, -2)};
  EXPECT_EQ(GapOfTriangles(kFlat, segment).distance_mm, 0.0L);
  ExpectNear(GapOfTriangles(Shifted(segment, {-5, 0, 0}), kFlat).distance_mm, 2.0L, kRounding);
  ExpectNear(GapOfTriangles(segment, point).distance_mm, 0.0L, kRounding);
}

TEST(MeshGap, BoxesOnTheDiagonalAreADiagonalApartWhereverTheyStand) {
  const core::TriangleMesh box = core::testing::Box({10, 20, 30});
  const core::RigidTransform turned = core::FromPositionAndRollPitchYaw({1e7, -2e7, 3e6}, {0, 0, 90});
  core::RigidTransform shifted = turned;
  shifted.translation_mm += turned.rotation * Eigen::Vector3d(13, 24, 42);
  const Gap gap = GapOfMeshes(box, turned, box, shifted);
  ExpectNear(gap.distance_mm, 13.0L, 1e-7L);  // 3, 4, 12; poses are doubles some 1e7 from 0
  const LongVector corner = (turned * Eigen::Vector3d(10, 20, 30)).cast<long double>();
  ExpectNear((gap.on_a - corner).norm(), 0.0L, 1e-7L);
}

TEST(MeshGap, AClosedMeshWindsOnceAroundWhatIsInsideIt) {
  const core::TriangleMesh box = core::testing::Box({10, 20, 30});
  constexpr long double kAngles = 1e-15L;  // a dozen arc tangents
  ExpectNear(WindingNumber(box, {1, 19, 15}), 1.0L, kAngles);
  ExpectNear(WindingNumber(box, {-1, 19, 15}), 0.0L, kAngles);
  ExpectNear(WindingNumber(box, {100, 100, 100}), 0.0L, kAngles);
}

}  // namespace
}  // namespace elbowroom::oracles
