#include "core/findings/finding_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace elbowroom::core {
namespace {

std::vector<Finding> Sample() {
  std::vector<Finding> findings(4);
  findings[0].id = "0123" + std::string(28, 'a');
  findings[0].number = 1;
  findings[1].id = "0123" + std::string(28, 'b');
  findings[1].number = 4567;
  findings[2].id = "4567" + std::string(28, 'c');
  findings[2].kind = FindingKind::kNearMiss;
  findings[2].number = 1;
  findings[3].id = "ffff" + std::string(28, 'd');
  findings[3].presence = FindingPresence::kGone;
  return findings;
}

TEST(FindingNames, FindsByIdItsBeginningNumberAndName) {
  const std::vector<Finding> findings = Sample();
  EXPECT_EQ(&FindFinding(findings, findings[1].id), &findings[1]);
  EXPECT_EQ(&FindFinding(findings, "0123b"), &findings[1]);
  EXPECT_EQ(&FindFinding(findings, "1"), &findings[0]);
  EXPECT_EQ(&FindFinding(findings, "touch 1"), &findings[0]);
  EXPECT_EQ(&FindFinding(findings, "near miss 1"), &findings[2]);
  EXPECT_EQ(&FindFinding(findings, "ffff"), &findings[3]);
}

TEST(FindingNames, RefusesWhatNamesNoneOrSeveral) {
  const std::vector<Finding> findings = Sample();
  const auto told = [&](const char* text) -> std::string {
    try {
      (void)FindFinding(findings, text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kRange);
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(told("0123"), testing::HasSubstr("names 2"));
  EXPECT_THAT(told("4567"), testing::HasSubstr("names 2")) << "a touch's number, and the beginning of an id";
  EXPECT_THAT(told("fff"), testing::HasSubstr("no touch")) << "too short";
  EXPECT_THAT(told("0"), testing::HasSubstr("no touch")) << "the number of what isn't here";
  EXPECT_THAT(told(""), testing::HasSubstr("no touch"));
}

}  // namespace
}  // namespace elbowroom::core
