#include "tests/support/run_program.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <system_error>

#include "tests/support/temporary_folder.h"

namespace elbowroom::test_support {
namespace {

ProgramRun Shell(const std::string& script, const RunOptions& options = {}) {
  return RunProgram("/bin/sh", {"-c", script}, options);
}

TEST(RunProgram, KeepsBothStreamsAndTheStatus) {
  const ProgramRun run = Shell("echo to out; echo to err >&2; exit 3");
  EXPECT_EQ(run.exit_status, 3);
  EXPECT_EQ(run.out, "to out\n");
  EXPECT_EQ(run.err, "to err\n");
}

TEST(RunProgram, PassesArgumentsAsTheyAre) {
  const ProgramRun run = RunProgram("/bin/echo", {"two words", "$HOME", ""});
  EXPECT_EQ(run.out, "two words $HOME \n");
}

TEST(RunProgram, OutlastsPipesThatFill) {
  constexpr std::size_t kBytes = 1'000'000;  // more than a pipe holds, on both streams at once
  const ProgramRun run = Shell("head -c 1000000 /dev/zero >&2; head -c 1000000 /dev/zero");
  EXPECT_EQ(run.out.size(), kBytes);
  EXPECT_EQ(run.err.size(), kBytes);
}

TEST(RunProgram, StandardInputIsEmpty) { EXPECT_EQ(Shell("cat; echo end").out, "end\n"); }

TEST(RunProgram, ASignalShowsInTheStatus) { EXPECT_EQ(Shell("kill -KILL $$").exit_status, 128 + 9); }

TEST(RunProgram, SetsFolderAndEnvironment) {
  const TemporaryFolder folder;
  const ProgramRun run =
      Shell("pwd -P; echo $ELBOWROOM_TEST_WORD",
            {.working_folder = folder.path(), .environment = {{"ELBOWROOM_TEST_WORD", "roomy"}}});
  EXPECT_EQ(run.out, std::filesystem::canonical(folder.path()).string() + "\nroomy\n");
}

TEST(RunProgram, AMissingProgramIsAnErrorWithItsName) {
  try {
    (void)RunProgram("/nowhere/elbowroom", {});
    FAIL() << "started";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::no_such_file_or_directory);
    EXPECT_NE(std::string(error.what()).find("/nowhere/elbowroom"), std::string::npos);
  }
}

TEST(RunProgram, ATimeoutEndsChildrenToo) {
  EXPECT_THROW((void)Shell("sleep 600 & sleep 600", {.timeout_s = 0.2}), std::runtime_error);
}

}  // namespace
}  // namespace elbowroom::test_support
