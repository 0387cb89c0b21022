#include "app/control/reviewing/reviewed_session.h"

#include <gtest/gtest.h>

#include <thread>

#include "app/control/reviewing/frame_scrubber.h"
#include "app/control/reviewing/listed_findings.h"
#include "core/error.h"
#include "tests/app/reviewing/recorded_sessions.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using test_support::TemporaryFolder;

core::ReviewRemark RemarkBy(const char* name, std::optional<core::ReviewStatus> status, const char* comment) {
  return {"2026-01-02T03:04:05Z", name, status, comment};
}

TEST(ReviewedSession, KeepsWhatReviewersSaidInTheFile) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches);
  {
    ReviewedSession session(folder / "s.db", {}, {});
    const core::FindingId id = session.findings().front().id;
    (void)session.ReadFrame(session.frames().front().frame);  // the file is open
    session.Say(std::vector{sessions::FindingRemark{id, RemarkBy("Ann", core::ReviewStatus::kActive, "hm")}});
    session.Say(std::vector{sessions::FindingRemark{id, RemarkBy("Bo", core::ReviewStatus::kApproved, "")}});
    EXPECT_EQ(session.findings().front().status(), core::ReviewStatus::kApproved);
    (void)session.ReadFrame(session.frames().back().frame);
  }
  const ReviewedSession again(folder / "s.db", {}, {});
  const core::Finding finding = again.findings().front();
  EXPECT_EQ(finding.status(), core::ReviewStatus::kApproved);
  ASSERT_EQ(finding.remarks.size(), 2U);
  EXPECT_EQ(finding.remarks[0].comment, "hm");
  EXPECT_EQ(finding.remarks[0].by, "Ann");
}

TEST(ReviewedSession, RefusesRemarksOfNobody) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 70});
  ReviewedSession session(folder / "s.db", {}, {});
  const core::FindingId id = session.findings().front().id;
  EXPECT_THROW(session.Say(std::vector{sessions::FindingRemark{id, RemarkBy("", {}, "hm")}}), core::Error);
  EXPECT_TRUE(session.findings().front().remarks.empty());
}

// Remarks are added while frames are read on another thread.
TEST(ReviewedSession, IsReadAndWrittenByTwoThreads) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 70});
  ReviewedSession session(folder / "s.db", {}, {});
  const core::FindingId id = session.findings().front().id;
  constexpr int kTimes = 20;
  std::jthread reading([&] {
    for (int i = 0; i < kTimes; ++i) (void)session.ReadFrame(60 + i % 10);
  });
  for (int i = 0; i < kTimes; ++i)
    session.Say(std::vector{sessions::FindingRemark{id, RemarkBy("Ann", core::ReviewStatus::kActive, "hm")}});
  reading.join();
  EXPECT_EQ(sessions::SessionReader(folder / "s.db").findings().front().remarks.size(), kTimes);
}

TEST(ReviewedSession, SaysInOneLineWhatItCannotOpen) {
  const TemporaryFolder folder;
  test_support::WriteText(folder / "text.db", "no session");
  for (const char* name : {"none.db", "text.db"}) {
    try {
      const ReviewedSession session(folder / name, {}, {});
      FAIL();
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST(ReviewedSession, FindsFramesByTimeAndNumber) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", {60, 70});
  const ReviewedSession session(folder / "s.db", {}, {});
  const auto& frames = session.frames();
  EXPECT_EQ(session.PositionAt(-1.0), 0U);
  EXPECT_EQ(session.PositionAt(frames[3].time_s), 3U);
  EXPECT_EQ(session.PositionAt(0.5 * (frames[3].time_s + frames[4].time_s)), 3U);
  EXPECT_EQ(session.PositionAt(1e9), frames.size() - 1);
  EXPECT_EQ(session.PositionOf(0), 0U);
  EXPECT_EQ(session.PositionOf(64), 4U);
  EXPECT_EQ(session.PositionOf(1000), frames.size() - 1);
}

TEST(ListedFindings, GoToTheirWorstFrame) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches);
  const ReviewedSession session(folder / "s.db", {}, {});
  bool has_touch = false;
  for (const ListedFinding& listed : ListFindings(session)) {
    ASSERT_TRUE(listed.worst_position.has_value());
    const core::FrameRecord worst = session.ReadFrame(session.frames()[*listed.worst_position].frame);
    const core::PartContact& contact = worst.contacts.at(*listed.part);
    EXPECT_EQ(listed.spacing_mm, worst.spacing_mm);
    if (listed.finding.kind == core::FindingKind::kTouch) {
      has_touch = true;
      EXPECT_EQ(contact.deepest->depth_mm, listed.depth_mm);
    } else {
      EXPECT_EQ(contact.clearance->interval.upper_mm, listed.clearance_mm);
    }
  }
  EXPECT_TRUE(has_touch);
}

TEST(FrameScrubber, GivesTheFrameAskedForLast) {
  const TemporaryFolder folder;
  RecordDemo(folder / "s.db", kWithTouches);
  const auto session =
      std::make_shared<const ReviewedSession>(folder / "s.db", core::Progress(), std::stop_token());
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<ScrubbedFrame> came;
  {
    FrameScrubber scrubber(session, [&](const ScrubbedFrame& frame) {
      const std::lock_guard lock(mutex);
      came.push_back(frame);
      changed.notify_all();
    });
    const std::size_t last = session->frames().size() - 1;
    for (std::size_t i = 0; i <= last; ++i) scrubber.Ask(i, {});
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return !came.empty() && came.back().position == last; });
  }
  for (std::size_t i = 1; i < came.size(); ++i) EXPECT_LT(came[i - 1].position, came[i].position);
  EXPECT_EQ(came.back().result->record.frame, session->frames().back().frame);
  EXPECT_TRUE(came.back().error.empty());
}

}  // namespace
}  // namespace elbowroom::control
