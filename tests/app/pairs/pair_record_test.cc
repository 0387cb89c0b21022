#include "app/control/pairs/pair_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <variant>

#include "app/control/pairs/ruled_pairs.h"
#include "tests/app/pairs/ruled_layouts.h"

namespace elbowroom::control {
namespace {

class PairRecordTest : public ::testing::Test {
 protected:
  std::vector<std::string> Add(core::FrameIndex frame, double gap_mm) {
    std::vector<std::string> texts;
    for (const core::SessionEvent& event :
         record_.Add(*judge_.Judge({frame, 0.1 * static_cast<double>(frame), {gap_mm}}))) {
      EXPECT_EQ(event.frame, frame);
      EXPECT_TRUE(IsPairNote(event));
      texts.push_back(std::get<core::Note>(event.what).text);
    }
    return texts;
  }

  core::Layout layout_ = testing::ThreeBoxes();
  PairJudge judge_{layout_, RuledPairsOf(layout_)};
  PairRecord record_{layout_};
};

using Texts = std::vector<std::string>;

TEST_F(PairRecordTest, TellsOnceThatARuleIsBrokenAndOnceThatItIsKeptAgain) {
  EXPECT_EQ(Add(0, 30.0), Texts());
  EXPECT_EQ(Add(10, 12.5),
            Texts({"pair rule broken: 'lower' and 'upper' near, 12.50 mm apart, 20 mm required"}));
  EXPECT_EQ(Add(15, 7.0), Texts()) << "it is broken still";
  EXPECT_EQ(Add(20, 0.0),
            Texts({"pair rule broken: 'lower' and 'upper' contact, 0.00 mm apart, 20 mm required"}));
  const Texts kept = Add(40, 100.0);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0],
            "pair rule kept again: 'lower' and 'upper' clear, at least 100.00 mm apart, 20 mm required");
  EXPECT_EQ(Add(50, 120.0), Texts());

  const std::vector<PairTotal> totals = record_.Totals(9.0);
  ASSERT_EQ(totals.size(), 2U);
  EXPECT_TRUE(totals[0].was_broken);
  EXPECT_NEAR(totals[0].broken_s, 3.0, 1e-9);
  EXPECT_EQ(totals[0].closest.verdict, core::Verdict::kContact);
  EXPECT_NEAR(totals[0].closest_time_s, 2.0, 1e-9);
  EXPECT_FALSE(totals[1].was_broken);
  EXPECT_EQ(totals[1].broken_s, 0.0);
}

TEST_F(PairRecordTest, ARuleThatIsBrokenFromTheStartIsToldWithTheFirstFrame) {
  EXPECT_EQ(Add(7, 19.999),
            Texts({"pair rule broken: 'lower' and 'upper' near, 19.99 mm apart, 20 mm required"}));
  EXPECT_NEAR(record_.Totals(1.7)[0].broken_s, 1.0, 1e-9);
}

TEST_F(PairRecordTest, ContactThatIsAllowedBreaksNoRule) {
  layout_.pair_rules[0].authorised_contact = true;
  judge_ = PairJudge(layout_, RuledPairsOf(layout_));
  EXPECT_EQ(Add(0, 0.0), Texts());
  EXPECT_EQ(Add(1, 3.0).size(), 1U) << "near isn't contact";
}

TEST_F(PairRecordTest, OfVeryManyRulesTheOthersAreCounted) {
  PairVerdicts verdicts = *judge_.Judge({0, 0.0, {5.0}});
  verdicts.pairs.assign(PairRecord::kMostNotes + 12, verdicts.pairs.front());
  const std::vector<core::SessionEvent> notes = record_.Add(verdicts);
  ASSERT_EQ(notes.size(), PairRecord::kMostNotes + 1);
  EXPECT_EQ(std::get<core::Note>(notes.back().what).text, "more pair rules broken or kept again: 12");
  EXPECT_TRUE(IsPairNote(notes.back()));
}

TEST_F(PairRecordTest, OtherNotesAreNotTakenForIt) {
  EXPECT_FALSE(IsPairNote({0, 0.0, core::Note{"the pair rule was broken"}}));
  EXPECT_FALSE(IsPairNote({0, 0.0, core::ToolMarked{"pair rule broken: ", true}}));
}

}  // namespace
}  // namespace elbowroom::control
