// Streams that are closed, full or broken, and files beyond the limit: one line and exit status 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramRun;

// The program with `words`, as a shell starts it with these redirections or limits around "$@".
ProgramRun InShell(const std::string& script, std::vector<std::string> words) {
  words.insert(words.begin(), {"-c", script, "sh", test_support::ProgramFile().string()});
  return test_support::RunProgram("/bin/sh", words);
}

void ExpectOneLine(const ProgramRun& run, const std::string& word) {
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_LE(run.err.size(), 300U);
  EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
}

class StandardStreams : public testing::Test {
 protected:
  void SetUp() override {
    test_support::WriteBallRig(folder_.path());
    test_support::WriteBoxStl(folder_ / "box.stl", 80.0);
    test_support::WriteText(folder_ / "layout.toml",
                            "unit = \"mm\"\n[[part]]\nname = \"box\"\nfile = \"box.stl\"\n");
    test_support::WriteText(folder_ / "trial.toml", "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n");
  }
  [[nodiscard]] std::vector<std::string> TrialInto(const fs::path& session) const {
    return {"trial", "run", (folder_ / "trial.toml").string(), "--session", session.string(), "--headless"};
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(StandardStreams, AClosedOrFullStdoutIsOneLineAndTheSessionStays) {
  const std::vector<std::pair<std::string, std::string>> ways = {
      {"exec \"$@\" >&-", "standard output"},
      {"exec \"$@\" >/dev/full", "standard output"},
      {"\"$@\" 3>&1 1>&- <&-", "standard output"}};
  for (std::size_t i = 0; i < ways.size(); ++i) {
    SCOPED_TRACE(ways[i].first);
    const fs::path session = folder_ / ("s" + std::to_string(i) + ".db");
    ExpectOneLine(InShell(ways[i].first, TrialInto(session)), ways[i].second);
    EXPECT_TRUE(test_support::ReadText(session).starts_with("SQLite format 3")) << "nothing printed into it";
    const ProgramRun report =
        InShell("exec \"$@\"", {"report", session.string(), "--out", (folder_ / "report").string()});
    EXPECT_EQ(report.exit_status, 0) << report.err;
  }
  ExpectOneLine(InShell("exec \"$@\" >&-", {"--help"}), "standard output");
  ExpectOneLine(InShell("exec \"$@\" >/dev/full", {"--version"}), "standard output");
}

TEST_F(StandardStreams, ABrokenPipeIsOneLine) {
  // A pipe whose only reader closes it before the program starts.
  const std::string pipe = (folder_ / "pipe").string();
  const ProgramRun run =
      InShell("mkfifo " + pipe + "; exec 4<>" + pipe + " 5>" + pipe + " 4<&-; exec \"$@\" >&5",
              {"layout", "show", (folder_ / "layout.toml").string()});
  ExpectOneLine(run, "standard output");
}

TEST_F(StandardStreams, AllClosedIsStillAnEndInOrder) {
  const fs::path session = folder_ / "s.db";
  const ProgramRun run = InShell("exec \"$@\" <&- >&- 2>&-", TrialInto(session));
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_TRUE(test_support::ReadText(session).starts_with("SQLite format 3"));
  EXPECT_EQ(InShell("exec \"$@\" 2>&-", {"layout", "show", "none.toml"}).exit_status, 1);
  EXPECT_EQ(InShell("exec \"$@\" 2>/dev/full", {"layout", "show", "none.toml"}).exit_status, 1);
}

TEST_F(StandardStreams, AFileBeyondTheLimitIsOneLineAndLeavesNothing) {
  const fs::path out = folder_ / "out";
  fs::create_directory(out);
  ExpectOneLine(
      InShell("ulimit -f 0; exec \"$@\"", {"layout", "new", (out / "new.toml").string(), "--unit", "in"}),
      "new.toml");
  ExpectOneLine(InShell("ulimit -f 8; exec \"$@\"", {"hull", (folder_ / "rig.yml").string(), "--frame", "0",
                                                     "--edge", "5", "--out", (out / "hull.ply").string()}),
                "ulimit -f");
  EXPECT_TRUE(fs::is_empty(out));
  const ProgramRun trial = InShell("ulimit -f 8; exec \"$@\"", TrialInto(folder_ / "limited.db"));
  EXPECT_EQ(trial.exit_status, 1);
  EXPECT_EQ(std::ranges::count(trial.err, '\n'), 1) << trial.err;
  const fs::path session = folder_ / "whole.db";
  ASSERT_EQ(InShell("exec \"$@\"", TrialInto(session)).exit_status, 0);
  ExpectOneLine(InShell("ulimit -f 8; exec \"$@\"", {"report", session.string(), "--out", out.string()}),
                "ulimit -f");
}

TEST_F(StandardStreams, AMessageIsOneLineOfAtMost300Characters) {
  const std::string folder(250, 'd'), odd = "line\nbreak\x1b[2J\xFF\xE2\x80\xA8";
  const ProgramRun run = InShell("exec \"$@\"", {"layout", "show", "/" + folder + "/" + folder + "/" + odd});
  ExpectOneLine(run, R"(line\x0abreak\x1b[2J\xff\xe2\x80\xa8: no such layout file; check the path)");
  const ProgramRun usage = InShell("exec \"$@\"", {"layout", "show", "a", "b\nc" + std::string(4000, 'x')});
  EXPECT_EQ(usage.exit_status, 2);
  EXPECT_EQ(std::ranges::count(usage.err, '\n'), 1) << usage.err;
  EXPECT_LE(usage.err.size(), 300U);
}

}  // namespace
}  // namespace elbowroom
