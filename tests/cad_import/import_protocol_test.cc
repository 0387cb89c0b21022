#include "cad_import/import_protocol.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace elbowroom::cad_import {
namespace {

ImportMessage Back(std::string line) {
  EXPECT_EQ(line.back(), '\n');
  line.pop_back();
  EXPECT_EQ(line.find('\n'), std::string::npos);
  return ParseMessage(line);
}

TEST(ImportProtocol, EveryMessageComesBack) {
  const auto progress = std::get<ProgressMessage>(Back(ToLine(ProgressMessage{3, -1, "meshing part"})));
  EXPECT_EQ(progress.done, 3);
  EXPECT_EQ(progress.total, -1);
  EXPECT_EQ(progress.what, "meshing part");
  const auto failure =
      std::get<FailureMessage>(Back(ToLine(FailureMessage{core::ErrorKind::kGeometry, "a\nb\x1b[2J"})));
  EXPECT_EQ(failure.kind, core::ErrorKind::kGeometry);
  EXPECT_EQ(failure.what, "a b [2J");
  EXPECT_TRUE(std::holds_alternative<DoneMessage>(Back(ToLine(DoneMessage{}))));
  EXPECT_TRUE(std::holds_alternative<OutOfMemoryMessage>(Back(std::string(kOutOfMemoryLine))));
}

TEST(ImportProtocol, ALongTextIsCutToALine) {
  const std::string line = ToLine(FailureMessage{core::ErrorKind::kCad, std::string(1'000'000, 'x')});
  EXPECT_LE(line.size(), kLongestMessageBytes);
  EXPECT_TRUE(std::holds_alternative<FailureMessage>(Back(line)));
}

TEST(ImportProtocol, AnythingElseIsNoMessage) {
  for (const char* line : {"", "P", "P1", "P1 ", "P1 2", "E", "E99 x", "E-1 x", "E1", "D ", "Mx",
                           "warning: something", "P9999999999999999999 1 x"})
    EXPECT_TRUE(std::holds_alternative<NoMessage>(ParseMessage(line))) << line;
  std::mt19937 random(77);
  for (int i = 0; i < 20'000; ++i) {
    std::string line(random() % 40, ' ');
    for (char& letter : line)
      letter = static_cast<char>(random() % 2 == 0 ? random() : "PEDM 019-"[random() % 9]);
    (void)ParseMessage(line);
  }
}

}  // namespace
}  // namespace elbowroom::cad_import
