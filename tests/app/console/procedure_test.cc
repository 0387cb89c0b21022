// A whole trial with a procedure in the window, by mouse and keys; what the session has of it; its replay.
#include <gtest/gtest.h>

#include <QAction>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTest>
#include <QToolButton>
#include <variant>

#include "app/control/replay/replay.h"
#include "core/procedure/answers.h"
#include "core/procedure/event_text.h"
#include "core/procedure/scores.h"
#include "core/procedure/step_runs.h"
#include "sessions/session_reader.h"
#include "tests/app/console/procedure_trial.h"
#include "tests/app/console/window_fixture.h"

namespace elbowroom::console {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNotes = "The cable was in the way";

class ProcedureTest : public WindowFixture {
 protected:
  ProcedureTest() { WriteProcedureTrial(folder_.path()); }

  void Key(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
    window_.setFocus();
    QTest::keyClick(&window_, key, modifiers);
    AwaitFrames(3);
  }
  [[nodiscard]] bool StepIs(const std::string& step) {
    return last_frame_ && (last_frame_->step ? last_frame_->step->step : std::string()) == step;
  }
  [[nodiscard]] double GapMm() { return last_frame_->record.spacing_mm.at(0); }
};

TEST_F(ProcedureTest, AWholeTrialIsInTheSessionAndItsReplay) {
  ASSERT_NO_FATAL_FAILURE(Activate());
  window_.StartTrial(QString::fromStdString((folder_ / "trial.toml").string()));
  auto* estimate = Find<QDoubleSpinBox>("estimate:before");
  EXPECT_TRUE(estimate->isVisible());
  EXPECT_TRUE(estimate->hasFocus()) << "the estimate is asked first";
  EXPECT_TRUE(IsIdle()) << "nothing runs before it is begun";
  QTest::keyClicks(estimate, "140");
  Find<QLineEdit>("participant")->setText("P08");
  QTest::mouseClick(Find<QToolButton>("answer:before:0:6"), Qt::LeftButton);
  QTest::keyClick(estimate, Qt::Key_Return);
  ASSERT_TRUE(WaitUntil([&] { return StepIs("reach in"); })) << Message();
  EXPECT_FALSE(Find<QWidget>("start_page")->isVisible());
  EXPECT_TRUE(Find<QWidget>("step_list")->isVisible());

  Key(Qt::Key_1);
  Find<QDoubleSpinBox>("spacing_box:gap")->setValue(130.0);
  ASSERT_TRUE(WaitUntil([&] { return GapMm() == 130.0; }));
  Find<QLineEdit>("preset_name")->setText("closed");
  Find<QPushButton>("save_preset")->click();
  Find<QDoubleSpinBox>("spacing_box:gap")->setValue(200.0);
  ASSERT_TRUE(WaitUntil([&] { return GapMm() == 200.0; }));
  Key(Qt::Key_F1, Qt::ControlModifier);
  ASSERT_TRUE(WaitUntil([&] { return GapMm() == 130.0; }));
  EXPECT_GE(Find<QListWidget>("gap_history")->count(), 1);
  Key(Qt::Key_M);
  Find<QLineEdit>("bookmark_name")->setFocus();
  QTest::keyClicks(Find<QLineEdit>("bookmark_name"), "tongs slipped");
  QTest::keyClick(Find<QLineEdit>("bookmark_name"), Qt::Key_Return);
  Key(Qt::Key_N);
  ASSERT_TRUE(WaitUntil([&] { return StepIs(kSecondStep); }));
  Key(Qt::Key_Space);
  ASSERT_TRUE(WaitUntil([&] { return StepIs(""); }));
  Find<QAction>("stop")->trigger();
  ASSERT_TRUE(WaitUntil([&] { return IsIdle(); }));

  auto* after = Find<QDoubleSpinBox>("estimate:after");
  EXPECT_TRUE(after->isVisible());
  after->setValue(165.0);
  QTest::mouseClick(Find<QToolButton>("answer:after:0:3"), Qt::LeftButton);
  Find<QSpinBox>("answer:after:1")->setValue(55);
  Find<QToolButton>("questionnaire:after:Feelings:there:6")->click();
  Find<QToolButton>("questionnaire:after:Feelings:lab:2")->click();
  Find<QComboBox>("questionnaire:after:Feelings:sick")->setCurrentText("slight");
  Find<QPlainTextEdit>("after_notes")->setPlainText(kNotes);
  QTest::mouseClick(Find<QPushButton>("save_answers"), Qt::LeftButton);
  ASSERT_TRUE(WaitUntil([&] { return Message().find("What was said is in") == 0; })) << Message();
  EXPECT_FALSE(Find<QWidget>("after_page")->isVisible());

  const sessions::SessionReader session(session_);
  const core::TrialInfo& trial = session.header().trial;
  EXPECT_EQ(std::tie(trial.participant, trial.condition, trial.order, trial.estimate_mm),
            std::make_tuple("P08", "gloves", 2, 140.0));
  const std::vector<core::SessionEvent> events = session.events();
  std::vector<std::string> happened;
  for (const core::SessionEvent& event : events) {
    const auto* note = std::get_if<core::Note>(&event.what);
    if (note == nullptr || note->text == kNotes) happened.push_back(core::EventText(event.what));
  }
  const std::string second = kSecondStep;
  EXPECT_EQ(happened,
            (std::vector<std::string>{
                "estimate before the trial: 140 mm", "before the trial, 'How sure are you?': 6",
                "step 'reach in' begun", "tongs taken in use", "gap from 170 to 130 mm",
                "gap from 130 to 200 mm", "gap from 200 to 130 mm", "bookmark", "bookmark: tongs slipped",
                "step 'reach in' ended", "step '" + second + "' begun", "step '" + second + "' ended",
                "estimate after the trial: 165 mm", "after the trial, 'How sure are you?': 3",
                "after the trial, 'Effort': 55", "after the trial, Feelings, 'there': 6",
                "after the trial, Feelings, 'lab': 2", "after the trial, Feelings, 'sick': slight", kNotes}));
  EXPECT_EQ(trial.block, "timed");
  ASSERT_EQ(trial.questionnaires.size(), 1U);
  const core::Questionnaire& feelings = trial.questionnaires[0];
  EXPECT_EQ(core::ScoreOf(feelings, feelings.scores[0], core::AnswersOf(feelings, events)), 6.0);
  EXPECT_EQ(events.front().frame, 0);
  const std::vector<core::StepRun> runs = core::StepRunsOf(events);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].end_frame, runs[1].begin_frame);
  EXPECT_GT(*runs[0].duration_s(), 0.0);

  const control::ReplayOutcome replay = control::RunReplay(session, {folder_ / "again.db", {}, {}}, {}, {});
  ASSERT_TRUE(replay.compared);
  EXPECT_EQ(replay.compared->frames_that_differ, 0);
  const sessions::SessionReader again(folder_ / "again.db");
  EXPECT_EQ(again.events(), events);
  EXPECT_EQ(again.header().trial.survey, trial.survey);
  EXPECT_EQ(again.header().trial.questionnaires, trial.questionnaires);
  EXPECT_EQ(again.header().trial.block, trial.block);
}

TEST_F(ProcedureTest, WhatIsAskedCanBeSkippedWithOneKeyEach) {
  ASSERT_NO_FATAL_FAILURE(Activate());
  window_.StartTrial(QString::fromStdString((folder_ / "trial.toml").string()));
  QTest::keyClick(Find<QDoubleSpinBox>("estimate:before"), Qt::Key_Return);
  ASSERT_TRUE(WaitUntil([&] { return last_frame_ != nullptr; })) << Message();
  Find<QAction>("stop")->trigger();
  ASSERT_TRUE(WaitUntil([&] { return IsIdle(); }));
  EXPECT_TRUE(Find<QWidget>("after_page")->isVisible());
  QTest::keyClick(Find<QDoubleSpinBox>("estimate:after"), Qt::Key_Escape);
  EXPECT_FALSE(Find<QWidget>("after_page")->isVisible());
  const sessions::SessionReader session(session_);
  EXPECT_EQ(session.status(), sessions::SessionStatus::kComplete);
  EXPECT_EQ(session.header().trial.participant, "P07");
  EXPECT_FALSE(core::EstimatesOf(session.header().trial, session.events()).before_mm);
}

TEST_F(ProcedureTest, LeavingTheStartPageStartsNothing) {
  window_.StartTrial(QString::fromStdString((folder_ / "trial.toml").string()));
  QTest::mouseClick(Find<QPushButton>("leave_trial"), Qt::LeftButton);
  EXPECT_FALSE(Find<QWidget>("start_page")->isVisible());
  EXPECT_TRUE(IsIdle());
  EXPECT_FALSE(fs::exists(session_));
}

}  // namespace
}  // namespace elbowroom::console
