// The paper's tables of simulated cohorts: what `study` finds in the sessions is what is known of the motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

using nlohmann::json;

// The hull of four cameras holds the real thing but for what segmentation loses at its edge, and more.
constexpr double kLostMm = 2.0, kHullExcessMm = 12.0;

class CohortTables : public testing::Test {
 protected:
  json Run(const std::vector<std::string>& arguments) {
    std::vector<std::string> all = arguments;
    all.emplace_back("--json");
    const auto run = test_support::RunProgram(ELBOWROOM_PROGRAM, all);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return json::parse(run.out);
  }
  json Simulate(std::vector<std::string> more) {
    more.insert(more.begin(), "simulate");
    more.insert(more.end(), {"--out", (folder_ / "cohort").string()});
    return Run(more);
  }
  json Study(const json& cohort, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"study", "--out", (folder_ / "study").string()};
    for (const json& trial : cohort["trials"]) arguments.push_back(trial["session"]);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(CohortTables, TableThreeIsThatOfTheMadeMotion) {
  const json cohort = Simulate({"payload", "--participants", "8", "--seconds", "4", "--rate", "8"});
  const json study = Study(cohort);
  ASSERT_EQ(study["rows"].size(), 8U);
  double made_mm = 0.0;
  for (std::size_t i = 0; i < 8; ++i) {
    const json& row = study["rows"][i];
    const json& truth = cohort["trials"][i];
    SCOPED_TRACE(truth.dump());
    EXPECT_EQ(row["participant"], truth["participant"]);
    EXPECT_EQ(row["estimate_before_mm"], truth["estimate_before_mm"]);
    EXPECT_EQ(row["estimate_after_mm"], truth["estimate_after_mm"]);
    for (const char* need : {"needed_without_tools_mm", "needed_mm"}) {
      EXPECT_GE(row[need].get<double>(), truth[need].get<double>() - kLostMm) << need;
      EXPECT_LE(row[need].get<double>(), truth[need].get<double>() + kHullExcessMm) << need;
    }
    made_mm += (truth["needed_mm"].get<double>() - truth["estimate_before_mm"].get<double>()) / 8.0;
  }
  EXPECT_GE(study["mean_shortfall_mm"].get<double>(), made_mm - kLostMm);
  EXPECT_LE(study["mean_shortfall_mm"].get<double>(), made_mm + kHullExcessMm);
}

}  // namespace
}  // namespace elbowroom
