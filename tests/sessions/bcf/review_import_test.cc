#include "sessions/bcf/review_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace elbowroom::tests {
namespace {

using core::ReviewStatus;
using sessions::BcfTopic;
using sessions::RemarksFrom;
using sessions::ReviewImport;
using ::testing::HasSubstr;

core::Finding Finding() {
  core::Finding finding;
  finding.id = std::string(32, 'a');
  finding.remarks = {{"2024-03-02T10:00:00Z", "Ann", ReviewStatus::kActive, "look"}};
  return finding;
}

// As it was sent.
BcfTopic Topic() {
  const core::Finding finding = Finding();
  BcfTopic topic;
  topic.id = finding.id;
  topic.status = "Active";
  topic.created_at_utc = "2024-03-01T00:00:00Z";
  topic.created_by = "elbowroom";
  topic.modified_at_utc = finding.remarks[0].at_utc;
  topic.comments = {
      {core::RemarkId(finding.id, finding.remarks[0]), finding.remarks[0].at_utc, "Ann", "look"}};
  return topic;
}

ReviewImport Import(const BcfTopic& topic, const core::Finding& finding = Finding()) {
  return RemarksFrom(std::vector{topic}, std::vector{finding});
}

TEST(ReviewImport, TakesNothingFromWhatWasSent) {
  const ReviewImport import = Import(Topic());
  EXPECT_EQ(import.topics, 1);
  EXPECT_TRUE(import.remarks.empty());
  EXPECT_TRUE(import.notes.empty());
}

TEST(ReviewImport, TakesStatusesAndCommentsOnce) {
  BcfTopic topic = Topic();
  topic.status = "Resolved";
  topic.modified_at_utc = "2024-03-05T00:00:00Z";
  topic.modified_by = "Bo";
  topic.comments.push_back({std::string(32, 'f'), "2024-03-04T00:00:00Z", "Bo", "moved by 20 mm"});
  const ReviewImport import = Import(topic);
  ASSERT_EQ(import.remarks.size(), 2U);
  EXPECT_EQ(import.remarks[0].remark,
            (core::ReviewRemark{"2024-03-04T00:00:00Z", "Bo", {}, "moved by 20 mm", std::string(32, 'f')}));
  EXPECT_EQ(import.remarks[1].remark,
            (core::ReviewRemark{"2024-03-05T00:00:00Z", "Bo", ReviewStatus::kResolved, ""}));
  core::Finding after = Finding();
  for (const auto& said : import.remarks) after.remarks.push_back(said.remark);
  EXPECT_TRUE(Import(topic, after).remarks.empty()) << "the second time";
}

// The other program finds its own comment in what it is sent, and not a second one.
TEST(ReviewImport, ACommentKeepsItsId) {
  BcfTopic topic = Topic();
  topic.comments.push_back({std::string(32, 'f'), "2024-03-04T00:00:00Z", "Bo", "moved by 20 mm"});
  topic.comments.push_back({"no id", "2024-03-04T00:00:01Z", "Bo", "and 5 mm more"});
  const ReviewImport import = Import(topic);
  ASSERT_EQ(import.remarks.size(), 2U);
  EXPECT_EQ(core::RemarkId(Finding().id, import.remarks[0].remark), std::string(32, 'f'));
  EXPECT_TRUE(core::IsId(core::RemarkId(Finding().id, import.remarks[1].remark)));
}

TEST(ReviewImport, KnowsTheStatusesOfOtherPrograms) {
  for (const auto& [text, status] :
       {std::pair{"Closed", ReviewStatus::kResolved}, std::pair{"IN PROGRESS", ReviewStatus::kActive},
        std::pair{"approved", ReviewStatus::kApproved}}) {
    BcfTopic topic = Topic();
    topic.status = text;
    topic.modified_at_utc = "2024-03-05T00:00:00Z";
    const ReviewImport import = Import(topic);
    EXPECT_EQ(import.remarks.empty(), status == ReviewStatus::kActive) << text;
    for (const auto& said : import.remarks) EXPECT_EQ(said.remark.status, status);
  }
}

TEST(ReviewImport, LeavesWhatWasChangedHereLater) {
  BcfTopic topic = Topic();
  topic.status = "Resolved";
  topic.modified_at_utc = "2024-03-01T00:00:00Z";
  const ReviewImport import = Import(topic);
  EXPECT_TRUE(import.remarks.empty());
  ASSERT_EQ(import.notes.size(), 1U);
  EXPECT_THAT(import.notes[0], HasSubstr("later"));
}

TEST(ReviewImport, NotesAStatusThatItDoesNotKnow) {
  BcfTopic topic = Topic();
  topic.status = "Escalated";
  EXPECT_THAT(Import(topic).notes.at(0), HasSubstr("Escalated"));
}

TEST(ReviewImport, CountsTopicsOfOthers) {
  BcfTopic topic = Topic();
  topic.id = std::string(32, 'b');
  EXPECT_EQ(Import(topic).of_others, 1);
  EXPECT_EQ(Import(topic).topics, 0);
}

}  // namespace
}  // namespace elbowroom::tests
