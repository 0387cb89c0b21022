// The keep-out volume in the report's 3-D view, where it is asked for.
#include <gtest/gtest.h>

#include "app/control/demo_trial.h"
#include "app/control/report/session_report.h"
#include "app/control/trial_runner.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

TEST(KeepOutInReport, IsThereWhereItIsAskedFor) {
  const test_support::TemporaryFolder folder;
  control::TrialOptions options;
  options.session = folder / "s.db";
  options.frames = {0, 60};
  control::TrialControls controls;
  (void)control::RunTrial(control::MakeDemoTrial(control::DemoPlay::kOnce), options, controls, {});
  const auto page_with = [&](const control::ReportOptions& report) {
    (void)control::WriteSessionReport(folder / "s.db", folder / "out", {}, {}, report);
    return test_support::ReadText(folder / "out" / "report.html");
  };
  EXPECT_EQ(page_with({}).find("keep-out volume"), std::string::npos);
  EXPECT_NE(page_with({.keep_out_edge_mm = 40.0}).find("keep-out volume"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::tests
