#include "core/system/child_process.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <span>
#include <stop_token>
#include <string>

#include "core/error.h"
#include "core/system/module.h"

namespace elbowroom::core {
namespace {

using Clock = std::chrono::steady_clock;

ChildProgram Shell(const std::string& script, std::vector<const Descriptor*> gives = {}) {
  return {.program = "/bin/sh", .arguments = {"sh", "-c", script}, .gives = std::move(gives)};
}

std::string ReadFrom(const Descriptor& descriptor) {
  std::array<char, 100> buffer{};
  const ssize_t size = ::read(descriptor.number(), buffer.data(), buffer.size());
  return {buffer.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
}

TEST(Child, HasWhatItIsGivenInOrderAndNothingElse) {
  Pipe one = MakePipe(), other = MakePipe(), kept = MakePipe();
  const std::string script = "printf one >&3; printf other >&4; ls /proc/self/fd | tr '\\n' ' ' >&3";
  Child child(Shell(script, {&one.to, &other.to}));
  one.to.Close();
  EXPECT_EQ(child.Wait(), 0);
  EXPECT_EQ(ReadFrom(one.from), "one0 1 2 3 4 5 ");  // 5: the folder that `ls` reads
  EXPECT_EQ(ReadFrom(other.from), "other");
}

TEST(Child, IsKilledWithItsObject) {
  Pipe pipe = MakePipe();
  {
    Child child(Shell("echo there >&3; exec sleep 1000", {&pipe.to}));
    pipe.to.Close();
    ASSERT_EQ(WaitToRead(pipe.from, {}, std::nullopt), Woken::kReady);
    EXPECT_EQ(ReadFrom(pipe.from), "there\n");
    EXPECT_FALSE(child.Status().has_value());
  }
  EXPECT_EQ(ReadFrom(pipe.from), "");  // closed: nobody holds its other end
}

TEST(Child, SaysHowItEnded) {
  EXPECT_EQ(TextOfEnd(Child(Shell("exit 3")).Wait()), "ended (status 3)");
  EXPECT_EQ(TextOfEnd(Child(Shell("kill -SEGV $$")).Wait()), "crashed (SEGV)");
  EXPECT_EQ(TextOfEnd(Child(Shell("kill -KILL $$")).Wait()), "was stopped from outside");
}

TEST(Child, ThatCanNotBeStartedIsAnError) {
  try {
    const Child child({.program = "/nowhere/at/all", .arguments = {"x"}});
    ADD_FAILURE() << "it was started";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all"), std::string::npos) << error.what();
  }
}

TEST(WaitToRead, IsWokenByAStopAndByItsDeadline) {
  const Pipe silent = MakePipe();
  std::stop_source stop;
  EXPECT_EQ(WaitToRead(silent.from, stop.get_token(), Clock::now()), Woken::kTooLate);
  stop.request_stop();
  EXPECT_EQ(WaitToRead(silent.from, stop.get_token(), std::nullopt), Woken::kStopped);
}

TEST(PrintableLine, IsOneLineOfNoMore) {
  EXPECT_EQ(PrintableLine("a\nb\tc\x7f"
                          "d",
                          100),
            "a b c d");
  EXPECT_EQ(PrintableLine("abcdef", 3), "abc");
}

TEST(FindProgramBeside, FindsTheDecoderAndNamesWhatIsMissing) {
  EXPECT_EQ(::access(FindProgramBeside("decoder").c_str(), X_OK), 0);
  try {
    (void)FindProgramBeside("nothing");
    ADD_FAILURE() << "it was found";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("elbowroom_nothing-"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace elbowroom::core
