// The table of collision methods, on a few contacts.
#include "tests/accuracy/collision_comparison.h"

#include <gtest/gtest.h>

namespace elbowroom::accuracy {
namespace {

TEST(TimeCollisions, EveryMethodFindsTheHandInTheCurtain) {
  const std::vector<CollisionCost> costs =
      TimeCollisions(recon::ViewSceneRig::kThree, {.repetitions = 1, .slow_repetitions = 1, .slow_ms = 1e9});
  ASSERT_EQ(costs.size(), std::size(kCollisionMethods));
  for (const CollisionCost& cost : costs) EXPECT_GT(cost.contact_points, 20);
  EXPECT_EQ(costs[0].work.triangles, 3 * 720);
  EXPECT_EQ(costs[0].work.pixels, costs[1].work.pixels);
  EXPECT_EQ(costs[0].work.read_backs, 1);
  EXPECT_NEAR(static_cast<double>(costs[0].contact_points), static_cast<double>(costs[1].contact_points),
              0.03 * static_cast<double>(costs[1].contact_points));  // the band of rounding
}

TEST(CountMissed, OnlyViewportsMissWhatIsSmallerThanTheirSteps) {
  int contacts = 0, small = 0, missed_small = 0;
  for (const SmallContacts& size : CountMissed(recon::ViewSceneRig::kThree, 40, 7602)) {
    contacts += size.contacts;
    if (size.to_mm <= 2.0) {
      small += size.contacts;
      missed_small += size.missed[1];
    }
    // A disc of 4 mm, twice the step, holds a sample wherever it lies; a sliver may not, but none is here.
    if (size.from_mm >= 5.0) {
      EXPECT_EQ(size.missed[1], 0);
    }
    EXPECT_LE(size.missed[2], size.missed[1]);
  }
  EXPECT_GT(contacts, 30);
  EXPECT_GT(missed_small, small / 10);
}

TEST(MeasureResponses, TheExactOnesAreBetter) {
  constexpr double kStepMm = 0.125, kLabelMm = 0.15;  // 0.06 px, obliquely
  constexpr double kExactMm = 0.02;                   // the step of the oracle that it is held to
  constexpr double kExactDeg = 1.0;
  const std::vector<ResponseErrors> all = MeasureResponses(recon::ViewSceneRig::kThree, 4, 40, 7603);
  ASSERT_GT(all.front().responses, 60);
  EXPECT_LT(all.front().two_triangles.cp_hull_to_masks_mm.p95, kStepMm + kLabelMm);
  EXPECT_LT(all.front().exact.cp_hull_to_masks_mm.p95, kExactMm);
  EXPECT_LT(all.front().exact.n_hull_deg.median, kExactDeg);
  EXPECT_GT(all[1].two_triangles.n_hull_deg.median, 2.0 * all[1].exact.n_hull_deg.median);
  // The chords that its normal comes from are as short as the contact is shallow.
  EXPECT_GT(all[1].two_triangles.n_hull_deg.median, all[4].two_triangles.n_hull_deg.median);
}

}  // namespace
}  // namespace elbowroom::accuracy
