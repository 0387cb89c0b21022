// What hides a place from an eye is cut away, and only then.
#include "app/control/report/cut_away.h"

#include <gtest/gtest.h>

#include <memory>

namespace elbowroom::tests {
namespace {

using Eigen::Vector3d;

// A square of 200 mm at right angles to y, with its middle in the origin of its part.
core::SharedMesh Wall() {
  core::TriangleMesh mesh;
  mesh.vertices_mm = {{-100, 0, -100}, {100, 0, -100}, {100, 0, 100}, {-100, 0, 100}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

control::FrameResult WallAt(const Vector3d& middle_mm) {
  core::Layout layout;
  core::Part part;
  part.name = "wall";
  part.mesh = Wall();
  layout.parts.push_back(part);
  control::FrameResult result;
  result.layout = std::make_shared<const core::Layout>(std::move(layout));
  result.world_from_parts = {{Eigen::Matrix3d::Identity(), middle_mm}};
  return result;
}

constexpr double kDistanceMm = 800.0;
const Vector3d kEye(0, -kDistanceMm, 0), kPlace(0, 0, 0);

TEST(CutBefore, TakesAwayAPartThatHidesThePlace) {
  const auto cut = control::CutBefore(WallAt({0, -300, 0}), kEye, kPlace);
  ASSERT_TRUE(cut.has_value());
  EXPECT_LT((cut->at_mm - Vector3d(0, -control::kCutBeforeMm, 0)).norm(), 1e-9);
  EXPECT_LT((cut->to_hidden - Vector3d(0, -1, 0)).norm(), 1e-9);  // to the eye
}

TEST(CutBefore, LeavesWhatHidesNothing) {
  EXPECT_FALSE(control::CutBefore(WallAt({0, 200, 0}), kEye, kPlace));     // behind
  EXPECT_FALSE(control::CutBefore(WallAt({150, -300, 0}), kEye, kPlace));  // beside
  EXPECT_FALSE(control::CutBefore(WallAt({0, -900, 0}), kEye, kPlace));    // behind the eye
  EXPECT_FALSE(control::CutBefore(WallAt({0, -10, 0}), kEye, kPlace));     // what is touched
  EXPECT_FALSE(control::CutBefore(WallAt({0, -10, 0}), {0, -20, 0}, kPlace));
}

}  // namespace
}  // namespace elbowroom::tests
