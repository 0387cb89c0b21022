#include "review/inside_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include "core/bvh.h"
#include "core/triangle_mesh.h"
#include "tests/oracles/mesh_gap.h"
#include "tests/review/random_parts.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using core::TriangleMesh;
using testing::PartKind;

// One to four closed bodies that may overlap, be in each other, or be there twice; some face inwards.
TriangleMesh SomeBodies(std::mt19937_64& random) {
  TriangleMesh bodies;
  const auto count = 1 + random() % 4;
  for (unsigned i = 0; i < count; ++i) {
    constexpr PartKind kClosed[] = {PartKind::kBox, PartKind::kLumpyBall, PartKind::kPrism};
    TriangleMesh body =
        core::Transformed(testing::MakePart(kClosed[random() % 3], random), testing::AnyPose(random, 15.0));
    if (random() % 4 == 0)
      for (auto& [a, b, c] : body.triangles) std::swap(b, c);
    core::Append(bodies, body);
    if (random() % 4 == 0) core::Append(bodies, body);
  }
  return bodies;
}

TEST(InsideClosedMesh, IsWhereTheSolidAngleSaysThatItWindsAround) {
  std::mt19937_64 random(20261122);
  std::uniform_real_distribution<double> place_mm(-40.0, 40.0);
  int inside = 0, many_times = 0;
  for (int trial = 0; trial < 300 * test_support::SoakScale(); ++trial) {
    const core::TriangleTree part(std::make_shared<const TriangleMesh>(SomeBodies(random)));
    ASSERT_TRUE(part.is_closed());
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d x_in_part(place_mm(random), place_mm(random), place_mm(random));
      const auto winding =
          static_cast<double>(oracles::WindingNumber(part.mesh(), x_in_part.cast<long double>()));
      ASSERT_EQ(IsInsideClosedMesh(part, x_in_part), std::abs(winding) > 0.5) << x_in_part.transpose();
      inside += std::abs(winding) > 0.5 ? 1 : 0;
      many_times += std::abs(winding) > 1.5 ? 1 : 0;
    }
  }
  EXPECT_GT(many_times, 0);
  EXPECT_GT(inside, many_times);
}

}  // namespace
}  // namespace elbowroom::review
