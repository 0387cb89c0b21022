#include "sessions/report/report_topics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/bcf/bcf_file.h"
#include "sessions/bcf/review_import.h"
#include "sessions/review_editor.h"
#include "tests/sessions/bcf/zip_entries.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using sessions::BcfTopic;
using sessions::SessionReader;

TEST(ReportTopics, HaveAnEntryForEachFindingUnderItsId) {
  const test_support::TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 7);
  const SessionReader session(folder / "s.db");
  const auto topics = sessions::TopicsOf(session, sessions::TouchesOf(session), {});
  const auto findings = session.findings();
  ASSERT_EQ(topics.size(), findings.size());
  for (const core::Finding& finding : findings) {
    const auto topic = std::ranges::find(topics, finding.id, &BcfTopic::id);
    ASSERT_NE(topic, topics.end());
    EXPECT_EQ(topic->components.front(), finding.part);
    EXPECT_EQ(topic->title.find("inf"), std::string::npos) << topic->title;
    EXPECT_EQ(topic->camera.has_value(), finding.presence == core::FindingPresence::kHere);
  }
  const auto gone = std::ranges::find(topics, std::string(32, 'c'), &BcfTopic::id);
  EXPECT_EQ(gone->status, "Reviewed");
  ASSERT_EQ(gone->comments.size(), 1U);
  EXPECT_EQ(gone->comments[0].text, "<script>alert(1)</script>");
  EXPECT_THAT(gone->title, testing::HasSubstr("gone"));
}

TEST(ReportTopics, CameraLooksAtThePlace) {
  const test_support::TemporaryFolder folder;
  WriteTrial(folder / "s.db", UsualTrial());
  const SessionReader session(folder / "s.db");
  const sessions::TouchList list = sessions::TouchesOf(session);
  const auto topics = sessions::TopicsOf(session, list, {});
  for (std::size_t i = 0; i < list.touches.size(); ++i) {
    const sessions::TopicCamera& camera = topics[i].camera.value();
    const Eigen::Vector3d to_place = (*list.touches[i].at_in_world_mm - camera.eye_mm).normalized();
    EXPECT_NEAR(to_place.dot(camera.direction), 1.0, 1e-12);
    EXPECT_NEAR(camera.up.dot(camera.direction), 0.0, 1e-12);
    EXPECT_NEAR(camera.up.norm(), 1.0, 1e-12);
    EXPECT_GT(camera.up.z(), 0.0);
  }
}

TEST(ReportTopics, StatusesGoOutAndComeBack) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "s.db";
  WriteTrial(path, UsualTrial());
  sessions::WriteReport(SessionReader(path), {}, folder / "out");
  auto entries = ZipEntries(folder / "out" / "touches.bcfzip");
  std::size_t changed = 0;
  for (auto& [name, content] : entries) {
    const std::size_t status = content.find("TopicStatus=\"New\"");
    if (status == std::string::npos) continue;
    content.replace(status, 17, "TopicStatus=\"Closed\"");
    ++changed;
  }
  EXPECT_EQ(changed, 7U);
  WriteZip(folder / "back.bcfzip", entries);
  const auto import =
      sessions::RemarksFrom(sessions::ReadBcfFile(folder / "back.bcfzip"), SessionReader(path).findings());
  EXPECT_EQ(import.topics, 7);
  sessions::AddRemarks(path, import.remarks);
  for (const core::Finding& finding : SessionReader(path).findings())
    EXPECT_EQ(finding.status(), core::ReviewStatus::kResolved);
  sessions::WriteReport(SessionReader(path), {}, folder / "again");
  for (const BcfTopic& topic : sessions::ReadBcfFile(folder / "again" / "touches.bcfzip"))
    EXPECT_EQ(topic.status, "Resolved");
}

}  // namespace
}  // namespace elbowroom::tests
