// The widgets of a procedure one by one, without a trial.
#include <gtest/gtest.h>

#include <QApplication>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTest>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/console/procedure/contact_sound.h"
#include "app/console/procedure/gap_presets.h"
#include "app/console/procedure/preset_panel.h"
#include "app/console/procedure/procedure_panel.h"
#include "app/console/procedure/question_form.h"

namespace elbowroom::console {
namespace {

using core::AskedWhen;

TEST(ProcedurePanel, GoesThroughTheStepsAndPastTheLastToNone) {
  ProcedurePanel panel;
  panel.Open({"reach", "screw"}, true);
  std::vector<std::string> asked;
  QObject::connect(&panel, &ProcedurePanel::StepAsked, &panel,
                   [&](const std::string& step) { asked.push_back(step); });
  panel.Next();
  panel.Next();
  panel.Next();  // again from the first
  EXPECT_EQ(asked, (std::vector<std::string>{"screw", "", "reach"}));
  auto* list = panel.findChild<QListWidget*>("step_list");
  emit list->itemActivated(list->item(1));
  EXPECT_EQ(asked.back(), "screw");
  EXPECT_TRUE(list->item(1)->font().bold());
  panel.setEnabled(false);
  panel.Next();
  panel.SetBookmark();
  EXPECT_EQ(asked.size(), 4U);
}

// A list that took the focus would take digits and Space, which are the trial's.
TEST(ProcedurePanel, AClickInAListLeavesTheKeysToTheTrial) {
  QWidget window;
  auto* panel = new ProcedurePanel;
  auto* presets = new PresetPanel(&window);
  auto* column = new QVBoxLayout(&window);
  column->addWidget(panel);
  column->addWidget(presets);
  auto* elsewhere = new QLineEdit;
  column->addWidget(elsewhere);
  panel->Open({"reach", "screw"}, true);
  std::vector<std::string> asked;
  QObject::connect(panel, &ProcedurePanel::StepAsked, panel,
                   [&](const std::string& step) { asked.push_back(step); });
  window.show();
  window.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window));
  elsewhere->setFocus();
  auto* steps = panel->findChild<QListWidget*>("step_list");
  const QPoint second = steps->visualItemRect(steps->item(1)).center();
  QTest::mouseClick(steps->viewport(), Qt::LeftButton, {}, second);
  QTest::mouseDClick(steps->viewport(), Qt::LeftButton, {}, second);
  EXPECT_EQ(asked, std::vector<std::string>{"screw"});
  EXPECT_EQ(QApplication::focusWidget(), elsewhere);
  for (const char* name : {"preset_list", "gap_history"}) {
    auto* list = presets->findChild<QListWidget*>(name);
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, {5, 5});
    EXPECT_EQ(QApplication::focusWidget(), elsewhere) << name;
  }
}

TEST(ProcedurePanel, ShowsTheTimesOfTrialAndStep) {
  ProcedurePanel panel;
  panel.Open({"reach"}, true);
  panel.ShowTime(65.9, core::StepRun{"reach", 30, 1.0});
  EXPECT_EQ(panel.findChild<QLabel*>("trial_time")->text(), "Trial 1:05");
  EXPECT_EQ(panel.findChild<QLabel*>("step_time")->text(), "Step 1:04");
  panel.ShowTime(66.0, std::nullopt);
  EXPECT_EQ(panel.findChild<QLabel*>("step_time")->text(), "");
}

TEST(QuestionForm, SaysOnlyWhatWasAnswered) {
  core::TrialInfo trial;
  trial.survey = {{AskedWhen::kAfter, "sure", -3, 3},
                  {AskedWhen::kBefore, "sure", 1, 7},
                  {AskedWhen::kAfter, "effort", 0, 100},
                  {AskedWhen::kAfter, "left out", 1, 7}};
  QuestionForm form(AskedWhen::kAfter);
  form.Open(trial, std::nullopt);
  EXPECT_TRUE(form.Said().empty());
  form.findChild<QToolButton*>("answer:after:0:-2")->click();
  form.findChild<QSpinBox*>("answer:after:1")->setValue(0);
  EXPECT_EQ(form.Said(),
            (std::vector<core::EventContent>{core::SurveyAnswered{AskedWhen::kAfter, "sure", -2},
                                             core::SurveyAnswered{AskedWhen::kAfter, "effort", 0}}));
  form.Open(trial, 140.0);
  EXPECT_EQ(form.Said(), (std::vector<core::EventContent>{core::EstimateGiven{AskedWhen::kAfter, 140.0}}));
}

TEST(QuestionForm, AnswersQuestionnairesAsTheirItemsAsk) {
  core::QuestionnaireItem there{"there", "Were you there?"}, long_scale{"effort", "Effort"},
      sick{"sick", "Nausea", core::ItemKind::kChoice, 0.0, 2.0},
      age{"age", "Age", core::ItemKind::kNumber, 0.0, 120.0}, left_out{"left_out", "Not answered"},
      words{"words", "In the way?", core::ItemKind::kText, 0.0, 0.0};
  there.least_anchor = "not at all";
  there.most_anchor = "very much";
  long_scale.least = 0.0;
  long_scale.most = 100.0;
  sick.choices = {"none", "slight", "severe"};
  sick.values = {0.0, 1.0, 2.0};
  core::TrialInfo trial;
  trial.questionnaires = {{AskedWhen::kAfter, "Q", {there, long_scale, sick, age, left_out, words}},
                          {AskedWhen::kBefore, "R", {there}}};
  QuestionForm form(AskedWhen::kAfter);
  form.Open(trial, std::nullopt);
  EXPECT_TRUE(form.Said().empty());
  EXPECT_EQ(form.findChild<QToolButton*>("questionnaire:before:R:there:6"), nullptr);
  form.findChild<QToolButton*>("questionnaire:after:Q:there:6")->click();
  form.findChild<QSpinBox*>("questionnaire:after:Q:effort")->setValue(0);
  form.findChild<QComboBox*>("questionnaire:after:Q:sick")->setCurrentText("slight");
  form.findChild<QDoubleSpinBox*>("questionnaire:after:Q:age")->setValue(31.5);
  form.findChild<QPlainTextEdit*>("questionnaire:after:Q:words")->setPlainText("  the lid\n");
  const auto said = [](const char* item, core::ItemAnswer answer) {
    return core::EventContent(core::QuestionnaireAnswered{AskedWhen::kAfter, "Q", item, std::move(answer)});
  };
  EXPECT_EQ(form.Said(), (std::vector{said("there", 6.0), said("effort", 0.0), said("sick", "slight"),
                                      said("age", 31.5), said("words", "the lid")}));
  EXPECT_EQ(form.findChild<QDoubleSpinBox*>("questionnaire:after:Q:age")->text(), "31.5") << "without zeros";
}

core::Layout LayoutOf(const std::string& gap) {
  core::Layout layout;
  layout.spacings = {{gap, "a", "b", core::Axis::kZ, 0.0, 300.0, 140.0}};
  return layout;
}

TEST(GapPresets, AreKeptForTheirSpacingsBitForBit) {
  const std::vector<GapPreset> presets = {{"closed", {1.0 / 3.0}}, {"a, \"b\"; c", {-7.25}}};
  KeepPresets({"gap/1"}, presets);
  EXPECT_EQ(PresetsFor({"gap/1"}), presets);
  EXPECT_TRUE(PresetsFor({"gap/2"}).empty());
  KeepPresets({"gap/1"}, {});
  EXPECT_TRUE(PresetsFor({"gap/1"}).empty());
}

TEST(PresetPanel, SavesAppliesAndListsGaps) {
  QWidget window;
  PresetPanel panel(&window);
  panel.Open(LayoutOf("panel gap"));
  std::vector<std::vector<double>> asked;
  QObject::connect(&panel, &PresetPanel::GapsAsked, &panel,
                   [&](const std::vector<double>& gap_mm) { asked.push_back(gap_mm); });
  panel.ShowGaps(1.0, {150.0});
  panel.ShowGaps(1.1, {160.0});  // the same move
  panel.ShowGaps(5.0, {160.0});
  panel.ShowGaps(9.0, {170.0});
  auto* history = panel.findChild<QListWidget*>("gap_history");
  ASSERT_EQ(history->count(), 2);
  EXPECT_EQ(history->item(0)->text(), "1.1 s  panel gap: 140.0 to 160.0 mm");
  panel.findChild<QLineEdit*>("preset_name")->setText("open");
  panel.findChild<QPushButton*>("save_preset")->click();
  panel.Apply(0);
  panel.Apply(1);  // there is none
  emit history->itemActivated(history->item(0));
  EXPECT_EQ(asked, (std::vector<std::vector<double>>{{170.0}, {160.0}}));
  panel.Open(LayoutOf("panel gap"));
  auto* list = panel.findChild<QListWidget*>("preset_list");
  ASSERT_EQ(list->count(), 1);
  list->setCurrentRow(0);
  panel.findChild<QPushButton*>("remove_preset")->click();
  EXPECT_EQ(list->count(), 0);
}

core::PartContact In(core::Verdict verdict) {
  core::PartContact contact;
  contact.verdict = verdict;
  return contact;
}

TEST(ContactSound, SoundsWhenAPartIsTouchedThatWasNot) {
  ContactSound sound;
  EXPECT_FALSE(sound.is_on());
  QSignalSpy sounded(&sound, &ContactSound::Sounded);
  const auto touched = core::Verdict::kContact, clear = core::Verdict::kClear;
  sound.ShowFrame({In(touched), In(clear)});
  EXPECT_EQ(sounded.size(), 0) << "it is off";
  sound.SetOn(true);
  EXPECT_EQ(sounded.size(), 1) << "so that it is known";
  sounded.clear();
  sound.Open();
  sound.ShowFrame({In(touched), In(clear)});
  sound.ShowFrame({In(touched), In(clear)});
  EXPECT_EQ(sounded.size(), 1);
  sound.ShowFrame({In(touched), In(touched)});
  sound.ShowFrame({In(clear), In(touched)});
  EXPECT_EQ(sounded.size(), 2);
  EXPECT_TRUE(ContactSound().is_on()) << "it is remembered";
  sound.SetOn(false);
}

}  // namespace
}  // namespace elbowroom::console
