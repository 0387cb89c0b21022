// Many simulated participants' sessions against two revisions of the CAD at eight gaps: every engine gives
// the same bytes, also while half of its processes are killed. Three sessions, and 200 by `./dev soak`.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>  // NOLINT: kill

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <thread>

#include "app/control/demo_parts.h"
#include "app/control/sweep/sweep_cells.h"
#include "core/triangle_mesh.h"
#include "tests/app/sweep/killed_workers.h"
#include "tests/app/sweep/one_node_slurm.h"
#include "tests/app/sweep/swept_sessions.h"
#include "tests/support/places.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr const char* kEightGaps = "payload_a_gap=120:400:40";
constexpr std::size_t kGaps = 8, kParts = 3, kRevisions = 2;
constexpr unsigned kSeed = 26;        // any
constexpr double kToleranceMm = 0.5;  // review::SpacingStudyOptions::tolerance_mm
constexpr double kTimeoutS = 4.0 * 3600.0;

std::size_t CountOfSessions() {
  const auto scale = static_cast<std::size_t>(test_support::SoakScale());
  return scale == 1 ? 3 : 10 * scale;
}

// How often each key of a cell is in the store, whatever file it is in.
std::map<control::CellKey, int> KeptCells(const fs::path& out) {
  std::map<control::CellKey, int> kept;
  for (const std::string& file : CellFiles(out)) {
    const auto cells = control::ParseSweepCells(test_support::ReadText(control::CellsIn(out) / file));
    EXPECT_TRUE(cells.has_value()) << file;
    if (!cells) continue;
    for (const auto& [key, cell] : *cells) ++kept[key];
  }
  return kept;
}

class SweepOfMany : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test_support::TemporaryFolder>();
    Simulate();
    WritePayload("wider.stl", 1.3);
    WritePayload("narrower.stl", 0.7);
    const auto begin = std::chrono::steady_clock::now();
    serial_ = Sweep("serial", {"--threads", "1"});
    a_session_ = std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - begin) /
                 static_cast<int>(sessions_.size());
  }
  static void TearDownTestSuite() { folder_.reset(); }

  // Each participant has a hand, a pace, a cable and a way of reaching in of their own.
  static void Simulate() {
    test_support::RunOptions options;
    options.timeout_s = kTimeoutS;
    const auto run = test_support::RunProgram(
        test_support::ProgramFile(),
        {"simulate", "--participants", std::to_string(CountOfSessions()), "--seed", std::to_string(kSeed),
         "--seconds", "3", "--rate", "5", "--out", (*folder_ / "cohort").string(), "--json"},
        options);
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto said = nlohmann::json::parse(run.out);
    for (const nlohmann::json& trial : said["trials"]) {
      sessions_.emplace_back(trial["session"].get<std::string>());
      frames_.push_back(trial["frames"].get<int>());
    }
    ASSERT_EQ(sessions_.size(), CountOfSessions());
  }
  // Payload A, so many times as wide.
  static void WritePayload(const char* file, double times_as_wide) {
    core::TriangleMesh mesh = *control::DemoLayout().parts[1].mesh;
    for (Eigen::Vector3d& x : mesh.vertices_mm) x.head<2>() *= times_as_wide;
    WriteStl(mesh, *folder_ / file);
  }
  [[nodiscard]] static fs::path Out(const std::string& name) { return *folder_ / name; }
  [[nodiscard]] static std::vector<std::string> Arguments(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = more;
    for (const char* revision : {"B:payload_a=wider.stl", "C:payload_a=narrower.stl"}) {
      const std::string text = revision;
      const std::size_t file = text.find('=') + 1;
      arguments.insert(
          arguments.end(),
          {"--revision", text.substr(0, file) + (*folder_ / text.substr(file).c_str()).string() + ":mm"});
    }
    arguments.emplace_back("--json");
    return arguments;
  }
  static nlohmann::json Sweep(const std::string& out, const std::vector<std::string>& more,
                              test_support::RunOptions options = {}) {
    options.timeout_s = kTimeoutS;
    const auto run = RunSweep(sessions_, kEightGaps, Out(out), Arguments(more), options);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }
  // A half of the sessions, each with a moment of the time that one takes.
  static FirstAttemptsKilled::Delays RandomHalf(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<fs::path> shuffled = sessions_;
    std::ranges::shuffle(shuffled, random);
    FirstAttemptsKilled::Delays delays;
    for (std::size_t i = 0; i < (shuffled.size() + 1) / 2; ++i)
      delays[shuffled[i]] =
          milliseconds(std::uniform_int_distribution<long>(0, a_session_.count() / 2)(random));
    return delays;
  }
  // The store has each cell once, and all files have the bytes of the serial sweep's.
  static void ExpectNothingLostOrDoubled(const std::string& out, const nlohmann::json& sweep) {
    ASSERT_FALSE(sweep.is_null());
    ASSERT_FALSE(serial_.is_null());
    EXPECT_EQ(sweep["cells"], sessions_.size() * (kParts + kRevisions))
        << "a part in a session, a revision's";
    EXPECT_EQ(sweep["cells_from_before"], 0);
    const auto kept = KeptCells(Out(out)), of_serial = KeptCells(Out("serial"));
    EXPECT_EQ(kept.size(), sessions_.size() * (kParts + kRevisions)) << "lost";
    for (const auto& [key, count] : kept) EXPECT_EQ(count, 1) << "doubled: " << key;
    EXPECT_EQ(kept, of_serial);
    EXPECT_EQ(CellFiles(Out(out)), CellFiles(Out("serial"))) << "their names are hashes of their bytes";
    ExpectSameSweep(Out(out), Out("serial"));
    for (const char* file : {"revisions.csv", "revisions.html", "revisions.pdf"})
      EXPECT_TRUE(test_support::ReadText(Out(out) / file) == test_support::ReadText(Out("serial") / file))
          << file;
    for (const char* key : {"all", "sessions", "revisions", "frames_without_camera", "asked", "queries"})
      EXPECT_TRUE(sweep[key] == serial_[key]) << key;
  }

  static std::unique_ptr<test_support::TemporaryFolder> folder_;
  static std::vector<fs::path> sessions_;
  static std::vector<int> frames_;  // of each
  static nlohmann::json serial_;
  static milliseconds a_session_;
};
std::unique_ptr<test_support::TemporaryFolder> SweepOfMany::folder_;
std::vector<fs::path> SweepOfMany::sessions_;
std::vector<int> SweepOfMany::frames_;
nlohmann::json SweepOfMany::serial_;
milliseconds SweepOfMany::a_session_;

TEST_F(SweepOfMany, HasEachMotionAtEachGapAgainstEachRevision) {
  ASSERT_FALSE(serial_.is_null());
  EXPECT_EQ(serial_["sessions"].size(), sessions_.size());
  EXPECT_EQ(serial_["steps"].size(), kGaps);
  ASSERT_EQ(serial_["revisions"].size(), kRevisions);
  for (std::size_t i = 0; i < sessions_.size(); ++i)
    EXPECT_EQ(serial_["sessions"][i]["frames"], frames_[i]) << sessions_[i];
  // Below what is wider more of the motion counts.
  const double recorded_mm = serial_["smallest_free_mm"],
               wider_mm = serial_["revisions"][0]["smallest_free_mm"],
               narrower_mm = serial_["revisions"][1]["smallest_free_mm"];
  EXPECT_LE(narrower_mm, recorded_mm + kToleranceMm);
  EXPECT_LE(recorded_mm, wider_mm + kToleranceMm);
  EXPECT_NE(serial_["revisions"][0]["sessions"], serial_["revisions"][1]["sessions"]);
}

TEST_F(SweepOfMany, IsTheSameByALocalPool) {
  ExpectNothingLostOrDoubled("local", Sweep("local", {"--threads", "2"}));
}

TEST_F(SweepOfMany, IsTheSameByALocalPoolThatIsKilledAgainAndAgain) {
  std::mt19937 random(kSeed);
  const auto whole = a_session_ * static_cast<int>(sessions_.size());
  for (int kill = 0; kill < 3; ++kill) {
    const milliseconds delay(std::uniform_int_distribution<long>(0, whole.count() / 4)(random));
    test_support::RunOptions options;
    options.while_running = [&](int process) {
      std::this_thread::sleep_for(delay);
      ::kill(process, SIGKILL);
    };
    EXPECT_EQ(
        RunSweep(sessions_, kEightGaps, Out("ended"), Arguments({"--threads", "2"}), options).exit_status,
        128 + SIGKILL);
  }
  nlohmann::json sweep = Sweep("ended", {"--threads", "2"});
  sweep["cells_from_before"] = 0;  // what the killed ones kept
  ExpectNothingLostOrDoubled("ended", sweep);
}

TEST_F(SweepOfMany, IsTheSameByGnuParallelWithHalfOfItsProcessesKilled) {
  if (!fs::exists("/usr/bin/parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  const auto half = RandomHalf(kSeed + 1);
  FirstAttemptsKilled killer(Out("parallel"), half);
  const nlohmann::json sweep = Sweep("parallel", {"--engine", "parallel", "--threads", "2"});
  EXPECT_EQ(killer.Kills(), half.size());
  ExpectNothingLostOrDoubled("parallel", sweep);
}

TEST_F(SweepOfMany, IsTheSameBySlurmWithHalfOfItsProcessesKilled) {
  std::string why_not;
  const auto slurm = OneNodeSlurm::Start(*folder_ / "cluster", 2, &why_not);
  if (!slurm) GTEST_SKIP() << "NOT TESTED: " << why_not;
  test_support::RunOptions here;
  here.environment = slurm->Environment();
  const auto half = RandomHalf(kSeed + 2);
  FirstAttemptsKilled killer(Out("slurm"), half);
  const nlohmann::json sweep = Sweep("slurm", {"--engine", "slurm", "--threads", "1"}, here);
  EXPECT_EQ(killer.Kills(), half.size());
  ExpectNothingLostOrDoubled("slurm", sweep);
  EXPECT_EQ(slurm->Queue(), "");
}

TEST_F(SweepOfMany, ChangedCadNeedsNoHullAgain) {
  const nlohmann::json first = Sweep("hulls", {"--threads", "2", "--keep-hulls"});
  EXPECT_GT(first["hulls"], 0);
  ExpectNothingLostOrDoubled("hulls", first);
  WritePayload("changed.stl", 1.1);
  const std::vector<std::string> changed{"--revision",
                                         "D:payload_a=" + (*folder_ / "changed.stl").string() + ":mm"};
  std::vector<std::string> with_hulls = changed;
  with_hulls.insert(with_hulls.end(), {"--threads", "2", "--keep-hulls"});
  const nlohmann::json again = Sweep("hulls", with_hulls), fresh = Sweep("fresh", changed);
  EXPECT_EQ(again["hulls"], 0);
  EXPECT_GT(again["hulls_kept"], 0);
  EXPECT_EQ(again["cells"].get<std::size_t>() - again["cells_from_before"].get<std::size_t>(),
            sessions_.size())
      << "the changed part's";
  EXPECT_GT(fresh["hulls"], 0);
  for (const char* key : {"all", "sessions", "revisions", "asked", "queries"})
    EXPECT_TRUE(again[key] == fresh[key]) << key;
  for (const char* file : {"sweep.csv", "revisions.csv", "revisions.html"})
    EXPECT_TRUE(test_support::ReadText(Out("hulls") / file) == test_support::ReadText(Out("fresh") / file))
        << file;
}

}  // namespace
}  // namespace elbowroom::tests
