// The review page with its panels and dialogs, looked at.
#include <gtest/gtest.h>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPushButton>
#include <QTableView>

#include "app/console/reviews/keep_out_dialog.h"
#include "app/control/demo_trial.h"
#include "tests/app/console/demo_session.h"
#include "tests/app/console/looks/tour.h"
#include "tests/app/console/opened_urls.h"

namespace elbowroom::console {
namespace {

namespace fs = std::filesystem;

constexpr const char* kComment = "The hand needs more room here.";

class ReviewTour : public Tour {
 protected:
  ReviewTour() : Tour("next.db") {
    fs::copy_file(DemoSession(), reviewed_);
    Know({"pmt", "payload_a", "payload_b", "payload_a_gap", "tongs", "Ann", "reviewed-keep-out.db", kComment,
          Find<QLineEdit>("remark_name")->text()});  // who is logged in
    // The demo's task.
    Know({QString::fromStdString(control::MakeDemoTrial(control::DemoPlay::kOnce).info.task),
          QString::fromStdString(control::MakeDemoTrial(control::DemoPlay::kOnce).info.participant)});
  }

  ReviewDesk& desk() { return window_.review_page().desk(); }
  void WaitForJob() {
    ASSERT_TRUE(WaitUntil([&] { return desk().is_open() && !desk().is_busy(); }));
  }
  QTableView* List() { return Find<QTableView>("finding_list"); }

  fs::path reviewed_ = folder_ / "reviewed.db";
};

TEST_P(ReviewTour, IsAllThere) {
  const OpenedUrls opened;
  window_.pages().Show(Page::kReview);
  Look("review_start");
  window_.OpenSession(reviewed_);
  ASSERT_NO_FATAL_FAILURE(WaitForJob());
  Look("review");
  List()->setCurrentIndex(List()->model()->index(1, 0));
  Find<QComboBox>("remark_status")->setCurrentIndex(1);
  Find<QLineEdit>("remark_comment")->setText(kComment);
  Find<QLineEdit>("remark_name")->setText("Ann");
  Click(Find<QPushButton>("remark_add"));
  ASSERT_NO_FATAL_FAILURE(WaitForJob());
  Look("review_remark");
  Find<QDoubleSpinBox>("what_if_box:payload_a_gap")->setValue(215.0);
  ASSERT_TRUE(WaitUntil([&] { return desk().what_if().has_value(); }));
  Look("review_what_if");
  Click(Find<QPushButton>("what_if_needed:payload_a_gap"));
  if (GetParam() == Inspection::kFit) Look("review_busy");
  ASSERT_NO_FATAL_FAILURE(WaitForJob());
  Look("review_needed");
  Click(Find<QPushButton>("review_section"));
  Look("review_section");
  Click(Find<QPushButton>("review_section"));
  Click(Find<QPushButton>("review_keep_out"));
  Look("review_keep_out", *Find<KeepOutDialog>("keep_out_dialog"));
  Find<KeepOutDialog>("keep_out_dialog")->close();
  desk().ExportBcf(folder_ / "reviewed-touches.bcfzip");
  ASSERT_NO_FATAL_FAILURE(WaitForJob());
  Know({"touches"});
  Look("review_bcf");
  window_.OpenSession(folder_ / "none.db");
  ASSERT_NO_FATAL_FAILURE(WaitForJob());
  if (GetParam() == Inspection::kFit) Look("review_failed");
}

INSTANTIATE_TEST_SUITE_P(Looks, ReviewTour, testing::Values(Inspection::kFit, Inspection::kWords),
                         InspectionName);

}  // namespace
}  // namespace elbowroom::console
