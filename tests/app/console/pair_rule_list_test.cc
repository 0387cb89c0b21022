// The pair rules beside the gaps that move their parts.
#include "app/console/pair_rule_list.h"

#include <gtest/gtest.h>

#include <QLabel>
#include <memory>

#include "app/console/desktop/theme.h"
#include "app/console/spacing_panel.h"
#include "app/control/pairs/ruled_pairs.h"
#include "tests/core/solids.h"

namespace elbowroom::console {
namespace {

core::Part BoxAt(const std::string& name, const Eigen::Vector3d& at_mm) {
  core::Part part;
  part.name = name;
  part.mesh = std::make_shared<const core::TriangleMesh>(core::testing::Box({50.0, 50.0, 50.0}));
  part.world_from_part.translation_mm = at_mm;
  return part;
}

// "shelf" on the gap "height" above "base"; "post" stands 5 mm beside "base".
core::Layout Shelf() {
  core::Layout layout;
  layout.parts = {BoxAt("base", {0, 0, 0}), BoxAt("shelf", {0, 0, 80}), BoxAt("post", {55, 0, 0})};
  layout.spacings = {{"height", "shelf", "base", core::Axis::kZ, 0.0, 300.0, 30.0}};
  layout.pair_rules = {{"base", "shelf", 20.0, false}, {"base", "post", 2.0, false}};
  return layout;
}

class ShownRules : public testing::Test {
 protected:
  void Open(const core::Layout& layout) {
    layout_ = layout;
    judge_ = std::make_unique<control::PairJudge>(layout_, control::RuledPairsOf(layout_));
    panel_.Open(layout_);
  }
  void ShowAt(double judged_mm, double frame_mm) {
    control::FrameResult result;
    result.record.spacing_mm.assign(layout_.spacings.size(), frame_mm);
    result.pairs = judge_->Judge({0, 0.0, std::vector<double>(layout_.spacings.size(), judged_mm)});
    panel_.ShowPairs(result);
  }
  [[nodiscard]] QString Line() const { return panel_.rules().front()->texts().value(0); }
  [[nodiscard]] QLabel* Label() const { return panel_.rules().front()->findChild<QLabel*>("pair_rule:0"); }

  SpacingPanel panel_;
  core::Layout layout_;
  std::unique_ptr<control::PairJudge> judge_;
};

TEST_F(ShownRules, SayGapAndVerdictInWordsAndColour) {
  Open(Shelf());
  EXPECT_EQ(Line(), "pair rules: not judged yet");
  ShowAt(12.5, 12.5);
  EXPECT_EQ(Line(), "✕ base and shelf: 12.5 mm, near; rule of 20 mm broken");
  EXPECT_EQ(Label()->accessibleName(), "Pair rule: " + Line());
  EXPECT_TRUE(Label()->styleSheet().contains(ThemeColors().attention.name()));
  EXPECT_FALSE(Label()->isHidden());
  ShowAt(0.0, 0.0);
  EXPECT_EQ(Line(), "✕ base and shelf: 0.0 mm, contact; rule of 20 mm broken");
  EXPECT_TRUE(Label()->styleSheet().contains(ThemeColors().contact.name()));
  ShowAt(80.0, 80.0);
  EXPECT_EQ(Line(), "✓ base and shelf: ≥ 80.0 mm, clear; rule of 20 mm kept");
  EXPECT_TRUE(Label()->styleSheet().contains(ThemeColors().clear.name()));
}

TEST_F(ShownRules, SayWhenTheVerdictIsOfTheGapBefore) {
  Open(Shelf());
  ShowAt(12.5, 40.0);
  EXPECT_TRUE(Line().endsWith(" (at the gap before; this one is being judged)"));
  EXPECT_TRUE(Label()->styleSheet().contains(ThemeColors().quiet_text.name()));
  ShowAt(40.0, 40.0);
  EXPECT_TRUE(Line().endsWith("rule of 20 mm kept"));
}

TEST_F(ShownRules, OfPartsThatNoSpacingMovesAreShownWhenBroken) {
  core::Layout layout = Shelf();
  Open(layout);
  ShowAt(80.0, 80.0);
  ASSERT_EQ(panel_.rules().size(), 2U);
  EXPECT_TRUE(panel_.rules()[1]->texts().isEmpty());
  EXPECT_TRUE(panel_.rules()[1]->isHidden());
  layout.pair_rules[1].required_clearance_mm = 8.0;
  Open(layout);
  ShowAt(80.0, 80.0);
  EXPECT_EQ(panel_.rules()[1]->texts(), QStringList({"✕ base and post: 5.0 mm, near; rule of 8 mm broken"}));
}

TEST_F(ShownRules, OfManyTheOnesNearestToBeingBrokenAreShown) {
  core::Layout layout = Shelf();
  layout.pair_rules.clear();
  for (int i = 0; i < 6; ++i) {
    layout.parts.push_back(BoxAt("low " + std::to_string(i), {0, 0, -10.0 * i}));
    layout.pair_rules.push_back({"shelf", layout.parts.back().name, 35.0, false});
  }
  Open(layout);
  ShowAt(30.0, 30.0);
  const QStringList texts = panel_.rules()[0]->texts();
  ASSERT_EQ(texts.size(), 4);
  EXPECT_TRUE(texts[0].startsWith("✕ shelf and low 0: 30.0 mm, near"));
  EXPECT_TRUE(texts[1].startsWith("✓ shelf and low 1"));
  EXPECT_TRUE(texts[2].startsWith("✓ shelf and low 2"));
  EXPECT_EQ(texts[3], "and 3 more, 0 of them broken");
}

TEST_F(ShownRules, OfManyBrokenOnesTheOthersAreCounted) {
  core::Layout layout = Shelf();
  layout.pair_rules.clear();
  for (int i = 0; i < 6; ++i) {
    layout.parts.push_back(BoxAt("low " + std::to_string(i), {0, 0, -10.0 * i}));
    layout.pair_rules.push_back({"shelf", layout.parts.back().name, 65.0, false});
  }
  Open(layout);
  ShowAt(30.0, 30.0);
  EXPECT_EQ(panel_.rules()[0]->texts().value(3), "and 3 more, 1 of them broken");
}

TEST_F(ShownRules, ALayoutWithoutRulesShowsNoLine) {
  core::Layout layout = Shelf();
  layout.pair_rules.clear();
  Open(layout);
  control::FrameResult result;
  result.record.spacing_mm = {30.0};
  panel_.ShowPairs(result);
  for (const PairRuleList* list : panel_.rules()) EXPECT_TRUE(list->texts().isEmpty());
}

}  // namespace
}  // namespace elbowroom::console
