// Undo and redo of gaps: as values, and by the panel's controls.
#include <gtest/gtest.h>

#include <QDoubleSpinBox>
#include <QSignalSpy>
#include <QSlider>
#include <QTest>

#include "app/console/gap_history.h"
#include "app/console/spacing_panel.h"

namespace elbowroom::console {
namespace {

constexpr int kLongerThanThePauseMs = 5'000;
using Gaps = GapHistory::Gaps;

// Until a pause has made what was changed a step of its own.
void Pause(GapHistory& history) {
  QSignalSpy settled(&history, &GapHistory::Changed);
  ASSERT_TRUE(settled.wait(kLongerThanThePauseMs));
}

TEST(GapHistory, AChangeUndoneAndRedoneGivesBitEqualGaps) {
  GapHistory history;
  EXPECT_FALSE(history.CanUndo());
  history.Open({140.0, 0.1});
  EXPECT_FALSE(history.CanUndo());
  history.Change(0, 240.0);
  Pause(history);
  history.Change(1, 1.0 / 3.0);
  EXPECT_EQ(history.Undo(), Gaps({240.0, 0.1}));
  EXPECT_EQ(history.Undo(), Gaps({140.0, 0.1}));
  EXPECT_FALSE(history.CanUndo());
  EXPECT_EQ(history.Redo(), Gaps({240.0, 0.1}));
  EXPECT_EQ(history.Redo(), Gaps({240.0, 1.0 / 3.0}));
  EXPECT_FALSE(history.CanRedo());
}

TEST(GapHistory, ASliderOnItsWayIsOneStep) {
  GapHistory history;
  history.Open({140.0, 5.0});
  for (int i = 1; i <= 100; ++i) history.Change(0, 140.0 + i);
  EXPECT_EQ(history.Undo(), Gaps({140.0, 5.0}));
  EXPECT_EQ(history.Redo(), Gaps({240.0, 5.0}));
}

TEST(GapHistory, AnotherGapOrAPauseBeginsAnotherStep) {
  GapHistory history;
  history.Open({140.0, 5.0});
  history.Change(0, 150.0);
  history.Change(1, 6.0);
  history.Change(0, 160.0);
  Pause(history);
  history.Change(0, 170.0);
  EXPECT_EQ(history.Undo(), Gaps({160.0, 6.0}));
  EXPECT_EQ(history.Undo(), Gaps({150.0, 6.0}));
  EXPECT_EQ(history.Undo(), Gaps({150.0, 5.0}));
  EXPECT_EQ(history.Undo(), Gaps({140.0, 5.0}));
}

TEST(GapHistory, AChangeForgetsWhatWasUndone) {
  GapHistory history;
  history.Open({140.0});
  history.Change(0, 150.0);
  (void)history.Undo();
  history.Change(0, 145.0);
  EXPECT_FALSE(history.CanRedo());
  EXPECT_EQ(history.Undo(), Gaps({140.0}));
}

TEST(GapHistory, ThereAndBackIsNoStep) {
  GapHistory history;
  history.Open({140.0});
  history.Change(0, 150.0);
  history.Change(0, 140.0);
  EXPECT_FALSE(history.CanUndo());
}

// Its box rounds to tenths; what comes back does not.
TEST(SpacingPanel, UndoGivesBackTheGapThatWasThereNotTheOneShown) {
  SpacingPanel panel;
  core::Layout layout;
  layout.spacings = {{"gap", "a", "b", core::Axis::kZ, 0.0, 300.0, 140.03}};
  panel.Open(layout);
  std::vector<double> wished_mm;
  QObject::connect(&panel, &SpacingPanel::Requested, &panel,
                   [&](const std::string&, double to_mm) { wished_mm.push_back(to_mm); });
  panel.findChild<QDoubleSpinBox*>()->setValue(240.0);
  panel.Undo();
  EXPECT_EQ(wished_mm, std::vector<double>({240.0, 140.03}));
  EXPECT_EQ(panel.findChild<QDoubleSpinBox*>()->value(), 140.0);
  panel.Undo();  // nothing more
  panel.Redo();
  EXPECT_EQ(wished_mm, std::vector<double>({240.0, 140.03, 240.0}));
  EXPECT_EQ(panel.findChild<QSlider*>()->value(), 2400);
}

TEST(SpacingPanel, WhileItIsDisabledNothingIsUndone) {
  SpacingPanel panel;
  core::Layout layout;
  layout.spacings = {{"gap", "a", "b", core::Axis::kZ, 0.0, 300.0, 140.0}};
  panel.Open(layout);
  panel.findChild<QDoubleSpinBox*>()->setValue(240.0);
  panel.setEnabled(false);
  panel.Undo();
  EXPECT_EQ(panel.findChild<QDoubleSpinBox*>()->value(), 240.0);
}

}  // namespace
}  // namespace elbowroom::console
