// The paper's tables of simulated cohorts: what `study` finds in the sessions is what is known of the motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

using nlohmann::json;

// The hull of four cameras holds the real thing but for what segmentation loses at its edge, and more: above
// the flat top of a block, too, as cameras look at it from the side.
constexpr double kLostMm = 1.0, kHullExcessMm = 2.0, kBlockExcessMm = 5.0;

using ByParticipant = std::map<std::string, double>;

// Welch's test from its formula.
struct Welch {
  double mean_a = 0.0, mean_b = 0.0, t = 0.0, df = 0.0;

  Welch(const ByParticipant& a, const ByParticipant& b) {
    const auto [a_mean, a_error2] = Of(a);
    const auto [b_mean, b_error2] = Of(b);
    mean_a = a_mean;
    mean_b = b_mean;
    t = (a_mean - b_mean) / std::sqrt(a_error2 + b_error2);
    df = std::pow(a_error2 + b_error2, 2.0) / (a_error2 * a_error2 / (static_cast<double>(a.size()) - 1.0) +
                                               b_error2 * b_error2 / (static_cast<double>(b.size()) - 1.0));
  }
  static std::pair<double, double> Of(const ByParticipant& values) {
    const auto n = static_cast<double>(values.size());
    double mean = 0.0, squares = 0.0;
    for (const auto& [who, value] : values) mean += value / n;
    for (const auto& [who, value] : values) squares += (value - mean) * (value - mean);
    return {mean, squares / (n - 1.0) / n};
  }
};

// The known time of a task's patterns, the mean of each participant in a condition.
std::map<std::string, ByParticipant> TimesOf(const json& cohort, const std::string& task) {
  std::map<std::string, std::map<std::string, std::vector<double>>> all;
  for (const json& trial : cohort["trials"])
    if (trial["task"] == task) all[trial["condition"]][trial["participant"]].push_back(trial["pattern_s"]);
  std::map<std::string, ByParticipant> means;
  for (const auto& [condition, by_participant] : all)
    for (const auto& [who, times] : by_participant)
      means[condition][who] =
          std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
  return means;
}

void ExpectComparison(const json& study, const std::string& measure, const std::string& a,
                      const std::string& b, const Welch& expected) {
  SCOPED_TRACE(fmt::format("{}: {} against {}", measure, a, b));
  const auto found = std::ranges::find_if(study["comparisons"], [&](const json& comparison) {
    return comparison["measure"] == measure && comparison["a"] == a && comparison["b"] == b;
  });
  ASSERT_NE(found, study["comparisons"].end());
  constexpr double kRounding = 1e-9;
  EXPECT_NEAR((*found)["mean_a"].get<double>(), expected.mean_a, kRounding);
  EXPECT_NEAR((*found)["mean_b"].get<double>(), expected.mean_b, kRounding);
  EXPECT_NEAR((*found)["t"].get<double>(), expected.t, kRounding);
  EXPECT_NEAR((*found)["df"].get<double>(), expected.df, kRounding);
}

class CohortTables : public testing::Test {
 protected:
  json Run(const std::vector<std::string>& arguments) {
    std::vector<std::string> all = arguments;
    all.emplace_back("--json");
    const auto run = test_support::RunProgram(test_support::ProgramFile(), all);
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
  EXPECT_TRUE(study["notes"][0].get<std::string>().starts_with("8 of 8 sessions are simulated: "));
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

TEST_F(CohortTables, BlocksGiveThePapersTablesOneAndTwo) {
  const json cohort = Simulate({"blocks", "--participants", "4", "--seconds", "0.5", "--rate", "10"});
  ASSERT_EQ(cohort["trials"].size(), 4U * 20U);
  const json study = Study(cohort), beyond = Study(cohort, {"--baseline", "real"});
  for (const char* task : {"2 x 2, practice", "3 x 3, practice", "2 x 2, timed", "3 x 3, timed"}) {
    auto times = TimesOf(cohort, task);
    ASSERT_EQ(times["real"].size(), 4U);
    ASSERT_EQ(times["generic hands"].size(), 2U);
    const std::string measure = std::string("step_s:") + task;
    // Table 1: the times by condition. Table 2: how they differ, of each participant's own in real space.
    ExpectComparison(study, measure, "faithful hands", "generic hands",
                     Welch(times["faithful hands"], times["generic hands"]));
    ExpectComparison(study, measure, "generic hands", "real", Welch(times["generic hands"], times["real"]));
    for (const char* hybrid : {"faithful hands", "generic hands"})
      for (auto& [who, time] : times[hybrid]) time -= times["real"][who];
    const Welch more(times["faithful hands"], times["generic hands"]);
    EXPECT_GT(more.mean_a, 0.0) << "slower than in real space";
    ExpectComparison(beyond, measure, "faithful hands", "generic hands", more);
  }
  EXPECT_EQ(Study(cohort, {"--baseline", "real", "--block", "timed"})["sessions"], 4 * (6 + 4));
  for (std::size_t i = 0; i < 4; ++i) {
    double known_mm = 0.0;
    for (const json& trial : cohort["trials"])
      if (trial["participant"] == study["rows"][i]["participant"])
        known_mm = std::max(known_mm, trial["needed_mm"].get<double>());
    EXPECT_GE(study["rows"][i]["needed_mm"].get<double>(), known_mm - kLostMm);
    EXPECT_LE(study["rows"][i]["needed_mm"].get<double>(), known_mm + kBlockExcessMm);
  }
}

}  // namespace
}  // namespace elbowroom
