// A recorded session is gone through as a reviewer would: through the page's widgets, on Qt's offscreen
// platform.
#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QLabel>
#include <QLineEdit>
#include <QMimeData>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QSettings>
#include <QSignalSpy>
#include <QSlider>
#include <QTableView>
#include <QTest>
#include <QToolButton>
#include <filesystem>

#include "app/console/reviews/keep_out_dialog.h"
#include "app/console/reviews/recent_sessions.h"
#include "app/control/demo_parts.h"
#include "app/control/outcome_tracker.h"
#include "app/control/replay/replay.h"
#include "tests/app/console/demo_session.h"
#include "tests/app/console/opened_urls.h"
#include "tests/app/console/stall_watch.h"
#include "tests/app/console/window_fixture.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

namespace fs = std::filesystem;
constexpr double kWideMm = 300.0;

// As in the tests of trials: a window that doesn't answer for so long is felt to hang.
constexpr double kLongestStallMs = 200.0;

class ReviewPageTest : public WindowFixture {
 protected:
  ReviewPageTest() : WindowFixture("next.db"), reviewed_(folder_ / "trial.db") {
    fs::copy_file(DemoSession(), reviewed_);
    QObject::connect(&desk(), &ReviewDesk::FrameArrived, &window_,
                     [this](const control::ScrubbedFrame& frame) { shown_ = frame; });
  }

  ReviewPage& page() { return window_.review_page(); }
  ReviewDesk& desk() { return page().desk(); }
  // Of the page, which has its own.
  [[nodiscard]] QString Message() {
    return Find<QFrame>("review_messages")->findChild<QLabel*>("message")->text();
  }
  void OpenIt() {
    window_.OpenSession(reviewed_);
    ASSERT_TRUE(WaitUntil([&] { return desk().is_open() && !desk().is_busy() && shown_.result; }))
        << Message().toStdString();
  }
  bool WaitForPosition(std::size_t position) {
    return WaitUntil([&] { return shown_.result && shown_.position == position; });
  }
  void Press(Qt::Key key) { QTest::keyClick(Find<QWidget>("timeline"), key); }
  QTableView* List() { return Find<QTableView>("finding_list"); }
  // In the list's row.
  void ChooseRow(int row) {
    const QRect cell = List()->visualRect(List()->model()->index(row, 0));
    QTest::mouseClick(List()->viewport(), Qt::LeftButton, {}, cell.center());
  }
  int RowOf(core::FindingKind kind) {
    const auto& findings = desk().findings();
    const auto at =
        std::ranges::find_if(findings, [&](const auto& each) { return each.finding.kind == kind; });
    return static_cast<int>(at - findings.begin());
  }
  void WaitForJob() {
    ASSERT_TRUE(WaitUntil([&] { return !desk().is_busy(); }));
  }

  fs::path reviewed_;
  control::ScrubbedFrame shown_;
};

TEST_F(ReviewPageTest, HeatAndTheHullsLooksAreShownWithTheirLegends) {
  OpenIt();
  OperatorView& view = *page().view();
  EXPECT_TRUE(view.legends().empty());
  Press(Qt::Key_H);
  ASSERT_TRUE(WaitUntil([&] { return !view.legends().empty(); }));
  EXPECT_TRUE(view.legends()[0].note.contains("whole session"));
  EXPECT_FALSE(view.legends()[0].colours.empty());
  Press(Qt::Key_U);
  EXPECT_EQ(view.legends().size(), 2U);
  EXPECT_EQ(Find<QToolButton>("review_hull_look")->text(), "Hull: uncertainty");
  Press(Qt::Key_U);
  EXPECT_EQ(view.legends().size(), 1U);
  Press(Qt::Key_H);
  EXPECT_TRUE(view.legends().empty());
  EXPECT_TRUE(Message().isEmpty()) << Message().toStdString();
}

TEST_F(ReviewPageTest, ShowsWhatIsInTheSession) {
  const StallWatch stalls;
  OpenIt();
  EXPECT_EQ(window_.pages().page(), Page::kReview);
  EXPECT_TRUE(Find<QLabel>("review_title")->text().contains("trial.db"));
  EXPECT_TRUE(Find<QLabel>("review_facts")->text().contains("100 frames"));
  EXPECT_EQ(List()->model()->rowCount(), std::ssize(desk().findings()));
  EXPECT_GE(List()->model()->rowCount(), 2);
  EXPECT_TRUE(WaitForPosition(0));
  ASSERT_TRUE(WaitUntil([&] { return page().view()->camera().has_value(); }));
  EXPECT_LT(stalls.longest_ms(), kLongestStallMs);
}

TEST_F(ReviewPageTest, IsScrubbedByMouseAndKeys) {
  OpenIt();
  auto* timeline = Find<TimelineView>("timeline");
  const auto& frames = desk().session().frames();
  const auto at = [&](double time_s) {
    return QPoint(static_cast<int>(timeline->XOf(time_s)), timeline->height() - 6);
  };
  const double middle_s = 0.5 * (frames.front().time_s + frames.back().time_s);
  QTest::mouseClick(timeline, Qt::LeftButton, {}, at(middle_s));
  const std::size_t middle = desk().position();
  EXPECT_NEAR(frames[middle].time_s, middle_s, 0.1);
  EXPECT_TRUE(WaitForPosition(middle));
  Press(Qt::Key_Right);
  EXPECT_TRUE(WaitForPosition(middle + 1));
  Press(Qt::Key_Left);
  Press(Qt::Key_Left);
  EXPECT_TRUE(WaitForPosition(middle - 1));
  Press(Qt::Key_End);
  EXPECT_TRUE(WaitForPosition(frames.size() - 1));
  Press(Qt::Key_Home);
  EXPECT_TRUE(WaitForPosition(0));
  QTest::mousePress(timeline, Qt::LeftButton, {}, at(frames.front().time_s));
  QTest::mouseMove(timeline, at(frames.back().time_s));
  EXPECT_TRUE(WaitUntil([&] { return desk().position() + 1 >= frames.size() - 1; }));
  QTest::mouseRelease(timeline, Qt::LeftButton, {}, at(frames.back().time_s));
}

TEST_F(ReviewPageTest, GoesFromTouchToTouch) {
  OpenIt();
  Press(Qt::Key_PageDown);
  ASSERT_TRUE(List()->currentIndex().isValid());
  const control::ListedFinding& first =
      desk().findings()[static_cast<std::size_t>(List()->currentIndex().row())];
  EXPECT_EQ(desk().position(), *first.worst_position);
  EXPECT_TRUE(WaitForPosition(*first.worst_position));
  Press(Qt::Key_PageDown);
  EXPECT_GT(desk().position(), *first.worst_position);
  Press(Qt::Key_PageUp);
  EXPECT_EQ(desk().position(), *first.worst_position);
  // By the list, and by the bar on the timeline.
  const int touch = RowOf(core::FindingKind::kTouch);
  ChooseRow(touch);
  EXPECT_EQ(desk().position(), *desk().findings()[static_cast<std::size_t>(touch)].worst_position);
  Press(Qt::Key_Home);
  auto* timeline = Find<TimelineView>("timeline");
  QTest::mouseClick(timeline, Qt::LeftButton, {},
                    timeline->PlaceOf(static_cast<std::size_t>(touch)).center().toPoint());
  EXPECT_EQ(desk().position(), *desk().findings()[static_cast<std::size_t>(touch)].worst_position);
}

TEST_F(ReviewPageTest, PlaysToTheEnd) {
  OpenIt();
  Press(Qt::Key_End);
  for (int i = 0; i < 5; ++i) Press(Qt::Key_Left);
  Press(Qt::Key_Space);
  EXPECT_TRUE(Find<QToolButton>("play")->isChecked());
  EXPECT_TRUE(WaitForPosition(desk().session().frames().size() - 1));
  EXPECT_TRUE(WaitUntil([&] { return !Find<QToolButton>("play")->isChecked(); }));
}

TEST_F(ReviewPageTest, StatusAndCommentAreInTheFile) {
  OpenIt();
  const int touch = RowOf(core::FindingKind::kTouch);
  EXPECT_FALSE(Find<QPushButton>("remark_add")->isEnabled());
  ChooseRow(touch);
  auto* status = Find<QComboBox>("remark_status");
  status->setCurrentText("active");
  Find<QLineEdit>("remark_comment")->setText("ask the <cable> team");
  Find<QLineEdit>("remark_name")->setText("Ann");
  QTest::mouseClick(Find<QPushButton>("remark_add"), Qt::LeftButton);
  WaitForJob();
  // A second one, by Enter.
  status->setCurrentText("approved");
  QTest::keyClick(Find<QLineEdit>("remark_comment"), Qt::Key_Return);
  WaitForJob();
  EXPECT_EQ(List()->model()->index(touch, FindingModel::kStatus).data().toString(), "approved");
  EXPECT_TRUE(Find<QTextBrowser>("remarks")->toPlainText().contains("ask the <cable> team"));
  const core::Finding kept =
      sessions::SessionReader(reviewed_).findings().at(static_cast<std::size_t>(touch));
  ASSERT_EQ(kept.remarks.size(), 2U);
  EXPECT_EQ(kept.status(), core::ReviewStatus::kApproved);
  EXPECT_EQ(kept.remarks[0].comment, "ask the <cable> team");
  EXPECT_EQ(kept.remarks[0].by, "Ann");
  EXPECT_EQ(kept.remarks[0].status, core::ReviewStatus::kActive);

  // Another window sees it, and lists by it.
  MainWindow again;
  again.show();
  again.OpenSession(reviewed_);
  ASSERT_TRUE(WaitUntil([&] { return again.review_page().desk().is_open(); }));
  auto* list = again.findChild<QTableView*>("finding_list");
  again.findChild<QComboBox*>("finding_status_filter")->setCurrentText("approved");
  ASSERT_EQ(list->model()->rowCount(), 1);
  EXPECT_EQ(list->model()->index(0, FindingModel::kStatus).data().toString(), "approved");
  again.findChild<QComboBox*>("finding_part_filter")->setCurrentText("pmt");
  EXPECT_EQ(list->model()->rowCount(), 0);
}

TEST_F(ReviewPageTest, AnotherGapIsJudgedAtOnce) {
  OpenIt();
  ChooseRow(RowOf(core::FindingKind::kTouch));
  const std::size_t position = desk().position();
  ASSERT_TRUE(WaitForPosition(position));
  auto* slider = Find<QSlider>(QString("what_if_slider:") + control::kDemoGap);
  for (double gap_mm = 150.0; gap_mm <= kWideMm; gap_mm += 10.0)  // as it is dragged
    slider->setValue(static_cast<int>(10.0 * gap_mm));
  EXPECT_EQ(Find<QDoubleSpinBox>(QString("what_if_box:") + control::kDemoGap)->value(), kWideMm);
  ASSERT_TRUE(
      WaitUntil([&] { return !shown_.held_mm.empty() && shown_.held_mm.at(control::kDemoGap) == kWideMm; }));
  EXPECT_EQ(shown_.result->record.spacing_mm.at(0), kWideMm);
  EXPECT_NE(shown_.result->record.contacts.at(1).verdict, core::Verdict::kContact);
  ASSERT_TRUE(WaitUntil([&] { return desk().what_if().has_value(); }));
  const QString result = Find<QLabel>("what_if_result")->text();
  EXPECT_TRUE(result.contains("300 mm: 0 touches")) << result.toStdString();
  EXPECT_TRUE(result.contains("clearance ≥")) << result.toStdString();

  const control::ReplayOutcome replay =
      control::RunReplay(control::OpenWithOutcome(reviewed_, {}, {}),
                         {folder_ / "replay.db", {.held_mm = {{control::kDemoGap, kWideMm}}}, {}}, {}, {});
  EXPECT_EQ(desk().what_if()->outcome.episodes.size(), replay.outcome.episodes.size());
  EXPECT_EQ(desk().what_if()->vanished.size(), replay.absent.size());
  EXPECT_FALSE(replay.absent.empty());
  const QModelIndex row = List()->model()->index(RowOf(core::FindingKind::kTouch), 0);
  EXPECT_TRUE(row.data(Qt::FontRole).value<QFont>().strikeOut());

  QTest::mouseClick(Find<QPushButton>("what_if_off"), Qt::LeftButton);
  EXPECT_TRUE(WaitUntil([&] { return shown_.held_mm.empty(); }));
  EXPECT_FALSE(row.data(Qt::FontRole).value<QFont>().strikeOut());
  EXPECT_EQ(Find<QDoubleSpinBox>(QString("what_if_box:") + control::kDemoGap)->value(), 140.0);
}

TEST_F(ReviewPageTest, TheNeededGapIsFound) {
  OpenIt();
  QTest::mouseClick(Find<QPushButton>(QString("what_if_needed:") + control::kDemoGap), Qt::LeftButton);
  EXPECT_TRUE(desk().is_busy());
  WaitForJob();
  const QString line = Find<QLabel>("what_if_details")->text();
  EXPECT_TRUE(line.contains("free of touches from")) << line.toStdString();
  Find<QDoubleSpinBox>(QString("what_if_box:") + control::kDemoGap)->setValue(kWideMm);
  ASSERT_TRUE(WaitUntil([&] { return desk().what_if().has_value(); }));
  const QString result = Find<QLabel>("what_if_result")->text();
  EXPECT_TRUE(result.contains("; needed ")) << result.toStdString();
}

TEST_F(ReviewPageTest, ReportTouchesAndKeepOutVolumeAreWritten) {
  const OpenedUrls opened;
  OpenIt();
  QTest::mouseClick(Find<QPushButton>("review_report"), Qt::LeftButton);
  EXPECT_FALSE(Find<QPushButton>("review_report")->isEnabled());
  WaitForJob();
  EXPECT_TRUE(fs::exists(folder_ / "trial-report" / "report.html"));
  EXPECT_EQ(opened.urls().size(), 1U);

  desk().ExportBcf(folder_ / "touches.bcfzip");
  WaitForJob();
  EXPECT_TRUE(fs::exists(folder_ / "touches.bcfzip")) << Message().toStdString();
  desk().ImportBcf(folder_ / "touches.bcfzip");
  WaitForJob();
  EXPECT_TRUE(Message().contains("0 remark")) << Message().toStdString();

  QTest::mouseClick(Find<QPushButton>("review_keep_out"), Qt::LeftButton);
  auto* dialog = window_.findChild<KeepOutDialog*>();
  ASSERT_NE(dialog, nullptr);
  dialog->findChild<QDoubleSpinBox*>("keep_out_edge")->setValue(20.0);
  auto* file = dialog->findChild<QLineEdit*>("keep_out_file");
  file->setText("volume.txt");
  EXPECT_FALSE(dialog->findChild<QPushButton*>("keep_out_write")->isEnabled());
  file->setText(QString::fromStdString((folder_ / "volume.stl").string()));
  QTest::mouseClick(dialog->findChild<QPushButton*>("keep_out_write"), Qt::LeftButton);
  WaitForJob();
  EXPECT_TRUE(fs::exists(folder_ / "volume.stl")) << Message().toStdString();
}

TEST_F(ReviewPageTest, AKeepOutFileThatIsThereIsNotReplacedSilently) {
  test_support::WriteText(folder_ / "volume.stl", "somebody's work");
  KeepOutDialog dialog(session_, nullptr);
  int asked = 0;
  QObject::connect(&dialog, &KeepOutDialog::Asked, &dialog, [&] { ++asked; });
  dialog.show();
  dialog.findChild<QLineEdit*>("keep_out_file")
      ->setText(QString::fromStdString((folder_ / "volume.stl").string()));
  auto* write = dialog.findChild<QPushButton*>("keep_out_write");
  QTest::mouseClick(write, Qt::LeftButton);
  EXPECT_EQ(asked, 0);
  EXPECT_TRUE(dialog.isVisible());
  EXPECT_TRUE(dialog.findChild<QLabel*>("keep_out_fault")->text().contains("volume.stl"));
  QTest::mouseClick(write, Qt::LeftButton);  // again: yes
  EXPECT_EQ(asked, 1);
}

TEST_F(ReviewPageTest, TheTimelineIsAsHighAsItsRowsAndScrollsManyOfThem) {
  OpenIt();
  auto* timeline = Find<TimelineView>("timeline");
  auto* area = Find<QScrollArea>("timeline_area");
  EXPECT_EQ(area->height(), timeline->sizeHint().height());  // nothing is cut off
  control::SessionTimeline many = desk().timeline();
  ASSERT_FALSE(many.rows.empty());
  control::TimelineRow touched = many.rows.front();
  touched.spans = {{0, core::FindingKind::kTouch, many.begin_s, many.begin_s + 1.0}};
  many.rows.assign(14, touched);
  timeline->Open(many);
  EXPECT_EQ(timeline->sizeHint().height(), TimelineView::HeightOf(14));
  ASSERT_TRUE(WaitUntil([&] { return timeline->height() == TimelineView::HeightOf(14); }));
  EXPECT_GT(area->verticalScrollBar()->maximum(), 0);
}

TEST_F(ReviewPageTest, AJobIsCancelled) {
  OpenIt();
  desk().WriteKeepOut(1.0, folder_ / "volume.stl");
  EXPECT_TRUE(Find<QPushButton>("review_job_cancel")->isVisible());
  QTest::mouseClick(Find<QPushButton>("review_job_cancel"), Qt::LeftButton);
  WaitForJob();
  EXPECT_TRUE(Message().startsWith("Cancelled")) << Message().toStdString();
  EXPECT_FALSE(fs::exists(folder_ / "volume.stl"));
  EXPECT_FALSE(Find<QPushButton>("review_job_cancel")->isVisible());
}

TEST_F(ReviewPageTest, ASessionThatCannotBeOpenedIsOneLineInPlace) {
  test_support::WriteText(folder_ / "text.db", "no session");
  window_.OpenSession(folder_ / "text.db");
  WaitForJob();
  EXPECT_TRUE(Message().contains("text.db")) << Message().toStdString();
  EXPECT_FALSE(Message().contains('\n'));
  EXPECT_TRUE(Find<QPushButton>("review_open")->isVisible());
  OpenIt();
  EXPECT_FALSE(Find<QFrame>("review_messages")->isVisible());
  window_.OpenSession(folder_ / "none.db");
  WaitForJob();
  EXPECT_TRUE(Message().contains("none.db"));
  EXPECT_TRUE(Find<QLabel>("review_title")->text().contains("trial.db")) << "the last one is still there";
}

TEST_F(ReviewPageTest, ASessionIsDroppedAndRemembered) {
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(QString::fromStdString(reviewed_.string()))});
  QDragEnterEvent enter(QPoint(10, 10), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  enter.ignore();
  QApplication::sendEvent(&window_, &enter);
  ASSERT_TRUE(enter.isAccepted());
  QDropEvent drop(QPointF(10, 10), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&window_, &drop);
  ASSERT_TRUE(WaitUntil([&] { return desk().is_open(); }));
  EXPECT_EQ(RecentSessions().value(0).toStdString(), reviewed_.string());
}

TEST_F(ReviewPageTest, TheTrialThatHasEndedIsReviewed) {
  auto* review = Find<QAction>("review_trial");
  EXPECT_FALSE(review->isEnabled());
  int frames = 0;
  QObject::connect(&window_.desk(), &TrialDesk::FrameArrived, &window_, [&] { ++frames; });
  Find<QAction>("start_demo")->trigger();
  ASSERT_TRUE(WaitUntil([&] { return frames > 3; }));
  EXPECT_FALSE(review->isEnabled());
  Find<QAction>("stop")->trigger();
  ASSERT_TRUE(WaitUntil([&] { return window_.desk().state() == DeskState::kIdle; }));
  review->trigger();
  ASSERT_TRUE(WaitUntil([&] { return desk().is_open(); })) << Message().toStdString();
  EXPECT_EQ(desk().session().path(), folder_ / "next.db");
}

// Nothing is cut off in a small window.
TEST_F(ReviewPageTest, FitsASmallScreen) {
  OpenIt();
  QTest::qWait(100);
  EXPECT_LE(window_.minimumSizeHint().width(), 1280);
  EXPECT_LE(window_.minimumSizeHint().height(), 720);
  EXPECT_EQ(window_.size(), QSize(1280, 720));
  for (const auto* button : page().findChildren<QPushButton*>()) {
    if (!button->isVisible()) continue;
    EXPECT_GE(button->width(), button->minimumSizeHint().width()) << button->objectName().toStdString();
    EXPECT_FALSE(button->toolTip().isEmpty()) << button->objectName().toStdString();
  }
}

}  // namespace
}  // namespace elbowroom::console
