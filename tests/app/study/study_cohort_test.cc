// Table 3 of a simulated cohort whose truth is known, and its conditions compared.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/app/study/cohort.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using tests::Reach, tests::Seen;

// Between a gap that is touched and one that is free (SpacingStudyOptions::tolerance_mm), and what a
// contact's resolution and the oracle's grid leave open.
constexpr double kToleranceMm = 0.5, kOpenMm = 1.5;
// What eight cameras' hull stands above a ball or a tool's tip.
constexpr double kHullExcessMm = 8.0;

// The paper's four designers: all allocate too little, the first needs no tool.
const std::vector<Reach> kDesigners{{"P1", "free hands", 1, 100.0, 130.0, 121.0},
                                    {"P2", "tongs", 1, 90.0, 170.0, 118.0, 171.0, 0.7, 5},
                                    {"P3", "tongs", 1, 140.0, 180.0, 132.0, 164.0, 0.9, 6},
                                    {"P4", "tongs", 1, 110.0, 160.0, 115.0, 158.0, 0.6, 4}};

struct Sample {
  double mean = 0.0, error2 = 0.0;
  double sd = 0.0;
  explicit Sample(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    sd = std::sqrt(squares / (n - 1.0));
    error2 = sd * sd / n;
  }
};

// Holm's, from its definition: the largest of the multiples of all p that are no larger.
double Holm(const std::vector<double>& p, std::size_t of) {
  std::vector<double> sorted = p;
  std::sort(sorted.begin(), sorted.end());
  double corrected = 0.0;
  for (std::size_t i = 0; i < sorted.size() && sorted[i] <= p[of]; ++i)
    corrected = std::max(corrected, std::min(1.0, sorted[i] * static_cast<double>(sorted.size() - i)));
  return corrected;
}

class StudyCohort : public testing::Test {
 protected:
  void Record(const Reach& reach) {
    sessions_.push_back(
        (folder_ / (reach.participant + "_" + std::to_string(sessions_.size()) + ".db")).string());
    tests::RecordReach(sessions_.back(), reach);
  }
  nlohmann::json Study(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"study"};
    arguments.insert(arguments.end(), sessions_.begin(), sessions_.end());
    arguments.insert(arguments.end(), {"--out", (folder_ / "out").string(), "--json"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = test_support::RunProgram(test_support::ProgramFile(), arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return nlohmann::json::parse(run.out);
  }

  test_support::TemporaryFolder folder_;
  std::vector<std::string> sessions_;
};

TEST_F(StudyCohort, TableThreeIsThatOfTheMotion) {
  for (const Reach& reach : kDesigners) Record(reach);
  const nlohmann::json study = Study();
  EXPECT_EQ(study["participants"], 4);
  ASSERT_EQ(study["rows"].size(), 4U);
  std::vector<double> shortfalls_mm;
  for (std::size_t i = 0; i < kDesigners.size(); ++i) {
    const Reach& reach = kDesigners[i];
    const nlohmann::json& row = study["rows"][i];
    SCOPED_TRACE(reach.participant);
    EXPECT_EQ(row["participant"], reach.participant);
    EXPECT_EQ(row["estimate_before_mm"], reach.estimate_before_mm);
    EXPECT_EQ(row["estimate_after_mm"], reach.estimate_after_mm);
    const double needed_mm = row["needed_mm"], without_mm = row["needed_without_tools_mm"];
    const double truth_mm = std::max(reach.hand_mm, reach.tool_mm);
    // What the cameras saw, to the tolerance; and that is the real thing and what a hull adds to it.
    const Seen seen = tests::SeenOf(reach);
    EXPECT_NEAR(needed_mm, seen.tool_mm, kToleranceMm + kOpenMm);
    EXPECT_NEAR(without_mm, seen.hand_mm, kToleranceMm + kOpenMm);
    EXPECT_GE(needed_mm, truth_mm - kOpenMm);
    EXPECT_LE(needed_mm, truth_mm + kHullExcessMm);
    EXPECT_GE(without_mm, reach.hand_mm - kOpenMm);
    EXPECT_LE(without_mm, reach.hand_mm + kHullExcessMm);
    EXPECT_DOUBLE_EQ(row["shortfall_mm"].get<double>(), needed_mm - reach.estimate_before_mm);
    shortfalls_mm.push_back(needed_mm - reach.estimate_before_mm);
  }
  const Sample sample(shortfalls_mm);
  EXPECT_NEAR(study["mean_shortfall_mm"].get<double>(), sample.mean, 1e-9);
  EXPECT_NEAR(study["sd_shortfall_mm"].get<double>(), sample.sd, 1e-9);
  // t(0.975, 3) = 3.182446.
  const double half_mm = 3.182446 * std::sqrt(sample.error2);
  EXPECT_NEAR(study["shortfall_interval_mm"][0].get<double>(), sample.mean - half_mm, 1e-4);
  EXPECT_NEAR(study["shortfall_interval_mm"][1].get<double>(), sample.mean + half_mm, 1e-4);
  EXPECT_LT(study["shortfall_bootstrap_mm"][0].get<double>(), sample.mean);
  EXPECT_GT(study["shortfall_bootstrap_mm"][1].get<double>(), sample.mean);
  bool says_few = false;
  for (const auto& note : study["notes"])
    says_few = says_few || note.get<std::string>().find("few participants, 4") == 0;
  EXPECT_TRUE(says_few) << study["notes"].dump();
  const std::string csv = test_support::ReadText(folder_ / "out/participants.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4) << csv;
  // Again: every cell is kept, and the answer is the same.
  nlohmann::json again = Study();
  EXPECT_EQ(again["cells_from_before"], again["cells"]);
  EXPECT_EQ(again["rows"], study["rows"]);
}

TEST_F(StudyCohort, ConditionsAreComparedByWelchsTest) {
  const std::vector<double> bare_mm{80.0, 91.0, 86.0, 99.0}, gloved_mm{97.0, 108.0, 92.0};
  for (std::size_t i = 0; i < bare_mm.size(); ++i)
    Record({"A" + std::to_string(i), "bare", 1, 100.0, 0.0, bare_mm[i], 0.0,
            0.3 + 0.1 * static_cast<double>(i), static_cast<int>(3 + i % 3)});
  for (std::size_t i = 0; i < gloved_mm.size(); ++i)
    Record({"B" + std::to_string(i), "gloved", 1, 100.0, 0.0, gloved_mm[i], 0.0,
            0.8 - 0.05 * static_cast<double>(i), static_cast<int>(5 + i % 2)});
  const nlohmann::json study = Study();
  std::map<std::string, std::vector<double>> needed_mm;
  for (const auto& row : study["rows"])
    needed_mm[row["participant"].get<std::string>().substr(0, 1)].push_back(row["needed_mm"]);
  const Sample a(needed_mm["A"]), b(needed_mm["B"]);
  std::map<std::string, nlohmann::json> by_measure;
  for (const auto& comparison : study["comparisons"])
    by_measure[comparison["measure"].get<std::string>()] = comparison;
  for (const char* measure : {"needed_mm", "shortfall_mm", "trial_s", "step_s:reach in", "answer:presence"})
    EXPECT_TRUE(by_measure.contains(measure)) << measure;
  const nlohmann::json& need = by_measure["needed_mm"];
  EXPECT_EQ(need["a"], "bare");
  EXPECT_EQ(need["b"], "gloved");
  EXPECT_EQ(need["n_a"], 4);
  EXPECT_EQ(need["n_b"], 3);
  EXPECT_NEAR(need["mean_a"].get<double>(), a.mean, 1e-9);
  EXPECT_NEAR(need["mean_b"].get<double>(), b.mean, 1e-9);
  EXPECT_NEAR(need["t"].get<double>(), (a.mean - b.mean) / std::sqrt(a.error2 + b.error2), 1e-9);
  EXPECT_NEAR(need["df"].get<double>(),
              std::pow(a.error2 + b.error2, 2.0) / (a.error2 * a.error2 / 3.0 + b.error2 * b.error2 / 2.0),
              1e-9);
  EXPECT_LE(need["p"].get<double>(), need["corrected_p"].get<double>());
  EXPECT_TRUE(by_measure["trial_s"]["t"].is_null()) << "all trials are as long: there is nothing to test";
  EXPECT_EQ(need["in_both"], 0);
  EXPECT_TRUE(need["t_pairs"].is_null());
}

TEST_F(StudyCohort, TheSamePeopleInBothConditionsArePairs) {
  for (int person = 0; person < 3; ++person) {
    const double reach_mm = 90.0 + 12.0 * person;
    const std::string code = "P" + std::to_string(person);
    Record({code, "bare", 1, 100.0, 0.0, reach_mm});
    Record({code, "gloved", 2, 120.0, 150.0 + person, reach_mm + 8.0 + 2.0 * person});
  }
  const nlohmann::json study = Study();
  ASSERT_EQ(study["rows"].size(), 3U);
  EXPECT_EQ(study["sessions"], 6);
  EXPECT_EQ(study["rows"][1]["estimate_before_mm"], 100.0) << "of the first trial";
  EXPECT_EQ(study["rows"][1]["estimate_after_mm"], 151.0) << "of the last";
  std::vector<double> deciding, decisive;
  for (const auto& comparison : study["comparisons"]) {
    const auto& p = comparison["p_pairs"].is_null() ? comparison["p"] : comparison["p_pairs"];
    EXPECT_EQ(p.is_null(), comparison["decisive_p"].is_null());
    if (p.is_null()) continue;
    deciding.push_back(p);
    decisive.push_back(comparison["decisive_p"]);
    if (comparison["measure"] != "needed_mm") continue;
    EXPECT_EQ(comparison["in_both"], 3);
    EXPECT_LT(comparison["p_pairs"].get<double>(), comparison["p"].get<double>()) << "the sharper question";
    EXPECT_LT(comparison["decisive_p"].get<double>(), comparison["corrected_p"].get<double>());
  }
  ASSERT_GE(deciding.size(), 2U);
  for (std::size_t i = 0; i < deciding.size(); ++i) EXPECT_NEAR(decisive[i], Holm(deciding, i), 1e-12);
}

TEST_F(StudyCohort, ConditionsAreComparedBeyondEachParticipantsBaseline) {
  const std::vector<double> own_mm{80.0, 100.0, 92.0, 86.0, 97.0, 105.0},
      more_mm{9.0, 12.0, 7.0, 16.0, 21.0, 18.0};
  for (std::size_t i = 0; i < own_mm.size(); ++i) {
    const std::string code = "P" + std::to_string(i);
    Record({code, "real", 1, 100.0, 0.0, own_mm[i]});
    Record({code, i < 3 ? "generic" : "faithful", 2, 0.0, 0.0, own_mm[i] + more_mm[i]});
  }
  Record({"P9", "generic", 1, 100.0, 0.0, 200.0});  // without the baseline
  const nlohmann::json study = Study({"--baseline", "real"});
  EXPECT_EQ(study["baseline"], "real");
  std::map<std::string, std::vector<double>> beyond_mm;  // by condition
  for (const auto& row : study["beyond_baseline"]) {
    EXPECT_NE(row["participant"], "P9");
    EXPECT_NE(row["condition"], "real");
    EXPECT_DOUBLE_EQ(row["difference"].get<double>(),
                     row["value"].get<double>() - row["baseline"].get<double>());
    if (row["measure"] == "needed_mm") beyond_mm[row["condition"]].push_back(row["difference"]);
  }
  ASSERT_EQ(beyond_mm["generic"].size(), 3U);
  ASSERT_EQ(beyond_mm["faithful"].size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(beyond_mm["generic"][i], more_mm[i], 2.0 * (kToleranceMm + kOpenMm));
    EXPECT_NEAR(beyond_mm["faithful"][i], more_mm[i + 3], 2.0 * (kToleranceMm + kOpenMm));
  }
  const Sample a(beyond_mm["faithful"]), b(beyond_mm["generic"]);
  int compared = 0;
  for (const auto& comparison : study["comparisons"]) {
    EXPECT_NE(comparison["a"], "real");
    EXPECT_NE(comparison["b"], "real");
    if (comparison["measure"] != "needed_mm") continue;
    ++compared;
    EXPECT_EQ(comparison["n_a"], 3);
    EXPECT_NEAR(comparison["mean_a"].get<double>(), a.mean, 1e-9);
    EXPECT_NEAR(comparison["t"].get<double>(), (a.mean - b.mean) / std::sqrt(a.error2 + b.error2), 1e-9);
  }
  EXPECT_EQ(compared, 1);
  bool says_who = false;
  for (const auto& note : study["notes"])
    says_who =
        says_who ||
        note == "1 of 7 participants have no trial in the baseline condition 'real' and aren't compared: P9";
  EXPECT_TRUE(says_who) << study["notes"].dump();
  const std::string csv = test_support::ReadText(folder_ / "out/baseline.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
            1 + study["beyond_baseline"].size());
}

}  // namespace
}  // namespace elbowroom
