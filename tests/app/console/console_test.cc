// The console plays the demo as an experimenter would: through its widgets, on Qt's offscreen platform.
#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QRegularExpression>
#include <QSignalSpy>
#include <QSlider>
#include <QStatusBar>
#include <QTableView>
#include <QTest>
#include <QWheelEvent>
#include <algorithm>
#include <variant>

#include "app/console/window_picture.h"
#include "app/control/demo_parts.h"
#include "app/control/demo_trial.h"
#include "recon/synthetic/demo_motion.h"
#include "sessions/session_reader.h"
#include "tests/app/console/opened_urls.h"
#include "tests/app/console/stall_watch.h"
#include "tests/app/console/user_actions.h"
#include "tests/app/console/window_fixture.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

constexpr double kGuessedGapMm = 140.0;
constexpr double kNeededGapMm = 240.0;

// A window that doesn't answer for a fifth of a second is felt to hang.
constexpr double kLongestStallMs = 200.0;

class ConsoleTest : public WindowFixture {
 protected:
  ConsoleTest() : WindowFixture("trial.db", QSize(1280, 800)) {}

  [[nodiscard]] QStringList ListedParts() {
    const QAbstractItemModel& model = *Find<QTableView>("contact_list")->model();
    QStringList parts;
    for (int row = 0; row < model.rowCount(); ++row) {
      parts << model.data(model.index(row, ContactModel::kPart)).toString();
    }
    return parts;
  }
  [[nodiscard]] bool GapIs(double gap_mm) {
    return last_frame_ && last_frame_->record.spacing_mm.at(0) == gap_mm;
  }

  void StartDemoAndWaitForFrames() {
    Action("start_demo").trigger();
    ASSERT_TRUE(WaitUntil([&] { return last_frame_ != nullptr; })) << Message();
  }
};

TEST_F(ConsoleTest, ContactsVanishFromTheListAsTheGapIsOpenedLive) {
  const OpenedUrls opened;
  EXPECT_FALSE(Action("report").isEnabled());
  StartDemoAndWaitForFrames();
  const StallWatch stalls;
  ASSERT_TRUE(WaitUntil([&] { return ListedParts().contains("payload_a"); }));
  EXPECT_TRUE(GapIs(kGuessedGapMm));
  EXPECT_FALSE(Action("report").isEnabled());

  Find<QSlider>("spacing_slider:payload_a_gap")->setValue(static_cast<int>(10.0 * kNeededGapMm));
  EXPECT_EQ(Find<QDoubleSpinBox>("spacing_box:payload_a_gap")->value(), kNeededGapMm);
  ASSERT_TRUE(WaitUntil([&] { return GapIs(kNeededGapMm); }));
  EXPECT_EQ(ListedParts(), QStringList());

  // A whole task at the opened gap, every frame that the window was told of.
  const double task_ends_s = last_frame_->record.time_s + recon::kTaskSeconds;
  std::vector<std::string> listed_again;
  const QMetaObject::Connection watch =
      QObject::connect(&window_.desk(), &TrialDesk::FrameArrived, &window_, [&](const FrameNews& news) {
        for (const QString& part : ListedParts()) {
          listed_again.push_back(part.toStdString() + " at frame " +
                                 std::to_string(news.result->record.frame));
        }
      });
  const int frames_before = frames_;
  ASSERT_TRUE(WaitUntil([&] { return last_frame_->record.time_s >= task_ends_s; }));
  QObject::disconnect(watch);
  EXPECT_EQ(listed_again, std::vector<std::string>());
  constexpr int kFewestFrames = 40;  // of 240: enough to have seen every phase of the task
  EXPECT_GT(frames_ - frames_before, kFewestFrames);
  RecordProperty("longest_stall_ms", std::to_string(stalls.longest_ms()));
  EXPECT_GT(stalls.ticks(), 0);
  EXPECT_LT(stalls.longest_ms(), kLongestStallMs);

  StopAndWait();
  const sessions::SessionReader session(session_);
  EXPECT_EQ(session.status(), sessions::SessionStatus::kComplete);
  std::vector<core::FrameIndex> changes;
  for (const core::SessionEvent& event : session.events()) {
    const auto* change = std::get_if<core::SpacingChanged>(&event.what);
    if (change == nullptr) continue;
    EXPECT_EQ(change->spacing, control::kDemoGap);
    EXPECT_EQ(change->from_mm, kGuessedGapMm);
    EXPECT_EQ(change->to_mm, kNeededGapMm);
    changes.push_back(event.frame);
  }
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_GT(session.contacts().size(), 0U);
  for (const sessions::ContactRow& row : session.contacts()) EXPECT_LT(row.frame, changes.front());

  ASSERT_TRUE(Action("report").isEnabled());
  Action("report").trigger();
  EXPECT_FALSE(Action("start_demo").isEnabled());
  ASSERT_TRUE(WaitUntil([&] { return IsIdle(); }));
  const std::filesystem::path html = folder_ / "trial-report" / "report.html";
  EXPECT_NE(test_support::ReadText(html).find("payload_a"), std::string::npos) << Message();
  ASSERT_EQ(opened.urls().size(), 1U);
  EXPECT_EQ(opened.urls().front().toLocalFile().toStdString(), html.string());
}

TEST_F(ConsoleTest, KeysAndCheckBoxesReachTheRunningTrial) {
  const QRegularExpression gaps("^spacing_slider:");
  EXPECT_TRUE(window_.findChildren<QSlider*>(gaps).isEmpty());  // no layout yet, nothing to set
  StartDemoAndWaitForFrames();
  QTest::keyClick(&window_, Qt::Key_Plus);
  QTest::keyClick(&window_, Qt::Key_Plus);
  QTest::keyClick(&window_, Qt::Key_Minus);
  QTest::keyClick(&window_, Qt::Key_Underscore, Qt::ShiftModifier);
  ASSERT_TRUE(WaitUntil([&] { return GapIs(kGuessedGapMm + 9.0); }));
  EXPECT_EQ(Find<QDoubleSpinBox>("spacing_box:payload_a_gap")->value(), kGuessedGapMm + 9.0);

  auto* gap = Find<QDoubleSpinBox>("spacing_box:payload_a_gap");
  for (int step = 0; step < 50; ++step) QTest::keyClick(&window_, Qt::Key_Plus);
  EXPECT_EQ(gap->value(), gap->maximum());
  ASSERT_TRUE(WaitUntil([&] { return GapIs(gap->maximum()); }));

  Find<QCheckBox>("tool:tongs")->click();
  AwaitFrames(3);
  StopAndWait();
  EXPECT_FALSE(gap->isEnabled());
  const std::vector<core::SessionEvent> events = sessions::SessionReader(session_).events();
  const auto marked = std::find_if(events.begin(), events.end(), [](const core::SessionEvent& event) {
    return std::holds_alternative<core::ToolMarked>(event.what);
  });
  ASSERT_NE(marked, events.end());
  EXPECT_EQ(std::get<core::ToolMarked>(marked->what).tool, "tongs");
  EXPECT_TRUE(std::get<core::ToolMarked>(marked->what).in_use);
}

TEST_F(ConsoleTest, NotesAndToolsAreMarkedFromTheKeyboard) {
  StartDemoAndWaitForFrames();
  ASSERT_NO_FATAL_FAILURE(Activate());
  QTest::keyClick(&window_, Qt::Key_1);
  QTest::keyClick(&window_, Qt::Key_9);  // no such tool
  EXPECT_TRUE(Find<QCheckBox>("tool:tongs")->isChecked());
  QTest::keyClick(&window_, Qt::Key_N, Qt::ControlModifier);
  auto* note = Find<QLineEdit>("note");
  ASSERT_TRUE(note->hasFocus());
  QTest::keyClicks(note, " reaches with 1 finger + a twist ");
  EXPECT_TRUE(GapIs(kGuessedGapMm)) << "what is typed moves nothing";
  QTest::keyClick(note, Qt::Key_Return);
  EXPECT_EQ(note->text(), "");
  EXPECT_FALSE(note->hasFocus());
  QTest::keyClick(note, Qt::Key_N, Qt::ControlModifier);
  QTest::keyClicks(note, "not this one");
  QTest::keyClick(note, Qt::Key_Escape);
  AwaitFrames(3);
  StopAndWait();
  std::vector<std::string> notes, tools;
  for (const core::SessionEvent& event : sessions::SessionReader(session_).events()) {
    if (const auto* said = std::get_if<core::Note>(&event.what)) notes.push_back(said->text);
    if (const auto* mark = std::get_if<core::ToolMarked>(&event.what)) tools.push_back(mark->tool);
  }
  EXPECT_EQ(std::ranges::count(notes, "reaches with 1 finger + a twist"), 1);
  EXPECT_EQ(std::ranges::count(notes, "not this one"), 0);
  EXPECT_EQ(tools, std::vector<std::string>{"tongs"});
}

TEST_F(ConsoleTest, UndoBringsTheGapBackAndTheSessionRecordsBothChanges) {
  EXPECT_FALSE(Action("undo_gap").isEnabled());
  StartDemoAndWaitForFrames();
  EXPECT_FALSE(Action("undo_gap").isEnabled());
  auto* gap = Find<QDoubleSpinBox>("spacing_box:payload_a_gap");
  gap->setValue(kNeededGapMm);
  ASSERT_TRUE(WaitUntil([&] { return GapIs(kNeededGapMm); }));
  ASSERT_TRUE(Action("undo_gap").isEnabled());
  EXPECT_FALSE(Action("redo_gap").isEnabled());
  ASSERT_NO_FATAL_FAILURE(Activate());
  gap->setFocus();  // its own undo would be that of the typed digits
  QTest::keyClick(gap, Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(WaitUntil([&] { return GapIs(kGuessedGapMm); }));
  EXPECT_EQ(gap->value(), kGuessedGapMm);
  Action("redo_gap").trigger();
  ASSERT_TRUE(WaitUntil([&] { return GapIs(kNeededGapMm); }));
  StopAndWait();
  EXPECT_FALSE(Action("undo_gap").isEnabled());
  std::vector<double> to_mm;
  for (const core::SessionEvent& event : sessions::SessionReader(session_).events())
    if (const auto* change = std::get_if<core::SpacingChanged>(&event.what)) to_mm.push_back(change->to_mm);
  EXPECT_EQ(to_mm, std::vector<double>({kNeededGapMm, kGuessedGapMm, kNeededGapMm}));
}

TEST_F(ConsoleTest, ABrokenPairRuleIsShownWithTheFrameThatHasItsVerdict) {
  const auto setup = [](const std::stop_token&) {
    control::TrialSetup trial = control::MakeDemoTrial(control::DemoPlay::kForever);
    trial.layout.pair_rules[0].required_clearance_mm = 100.0;
    return trial;
  };
  window_.desk().Start(setup, session_);
  ASSERT_TRUE(WaitUntil([&] { return last_frame_ && last_frame_->pairs; }));
  const auto line = [&] { return Find<QLabel>("pair_rule:0")->text(); };
  int broken = 0, otherwise = 0;
  const QMetaObject::Connection watch =
      QObject::connect(&window_.desk(), &TrialDesk::FrameArrived, &window_, [&](const FrameNews& news) {
        const control::PairVerdicts& verdicts = *news.result->pairs;
        if (!GapIs(72.0) || verdicts.setting.spacing_mm != news.result->record.spacing_mm) return;
        const bool is_shown =
            line() == QString::fromUtf8("✕ pmt and payload_a: 72.0 mm, near; rule of 100 mm broken");
        (is_shown ? broken : otherwise) += 1;
      });
  Find<QDoubleSpinBox>("spacing_box:payload_a_gap")->setValue(72.0);
  EXPECT_TRUE(WaitUntil([&] { return broken >= 3; })) << line().toStdString();
  QObject::disconnect(watch);
  EXPECT_EQ(otherwise, 0);
}

TEST_F(ConsoleTest, TheHullsLookIsChosenFromAMenu) {
  auto* button = Find<HullLookButton>("hull_look");
  EXPECT_EQ(button->text(), "Hull: shaded");
  QSignalSpy chosen(button, &HullLookButton::Chosen);
  StartDemoAndWaitForFrames();
  QSignalSpy pictures(&window_.view(), &OperatorView::PictureShown);
  Action("look_rig_cameras").trigger();
  EXPECT_EQ(button->text(), "Hull: camera colours");
  ASSERT_EQ(chosen.size(), 1);
  EXPECT_EQ(chosen.front().front().value<control::SceneLook>().hull, recon::HullAppearance::kRigCameras);
  ASSERT_TRUE(WaitUntil([&] { return !pictures.isEmpty(); }));
  StopAndWait();
}

TEST_F(ConsoleTest, TheMouseTurnsTheOperatorsView) {
  StartDemoAndWaitForFrames();
  auto* view = window_.findChild<OperatorView*>();
  ASSERT_NE(view, nullptr);
  QSignalSpy pictures(view, &OperatorView::PictureShown);
  ASSERT_TRUE(WaitUntil([&] { return !pictures.isEmpty(); }));
  EXPECT_FALSE(view->driver().isEmpty());
  const recon::OrbitCamera fitted = *view->camera();

  QTest::mousePress(view, Qt::LeftButton, {}, QPoint(200, 200));
  QTest::mouseMove(view, QPoint(260, 220));
  QTest::mouseRelease(view, Qt::LeftButton, {}, QPoint(260, 220));
  EXPECT_NE(view->camera()->azimuth_rad, fitted.azimuth_rad);
  EXPECT_EQ(view->camera()->distance_mm, fitted.distance_mm);

  QWheelEvent wheel(QPointF(200, 200), view->mapToGlobal(QPointF(200, 200)), {}, QPoint(0, 120), Qt::NoButton,
                    Qt::NoModifier, Qt::NoScrollPhase, false);
  QApplication::sendEvent(view, &wheel);
  EXPECT_LT(view->camera()->distance_mm, fitted.distance_mm);
  pictures.clear();
  ASSERT_TRUE(WaitUntil([&] { return !pictures.isEmpty(); }));

  QTest::keyClick(&window_, Qt::Key_F);
  ASSERT_TRUE(WaitUntil([&] { return view->camera()->azimuth_rad == fitted.azimuth_rad; }));
}

// At the size of a small screen, or of a larger one whose pixels are doubled.
TEST_F(ConsoleTest, AllOfARunningTrialFitsASmallScreen) {
  window_.resize(960, 540);
  StartDemoAndWaitForFrames();
  ASSERT_TRUE(WaitUntil([&] { return frames_ > 5 && !Find<QLabel>("status_driver")->text().isEmpty(); }));
  QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);  // what the last event changed
  EXPECT_EQ(window_.size(), QSize(960, 540)) << "something needs more";
  for (const char* list : {"contact_list", "touch_list"}) {
    const auto* table = Find<QTableView>(list);
    EXPECT_LE(table->horizontalHeader()->length(), table->viewport()->width()) << list;
    EXPECT_GE(table->viewport()->height(), table->verticalHeader()->defaultSectionSize()) << list;
    for (int column = 0; column < table->model()->columnCount(); ++column)
      EXPECT_GE(table->columnWidth(column), table->horizontalHeader()->sectionSizeHint(column)) << list;
  }
  for (const QLabel* field : window_.statusBar()->findChildren<QLabel*>()) {
    if (!field->isVisible()) continue;
    EXPECT_GE(field->width(), field->sizeHint().width()) << field->objectName().toStdString();
  }
  EXPECT_GE(window_.view().height(), 200);
  EXPECT_GT(window_.strip().height(), 100);
}

// Nobody is asked for a name, and no dialog stops the trial.
TEST_F(ConsoleTest, TheSecondTrialIsRecordedWithoutAQuestion) {
  SetSessionsFolder(folder_ / "sessions");
  StartDemoAndWaitForFrames();
  StopAndWait();
  last_frame_.reset();
  StartDemoAndWaitForFrames();
  EXPECT_EQ(QApplication::activeModalWidget(), nullptr);
  EXPECT_EQ(window_.desk().session().parent_path(), folder_ / "sessions");
  StopAndWait();
  EXPECT_EQ(sessions::SessionReader(window_.desk().session()).status(), sessions::SessionStatus::kComplete);
}

TEST_F(ConsoleTest, AnExistingSessionIsLeftAloneAndTheErrorShown) {
  test_support::WriteText(session_, "somebody's work");
  Action("start_demo").trigger();
  EXPECT_FALSE(Action("start_demo").isEnabled());
  ASSERT_TRUE(WaitUntil([&] { return IsIdle(); }));
  EXPECT_NE(Message().find(session_.string()), std::string::npos) << Message();
  EXPECT_EQ(Message().find('\n'), std::string::npos);
  EXPECT_TRUE(Find<QLabel>("message")->isVisible());
  EXPECT_TRUE(Action("start_demo").isEnabled());
  EXPECT_FALSE(Action("report").isEnabled());
  EXPECT_EQ(test_support::ReadText(session_), "somebody's work");
}

TEST_F(ConsoleTest, APictureOfATrialThatCannotBeginIsNotWaitedFor) {
  test_support::WriteText(session_, "somebody's work");
  PictureOrder order;
  order.png = folder_ / "window.png";
  WindowPicture picture(order, window_);
  QSignalSpy taken(&picture, &WindowPicture::Taken);
  Action("start_demo").trigger();
  ASSERT_TRUE(WaitUntil([&] { return !taken.isEmpty(); }));
  EXPECT_NE(taken[0][0].toString().toStdString().find(session_.string()), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "window.png"));
}

TEST_F(ConsoleTest, ABrokenTrialFileIsOneLineAndLeavesNoSession) {
  const std::filesystem::path trial = folder_ / "trial.toml";
  test_support::WriteText(trial, "rig = ");
  StartTrialFile(window_.desk(), trial, window_.session_place());
  ASSERT_TRUE(WaitUntil([&] { return IsIdle(); }));
  EXPECT_NE(Message().find("trial.toml"), std::string::npos) << Message();
  EXPECT_EQ(Message().find('\n'), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(session_));
}

// What isn't saved is asked for when the trial is over, and a "no" is one for this time alone.
TEST_F(ConsoleTest, NoBoxStandsBeforeATrialThatIsClosed) {
  StartDemoAndWaitForFrames();
  LayoutDesk& layout = window_.layout_page().desk();
  ASSERT_EQ(layout.Apply("Unit", [](cad_import::LayoutText& text) { text.SetUnit(core::LengthUnit::kInch); }),
            "");
  ASSERT_TRUE(layout.is_unsaved());
  EXPECT_FALSE(window_.close());
  EXPECT_FALSE(window_.desk().state() == DeskState::kIdle);
  EXPECT_EQ(QApplication::activeModalWidget(), nullptr);
  ASSERT_TRUE(WaitUntil([&] { return IsIdle(); }));
  auto* question = Find<QWidget>("unsaved");
  ASSERT_TRUE(WaitUntil([&] { return question->isVisible(); }));
  EXPECT_EQ(QApplication::activeModalWidget(), nullptr);
  EXPECT_EQ(window_.pages().page(), Page::kLayout);
  EXPECT_TRUE(window_.isVisible());
  Click(Find<QPushButton>("unsaved_stay"));
  EXPECT_TRUE(window_.isVisible());
  // The next trial's end closes nothing.
  last_frame_.reset();
  StartDemoAndWaitForFrames();
  StopAndWait();
  QApplication::processEvents();
  EXPECT_FALSE(question->isVisible());
  EXPECT_EQ(QApplication::activeModalWidget(), nullptr);
  EXPECT_TRUE(window_.isVisible());
  EXPECT_FALSE(window_.close());
  Click(Find<QPushButton>("unsaved_discard"));
  EXPECT_TRUE(WaitUntil([&] { return !window_.isVisible(); }));
}

TEST_F(ConsoleTest, ClosingTheWindowCompletesTheSessionFirst) {
  StartDemoAndWaitForFrames();
  EXPECT_FALSE(window_.close());
  ASSERT_TRUE(WaitUntil([&] { return !window_.isVisible(); }));
  const sessions::SessionReader session(session_);
  EXPECT_EQ(session.status(), sessions::SessionStatus::kComplete);
  EXPECT_GT(session.frame_count(), 0);
}

TEST_F(ConsoleTest, AnOrderedPictureShowsTheWindowAtTheOrderedGap) {
  PictureOrder order;
  order.png = folder_ / "window.png";
  order.after_s = 0.2;
  order.spacing_mm = kNeededGapMm;
  WindowPicture picture(order, window_);
  QSignalSpy taken(&picture, &WindowPicture::Taken);
  StartDemoAndWaitForFrames();
  ASSERT_TRUE(WaitUntil([&] { return !taken.isEmpty(); }));
  EXPECT_EQ(taken.front().front().toString(), QString());
  EXPECT_TRUE(GapIs(kNeededGapMm));
  EXPECT_EQ(QImage(QString::fromStdString(order.png.string())).size(), window_.size());
}

}  // namespace
}  // namespace elbowroom::console
