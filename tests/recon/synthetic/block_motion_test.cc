// The block-design task's motion is smooth, carries blocks in the hand, and makes the pattern.
#include "recon/synthetic/block_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> BlockPlaces(const std::vector<SyntheticObject>& objects) {
  std::vector<Vector3d> places;
  for (const SyntheticObject& object : objects)
    if (object.name == "block") places.push_back(object.solids.front().world_from_solid.translation_mm);
  return places;
}

TEST(BlockMotion, NothingJumps) {
  constexpr int kSteps = 20'000;
  constexpr double kFarthestMm = 3.0;  // of 9 blocks in 20,000 steps; a jump is some 90 mm
  for (const int side : {2, 3}) {
    std::vector<SyntheticObject> before = BlocksAt({}, side, 0.0);
    for (int step = 1; step <= kSteps; ++step) {
      const auto after = BlocksAt({}, side, static_cast<double>(step) / kSteps);
      for (std::size_t i = 0; i < before.size(); ++i)
        for (std::size_t k = 0; k < before[i].solids.size(); ++k)
          ASSERT_LE((BoundingSphereOf(after[i].solids[k]).center_in_world -
                     BoundingSphereOf(before[i].solids[k]).center_in_world)
                        .norm(),
                    kFarthestMm)
              << before[i].name << " at " << step;
      before = after;
    }
  }
}

TEST(BlockMotion, EndsInTheSquareOfThePattern) {
  for (const int side : {2, 3}) {
    SCOPED_TRACE(side);
    const auto places = BlockPlaces(BlocksAt({}, side, PatternDoneAt(side)));
    ASSERT_EQ(places.size(), static_cast<std::size_t>(side * side));
    const double half_mm = 0.5 * (side - 1) * kBlockMm;
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_LE(std::abs(places[i].x()), half_mm + 1e-9);
      EXPECT_LE(std::abs(places[i].y()), half_mm + 1e-9);
      EXPECT_NEAR(places[i].z(), 0.5 * kBlockMm, 1e-9) << "on the table";
      for (std::size_t k = 0; k < i; ++k) EXPECT_GE((places[i] - places[k]).norm(), kBlockMm - 1e-9);
    }
    const auto just_before = BlockPlaces(BlocksAt({}, side, PatternDoneAt(side) - 0.01));
    EXPECT_GT((just_before.back() - places.back()).norm(), 1.0) << "not done before";
  }
}

TEST(BlockMotion, TheHandIsAtTheBlockThatIsCarried) {
  constexpr double kGripGapMm = 15.0;  // rigid capsules stand for fingers that give way
  int carried = 0;
  for (double share = 0.0; share <= 1.0; share += 0.005) {
    const auto objects = BlocksAt({}, 3, share);
    for (const SyntheticObject& block : objects) {
      if (block.name != "block" || block.solids.front().world_from_solid.translation_mm.z() < kBlockMm)
        continue;
      ++carried;
      double nearest_mm = std::numeric_limits<double>::infinity();
      for (const Solid& bone : objects.front().solids) {
        const auto& capsule = std::get<Capsule>(bone.shape);
        for (double along = 0.0; along <= 1.0; along += 0.1)
          nearest_mm = std::min(
              nearest_mm,
              SignedDistanceMm(block.solids.front(),
                               bone.world_from_solid * Vector3d(0.0, 0.0, along * capsule.length_mm)) -
                  capsule.radius_mm);
      }
      EXPECT_LT(nearest_mm, kGripGapMm) << share;
    }
  }
  EXPECT_GT(carried, 20);
}

TEST(BlockMotion, RefusesWhatIsNoPattern) {
  EXPECT_THROW((void)BlocksAt({}, 4, 0.5), core::PreconditionError);
  EXPECT_THROW((void)BlocksAt({}, 2, 1.5), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
