// elbowroom clash: options, JSON keys, the table, mistakes.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;

// Boxes of 100 mm around their origins: `left` and `right` are 20 mm apart, `seed`, a box of 10, is in the
// middle of `left`, `lid` lies on `left`, `far` is a metre away, and `mover` moves above `right`.
constexpr const char* kLayout = R"(
unit = "mm"
[[part]]
name = "left"
file = "box.stl"
[[part]]
name = "right"
file = "box.stl"
position_mm = [120, 0, 0]
[[part]]
name = "seed"
file = "seed.stl"
[[part]]
name = "lid"
file = "box.stl"
position_mm = [0, 0, 100]
[[part]]
name = "far"
file = "box.stl"
position_mm = [0, 1000, 0]
[[part]]
name = "mover"
file = "box.stl"
position_mm = [120, 0, 900]
[[spacing]]
name = "gap"
moving = "mover"
reference = "right"
axis = "z"
min_mm = -50
max_mm = 500
initial_mm = 300
[[pair]]
a = "lid"
b = "left"
authorised_contact = true
[[pair]]
a = "left"
b = "right"
required_clearance_mm = 30
)";

class ClashCommand : public ::testing::Test {
 protected:
  ClashCommand() {
    test_support::WriteBoxStl(folder_ / "box.stl", 100.0);
    test_support::WriteBoxStl(folder_ / "seed.stl", 10.0);
    Write(kLayout);
  }
  void Write(const std::string& text) const { test_support::WriteText(folder_ / "layout.toml", text); }

  [[nodiscard]] ProgramRun Run(std::vector<std::string> more) const {
    more.insert(more.begin(), {"clash", (folder_ / "layout.toml").string()});
    return test_support::RunProgram(test_support::ProgramFile(), more);
  }
  [[nodiscard]] nlohmann::json Json(std::vector<std::string> more = {}) const {
    more.emplace_back("--json");
    const ProgramRun run = Run(more);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }
  // One line on stderr that says `words`.
  void ExpectFailure(const std::vector<std::string>& more, const std::string& words) const {
    const ProgramRun run = Run(more);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(ClashCommand, JudgesEveryPairWorstFirst) {
  const nlohmann::json json = Json();
  EXPECT_EQ(json["pairs"], 15);
  EXPECT_EQ(json["contacts"], 2);
  EXPECT_EQ(json["authorised_contacts"], 1);
  EXPECT_EQ(json["near"], 1);
  EXPECT_EQ(json["clear"], 12);
  EXPECT_EQ(json["undecided"], 0);
  EXPECT_EQ(json["ignored"], 0);
  EXPECT_EQ(json["settled_by_bounds"], 12);
  EXPECT_LE(json["fcl_calls"].get<int>(), 6);
  EXPECT_GT(json["time_ms"].get<double>(), 0.0);
  EXPECT_TRUE(json["warnings"].empty());
  const nlohmann::json& results = json["results"];
  ASSERT_EQ(results.size(), 15U);

  EXPECT_EQ(results[0]["a"], "left");
  EXPECT_EQ(results[0]["b"], "seed");
  EXPECT_EQ(results[0]["verdict"], "contact");
  EXPECT_TRUE(results[0]["contained"].get<bool>());
  EXPECT_NEAR(results[0]["distance_mm"].get<double>(), 45.0, 1e-9);

  EXPECT_EQ(results[1]["b"], "right");
  EXPECT_EQ(results[1]["verdict"], "near");
  EXPECT_NEAR(results[1]["distance_mm"].get<double>(), 20.0, 1e-9);
  EXPECT_EQ(results[1]["required_mm"], 30.0);
  EXPECT_NEAR(results[1]["witness_a_mm"][0].get<double>(), 50.0, 1e-9);
  EXPECT_NEAR(results[1]["witness_b_mm"][0].get<double>(), 70.0, 1e-9);

  EXPECT_EQ(results[2]["b"], "lid");
  EXPECT_EQ(results[2]["verdict"], "contact");
  EXPECT_TRUE(results[2]["authorised"].get<bool>());
  EXPECT_FALSE(results[2]["contained"].get<bool>());
  EXPECT_NEAR(results[2]["distance_mm"].get<double>(), 0.0, 1e-9);

  EXPECT_EQ(results[14]["verdict"], "clear");
  EXPECT_TRUE(results[14]["distance_mm"].is_null());
  EXPECT_TRUE(results[14]["witness_a_mm"].is_null());
  EXPECT_GT(results[14]["at_least_mm"].get<double>(), 0.0);
}

TEST_F(ClashCommand, TheTableSaysTheSame) {
  const ProgramRun run = Run({});
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_EQ(run.err, "");
  const std::size_t seed = run.out.find("left, seed (one inside the other)"),
                    right = run.out.find("left, right"), lid = run.out.find("left, lid (authorised)");
  EXPECT_LT(seed, right);
  EXPECT_LT(right, lid);
  EXPECT_LT(lid, run.out.size());
  EXPECT_EQ(run.out.find("far"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("15 pairs: 2 in contact (1 of them authorised), 1 near, 0 undecided, 12 clear"),
            std::string::npos)
      << run.out;
}

TEST_F(ClashCommand, GapsAreSetAndSelectionsTaken) {
  EXPECT_EQ(Json({"--within", "mover,right"})["clear"], 1);
  const nlohmann::json near = Json({"--within", "mover,right", "--spacing", "gap=7.5", "--required", "8"});
  EXPECT_EQ(near["pairs"], 1);
  EXPECT_EQ(near["near"], 1);
  EXPECT_NEAR(near["results"][0]["distance_mm"].get<double>(), 7.5, 1e-6);  // STL is in floats
  EXPECT_EQ(Json({"--within", "mover,right", "--spacing", "gap=-1"})["contacts"], 1);
  EXPECT_EQ(Json({"--between", "left", "--and", "right,lid", "--and", "far"})["pairs"], 3);
  EXPECT_EQ(Json({"--within", "left,right", "--uncertainty", "6"})["undecided"], 1);
}

TEST_F(ClashCommand, AnIgnoredPairIsNotJudged) {
  std::string text = kLayout;
  Write(text.replace(text.find("authorised_contact"), 18, "ignore"));
  const nlohmann::json json = Json();
  EXPECT_EQ(json["pairs"], 14);
  EXPECT_EQ(json["ignored"], 1);
  EXPECT_EQ(json["contacts"], 1);
}

TEST_F(ClashCommand, MistakesAreOneLine) {
  ExpectFailure({"--within", "left,rigt"}, "no part is named 'rigt'; did you mean 'right'?");
  ExpectFailure({"--between", "left"}, "two sides");
  ExpectFailure({"--spacing", "gab=3"}, "did you mean 'gap'?");
  ExpectFailure({"--spacing", "gap=501"}, "goes from -50 to 500 mm");
  EXPECT_EQ(Run({"--spacing", "gap"}).exit_status, 2);
  EXPECT_EQ(Run({"--spacing", "gap=x"}).exit_status, 2);
  EXPECT_EQ(Run({"--required", "-1"}).exit_status, 2);
  Write("[[part]]\nname = \"a\"\nfile = \"none.stl\"\nunit = \"mm\"\n");
  ExpectFailure({}, "none.stl");
}

}  // namespace
}  // namespace elbowroom
