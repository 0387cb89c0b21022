// Recorded motion against other revisions of the CAD: the answers of replays, and only what changed is asked.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/control/demo_parts.h"
#include "core/triangle_mesh.h"
#include "sessions/session_reader.h"
#include "tests/app/sweep/swept_sessions.h"
#include "tests/support/documents/page_in_browser.h"
#include "tests/support/documents/read_pdf.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kRange = "payload_a_gap=140:240:20";

class SweepRevisions : public testing::Test {
 protected:
  void SetUp() override {
    for (const core::FrameIndex first : {20, 23}) {
      sessions_.push_back(folder_ / ("s" + std::to_string(first) + ".db"));
      RecordTaskFrames(sessions_.back(), first, "P" + std::to_string(first));
    }
    // Payload A with its underside 30 mm lower.
    core::TriangleMesh mesh = *control::DemoLayout().parts[1].mesh;
    const double bottom_mm = core::BoundsOf(mesh).min().z();
    for (Eigen::Vector3d& x : mesh.vertices_mm)
      if (x.z() < bottom_mm + 1e-6) x.z() -= 30.0;
    WriteStl(mesh, folder_ / "deeper.stl");
  }
  [[nodiscard]] std::string Deeper() const {
    return "C:payload_a=" + (folder_ / "deeper.stl").string() + ":mm";
  }
  nlohmann::json Sweep(const fs::path& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = more;
    arguments.emplace_back("--json");
    const auto run = RunSweep(sessions_, kRange, out, arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }

  test_support::TemporaryFolder folder_;
  std::vector<fs::path> sessions_;
};

TEST_F(SweepRevisions, AreWhatReplaysWithThatPartSay) {
  const nlohmann::json sweep = Sweep(folder_ / "out", {"--revision", Deeper()});
  ASSERT_EQ(sweep["revisions"].size(), 1U);
  const nlohmann::json& revision = sweep["revisions"][0];
  EXPECT_EQ(revision["revision"], "C");
  EXPECT_EQ(revision["changed"], nlohmann::json::array({"payload_a"}));
  const std::string csv = test_support::ReadText(folder_ / "out/revisions.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 2 * 6) << csv;
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    for (const std::size_t step : {0U, 3U}) {
      const std::string gap = std::to_string(140 + 20 * step);
      const fs::path replayed = folder_ / ("r" + std::to_string(i) + gap + ".db");
      const auto run = test_support::RunProgram(
          test_support::ProgramFile(),
          {"replay", sessions_[i].string(), "--session", replayed.string(), "--part",
           "payload_a=" + (folder_ / "deeper.stl").string() + ":mm", "--spacing", "payload_a_gap=" + gap});
      ASSERT_EQ(run.exit_status, 0) << run.err;
      const sessions::SessionReader reader(replayed);
      std::int64_t touched = 0;
      double deepest_mm = 0.0;
      for (const sessions::FrameSummary& frame : reader.frames()) {
        const core::PartContact& contact = reader.ReadFrame(frame.frame).contacts[1];
        touched += contact.verdict == core::Verdict::kContact ? 1 : 0;
        if (contact.deepest) deepest_mm = std::max(deepest_mm, contact.deepest->depth_mm);
      }
      EXPECT_EQ(revision["sessions"][i]["frames_in_contact"][step], touched);
      EXPECT_EQ(revision["sessions"][i]["deepest_mm"][step], deepest_mm);
    }
  }
}

TEST_F(SweepRevisions, OnlyWhatChangedIsAsked) {
  const nlohmann::json before = Sweep(folder_ / "out", {});
  EXPECT_EQ(before["cells"], 2 * 3) << "sessions, parts";
  const nlohmann::json after = Sweep(folder_ / "out", {"--revision", Deeper()});
  EXPECT_EQ(after["cells"], 2 * 4);
  EXPECT_EQ(after["cells_from_before"], 2 * 3);
  for (const char* key : {"steps", "smallest_free_mm", "largest_touched_mm"})
    EXPECT_EQ(after[key], before[key]);
  const nlohmann::json again = Sweep(folder_ / "out", {"--revision", Deeper()});
  EXPECT_EQ(again["cells_from_before"], again["cells"]);
  EXPECT_EQ(again["hulls"], 0);
  EXPECT_EQ(again["revisions"], after["revisions"]);
}

TEST_F(SweepRevisions, TheSamePartAgainChangesNothing) {
  const fs::path same = folder_ / "same.stl";
  WriteStl(*control::DemoLayout().parts[2].mesh, same);
  const nlohmann::json sweep = Sweep(
      folder_ / "out", {"--revision", "same:payload_b=" + same.string() + ":mm", "--revision", Deeper()});
  ASSERT_EQ(sweep["revisions"].size(), 2U);
  EXPECT_EQ(sweep["revisions"][0]["touching"], sweep["revisions"][0]["touching_before"]);
  EXPECT_EQ(sweep["revisions"][1]["revision"], "C");
}

TEST_F(SweepRevisions, GnuParallelGivesTheSameFiles) {
  if (!fs::exists("/usr/bin/parallel")) GTEST_SKIP() << "NOT TESTED: GNU parallel is not installed";
  Sweep(folder_ / "local", {"--revision", Deeper()});
  Sweep(folder_ / "parallel", {"--revision", Deeper(), "--engine", "parallel"});
  ExpectSameSweep(folder_ / "local", folder_ / "parallel");
  for (const char* file : {"revisions.csv", "revisions.html", "revisions.pdf"})
    EXPECT_TRUE(test_support::ReadText(folder_ / "local" / file) ==
                test_support::ReadText(folder_ / "parallel" / file))
        << file;
  EXPECT_EQ(CellFiles(folder_ / "local"), CellFiles(folder_ / "parallel"));
}

TEST_F(SweepRevisions, TheReportSaysWhichMotionsTouch) {
  const nlohmann::json sweep = Sweep(folder_ / "out", {"--revision", Deeper()});
  if (HasPdfReaders()) {
    ExpectGoodPdf(folder_ / "out/revisions.pdf");
    const std::string text = Squeezed(TextOf(folder_ / "out/revisions.pdf"));
    for (const char* word : {"RevisionC:", "of2recordedmotionstouch", "payload_a", "s20.db", "deeper.stl"})
      EXPECT_THAT(text, HasSubstr(word));
  }
  // Each motion's gaps are those of the table of all figures.
  const std::string page = test_support::ReadText(folder_ / "out/revisions.html");
  EXPECT_THAT(page, HasSubstr("Touches at the gaps, mm"));
  for (const auto& session : sweep["revisions"][0]["sessions"]) {
    const std::vector<std::int64_t> frames = session["frames_in_contact"];
    const auto is_touched = [](std::int64_t count) { return count > 0; };
    const auto end = std::ranges::find_if_not(frames, is_touched) - frames.begin();
    ASSERT_TRUE(end >= 2 && std::none_of(frames.begin() + end, frames.end(), is_touched)) << session.dump();
    EXPECT_THAT(page, HasSubstr(fmt::format(">140 to {}<", 140 + 20 * (end - 1))));
  }
  EXPECT_THAT(page, HasSubstr("its shape is that of"));
  if (!HasBrowser()) GTEST_SKIP() << "NOT TESTED: no /usr/bin/chromium";
  ExpectPageWorks(folder_ / "out/revisions.html", folder_ / "shots");
}

TEST_F(SweepRevisions, WhatIsWrongIsOneLine) {
  for (const auto& [setting, word] :
       {std::pair{"C:payload_x=" + (folder_ / "deeper.stl").string() + ":mm", "payload_"},
        std::pair{"C:payload_a=" + (folder_ / "nowhere.stl").string(), "nowhere.stl"},
        std::pair{"C:payload_x=" + (folder_ / "deeper.stl").string() + ":mm",
                  ".db', revision 'C': no part"},
        std::pair{"C:payload_a=" + (folder_ / "deeper.stl").string(), "FILE:mm"},
        std::pair{"C=" + (folder_ / "nowhere.toml").string(), "nowhere.toml"}}) {
    const auto run = RunSweep(sessions_, kRange, folder_ / "out", {"--revision", setting});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr(word));
  }
  EXPECT_NE(RunSweep(sessions_, kRange, folder_ / "out", {"--revision", "C"}).exit_status, 0);
  const auto twice =
      RunSweep(sessions_, kRange, folder_ / "out", {"--revision", Deeper(), "--revision", Deeper()});
  EXPECT_EQ(twice.exit_status, 1);
  EXPECT_THAT(twice.err, HasSubstr("'C' has two files for the part 'payload_a'"));
}

// Flips a bit in the middle of each file below the folder; how many there are.
int DamageFilesIn(const fs::path& folder) {
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::string bytes = test_support::ReadText(entry.path());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    std::ofstream(entry.path(), std::ios::binary) << bytes;
    ++files;
  }
  return files;
}

TEST_F(SweepRevisions, AreJudgedAgainstHullsThatWereKept) {
  const nlohmann::json first = Sweep(folder_ / "out", {"--keep-hulls"});
  EXPECT_GT(first["hulls"], 0);
  const auto expect_fresh = [&](const nlohmann::json& sweep) {
    const nlohmann::json fresh = Sweep(folder_ / "fresh", {"--revision", Deeper()});
    EXPECT_EQ(fresh["hulls_kept"], 0);
    for (const char* key : {"all", "sessions", "revisions", "asked", "queries"})
      EXPECT_EQ(sweep[key], fresh[key]) << key;
    ExpectSameSweep(folder_ / "out", folder_ / "fresh");
  };
  const nlohmann::json changed = Sweep(folder_ / "out", {"--keep-hulls", "--revision", Deeper()});
  EXPECT_EQ(changed["hulls"], 0);
  EXPECT_EQ(changed["hulls_kept"], first["hulls"].get<int>() + first["hulls_kept"].get<int>());
  EXPECT_GT(changed["cells"], changed["cells_from_before"]);
  expect_fresh(changed);
  // Damaged ones are made again.
  EXPECT_EQ(DamageFilesIn(folder_ / "out/hulls"), 2) << "a file for each session";
  fs::remove_all(folder_ / "out/cells");
  const nlohmann::json damaged = Sweep(folder_ / "out", {"--keep-hulls", "--revision", Deeper()});
  EXPECT_GT(damaged["hulls"], 0);
  EXPECT_GT(damaged["hulls_kept"], 0);
  expect_fresh(damaged);
}

}  // namespace
}  // namespace elbowroom::tests
