// The table of collision methods, on a few contacts.
#include "tests/accuracy/collision_comparison.h"

#include <gtest/gtest.h>

#include <string>

namespace elbowroom::accuracy {
namespace {

// The longer side of a sample: 0.75 cm x 0.3 cm of the paper's cloth, 0.2 cm x 0.2 cm of tabletop objects.
double PapersStepMm(CollisionPart part) { return part == CollisionPart::kCurtain ? 7.5 : 2.0; }

class TimeCollisionsOf : public testing::TestWithParam<CollisionPart> {};

TEST_P(TimeCollisionsOf, EveryMethodFindsTheHandInThePart) {
  const std::vector<CollisionCost> costs = TimeCollisions(
      recon::ViewSceneRig::kThree, GetParam(), {.repetitions = 1, .slow_repetitions = 1, .slow_ms = 1e9});
  ASSERT_EQ(costs.size(), std::size(kCollisionMethods));
  for (const CollisionCost& cost : costs) EXPECT_GT(cost.contact_points, 20);
  EXPECT_EQ(costs[0].work.triangles, 3 * 720);
  EXPECT_NEAR(costs[0].coarsest_step_mm, PapersStepMm(GetParam()), 1e-9);
  EXPECT_EQ(costs[0].work.pixels, costs[1].work.pixels);
  EXPECT_EQ(costs[0].work.read_backs, 1);
  EXPECT_NEAR(static_cast<double>(costs[0].contact_points), static_cast<double>(costs[1].contact_points),
              0.03 * static_cast<double>(costs[1].contact_points));  // the band of rounding
}

class CountMissedOf : public testing::TestWithParam<CollisionPart> {};

TEST_P(CountMissedOf, OnlyViewportsMissWhatIsSmallerThanTheirSteps) {
  const double step_mm = PapersStepMm(GetParam());
  int contacts = 0, small = 0, missed_small = 0, large = 0;
  for (const SmallContacts& size : CountMissed(recon::ViewSceneRig::kThree, GetParam(), 40, 7602)) {
    contacts += size.contacts;
    if (size.to_mm <= step_mm) {
      small += size.contacts;
      missed_small += size.missed[1];
    }
    // A disc of twice the step holds a sample wherever it lies; a sliver may not, but none is here.
    if (size.from_mm >= 2.0 * step_mm) {
      EXPECT_EQ(size.missed[1], 0);
      large += size.contacts;
    }
    EXPECT_LE(size.missed[2], size.missed[1]);
  }
  EXPECT_GT(contacts, 30);
  EXPECT_GT(large, 0);
  EXPECT_GT(missed_small, small / 10);
}

std::string LabelOf(const testing::TestParamInfo<CollisionPart>& info) {
  return info.param == CollisionPart::kCurtain ? "Curtain" : "TabletopPanel";
}
INSTANTIATE_TEST_SUITE_P(BothParts, TimeCollisionsOf, testing::ValuesIn(kCollisionParts), LabelOf);
INSTANTIATE_TEST_SUITE_P(BothParts, CountMissedOf, testing::ValuesIn(kCollisionParts), LabelOf);

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
