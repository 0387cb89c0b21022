#include "review/triangle_gap.h"

#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <ostream>
#include <random>
#include <string>

#include "tests/oracles/mesh_gap.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

// Coordinates are below 50 mm, so doubles are some 1e-14 mm apart. A distance of nearly 0 is the root of
// nothing: its error isn't its square's.
constexpr double kGapRoundingMm = 1e-12;

enum class Family { kAny, kLattice, kTurnedLattice, kParallelEdges, kParallelPlanes, kThin, kNearlyParallel };

const char* NameOf(Family family) {
  constexpr const char* kNames[] = {"any",
                                    "on a lattice",
                                    "on a turned lattice",
                                    "with parallel edges",
                                    "in parallel planes",
                                    "without area",
                                    "with nearly parallel edges"};
  return kNames[static_cast<std::size_t>(family)];
}

class TrianglePairs {
 public:
  explicit TrianglePairs(Family family) : family_(family) {}

  void Next() {
    const Vector3d offset = (1.0 + Unit()) * 10.0 * Vector3d(0.3, 0.5, 0.7);
    for (Vector3d& corner : a) corner = 10.0 * Any();
    for (Vector3d& corner : b) corner = 10.0 * Any() + offset;
    switch (family_) {
      case Family::kAny:
        return;
      case Family::kLattice:
        return Snap();
      case Family::kTurnedLattice:
        Snap();
        return Turn();
      case Family::kParallelEdges:
        b[1] = b[0] + (0.5 + 0.4 * Unit()) * (a[1] - a[0]);
        return Turn();
      case Family::kParallelPlanes:
        for (Vector3d& corner : a) corner.z() = 0.0;
        for (Vector3d& corner : b) corner.z() = 1.0;
        return Turn();
      case Family::kThin:
        a[2] = a[0] + Unit() * (a[1] - a[0]);
        if (Unit() < 0.0) a[1] = a[0];
        if (Unit() < 0.0) b[2] = b[1];
        return;
      case Family::kNearlyParallel:
        b[1] = b[0] + 0.7 * (a[1] - a[0]) + std::pow(10.0, -7.0 + 6.0 * Unit()) * Any();
        return Turn();
    }
  }

  Triangle a, b;

 private:
  double Unit() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  Vector3d Any() { return {Unit(), Unit(), Unit()}; }
  void Snap() {
    for (Triangle* triangle : {&a, &b})
      for (Vector3d& corner : *triangle) corner = 3.0 * (corner / 3.0).array().round();
  }
  void Turn() {
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(Unit(), Unit(), Unit(), Unit()).normalized().toRotationMatrix();
    for (Triangle* triangle : {&a, &b})
      for (Vector3d& corner : *triangle) corner = turn * corner;
  }

  Family family_;
  std::mt19937_64 random_{20'261'121};
};

oracles::LongTriangle Long(const Triangle& triangle) {
  return {triangle[0].cast<long double>(), triangle[1].cast<long double>(), triangle[2].cast<long double>()};
}

double FclDistance(const Triangle& a, const Triangle& b) {
  Vector3d on_a, on_b;
  return fcl::detail::TriangleDistance<double>::triDistance(a[0], a[1], a[2], b[0], b[1], b[2], on_a, on_b);
}

void PrintTo(Family family, std::ostream* out) { *out << NameOf(family); }

class TriangleGap : public ::testing::TestWithParam<Family> {};

// Says how often FCL's distance of the same triangles is wrong, which is why it isn't used.
TEST_P(TriangleGap, IsThatOfLongDouble) {
  const int count = 20'000 * test_support::SoakScale();
  TrianglePairs pairs(GetParam());
  double worst_mm = 0.0, worst_of_fcl_mm = 0.0;
  int wrong_of_fcl = 0;
  for (int i = 0; i < count; ++i) {
    pairs.Next();
    const SurfaceGap gap = GapBetween(pairs.a, pairs.b);
    const double truth_mm =
        static_cast<double>(oracles::GapOfTriangles(Long(pairs.a), Long(pairs.b)).distance_mm);
    worst_mm = std::max(worst_mm, std::abs(gap.distance_mm - truth_mm));
    ASSERT_NEAR(gap.distance_mm, truth_mm, kGapRoundingMm) << "pair " << i;
    ASSERT_EQ((gap.on_a - gap.on_b).norm(), gap.distance_mm) << "pair " << i;
    const double error_of_fcl_mm = std::abs(FclDistance(pairs.a, pairs.b) - truth_mm);
    wrong_of_fcl += error_of_fcl_mm > 1e-6 ? 1 : 0;
    worst_of_fcl_mm = std::max(worst_of_fcl_mm, error_of_fcl_mm);
  }
  std::printf(
      "triangles %s: %d pairs, worst error %.1e mm; FCL's own distance wrong for %d, by up to %.3g mm\n",
      NameOf(GetParam()), count, worst_mm, wrong_of_fcl, worst_of_fcl_mm);
}

INSTANTIATE_TEST_SUITE_P(Families, TriangleGap,
                         ::testing::Values(Family::kAny, Family::kLattice, Family::kTurnedLattice,
                                           Family::kParallelEdges, Family::kParallelPlanes, Family::kThin,
                                           Family::kNearlyParallel));

}  // namespace
}  // namespace elbowroom::review
