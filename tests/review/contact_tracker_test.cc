#include "review/contact_tracker.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/error.h"

namespace elbowroom::review {
namespace {

constexpr double kFramesPerSecond = 25.0;

core::PartContact Touch(core::PartIndex part, double depth_mm, double area_mm2 = 1.0) {
  core::PartContact contact;
  contact.part = part;
  contact.verdict = core::Verdict::kContact;
  contact.contact_area_mm2 = area_mm2;
  contact.deepest = core::ContactPoint{Eigen::Vector3d(depth_mm, 0, 0), depth_mm, area_mm2};
  return contact;
}

core::PartContact Clear(core::PartIndex part) {
  core::PartContact contact;
  contact.part = part;
  return contact;
}

void AddFrame(ContactTracker* tracker, core::FrameIndex frame, const core::PartContact& contact,
              double spacing_mm = 140.0) {
  tracker->Add(frame, static_cast<double>(frame) / kFramesPerSecond, std::array{contact},
               std::array{spacing_mm});
}

TEST(ContactTracker, LongFlickeringTouchIsOneEpisode) {
  ContactTracker tracker;
  for (core::FrameIndex frame = 0; frame < 400; ++frame)
    AddFrame(&tracker, frame, frame % 3 == 0 ? Touch(0, 2.0) : Clear(0));
  const auto episodes = tracker.Episodes();
  ASSERT_EQ(episodes.size(), 1U);
  EXPECT_EQ(episodes[0].id, 1);
  EXPECT_EQ(episodes[0].begin_frame, 0);
  EXPECT_EQ(episodes[0].end_frame, 399);
  EXPECT_EQ(episodes[0].frames_in_contact, 134);
}

TEST(ContactTracker, GapAsLongAsTheRuleStillJoins) {
  for (const auto& [gap_frames, expected] : {std::pair{8, 1U}, std::pair{9, 2U}}) {
    TrackerOptions options;
    options.max_gap_s = 0.5;
    ContactTracker tracker(options);
    // Times that doubles hold exactly: sixteenths of a second.
    tracker.Add(0, 0.0, std::array{Touch(0, 1.0)}, {});
    tracker.Add(gap_frames, gap_frames / 16.0, std::array{Touch(0, 1.0)}, {});
    EXPECT_EQ(tracker.Episodes().size(), expected) << gap_frames;
  }
}

TEST(ContactTracker, PeakIsTheDeepestThenTheLargestThenTheFirst) {
  ContactTracker tracker;
  AddFrame(&tracker, 10, Touch(0, 1.0, 9.0), 140.0);
  AddFrame(&tracker, 11, Touch(0, 3.0, 5.0), 150.0);
  AddFrame(&tracker, 12, Touch(0, 3.0, 6.0), 160.0);
  AddFrame(&tracker, 13, Touch(0, 3.0, 6.0), 170.0);
  AddFrame(&tracker, 14, Touch(0, 2.0, 50.0), 180.0);
  const core::ContactEpisode episode = tracker.Episodes().at(0);
  EXPECT_EQ(episode.begin_frame, 10);
  EXPECT_EQ(episode.peak_frame, 12);
  EXPECT_EQ(episode.end_frame, 14);
  EXPECT_EQ(episode.peak_time_s, 12 / kFramesPerSecond);
  EXPECT_EQ(episode.peak_depth_mm, 3.0);
  EXPECT_EQ(episode.peak_area_mm2, 6.0);
  EXPECT_EQ(episode.peak_position_in_world_mm.x(), 3.0);
  EXPECT_EQ(episode.spacing_at_peak_mm, std::vector{160.0});
}

TEST(ContactTracker, TouchWithoutDepthIsAnEpisodeToo) {
  ContactTracker tracker;
  core::PartContact contact = Touch(0, 0.0);
  contact.deepest.reset();
  AddFrame(&tracker, 5, contact);
  ASSERT_EQ(tracker.Episodes().size(), 1U);
  EXPECT_EQ(tracker.Episodes()[0].peak_frame, 5);
  EXPECT_EQ(tracker.Episodes()[0].peak_depth_mm, 0.0);
}

TEST(ContactTracker, PartsAreIndependentAndOrderedByBegin) {
  ContactTracker tracker;
  const std::vector<double> spacing_mm;
  tracker.Add(0, 0.0, std::array{Clear(0), Touch(1, 1.0), Clear(2)}, spacing_mm);
  tracker.Add(1, 0.1, std::array{Touch(0, 1.0), Touch(1, 1.0), Touch(2, 4.0)}, spacing_mm);
  tracker.Add(20, 2.0, std::array{Touch(0, 1.0), Clear(1), Clear(2)}, spacing_mm);
  const auto episodes = tracker.Episodes();
  ASSERT_EQ(episodes.size(), 4U);
  const std::array<core::PartIndex, 4> parts = {1, 0, 2, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(episodes[i].id, static_cast<core::EpisodeId>(i) + 1);
    EXPECT_EQ(episodes[i].part, parts[i]);
  }
  EXPECT_EQ(episodes[3].begin_frame, 20);
}

TEST(ContactTracker, EpisodesAreStableWhileOpen) {
  ContactTracker tracker;
  for (core::FrameIndex frame = 0; frame < 5; ++frame) {
    AddFrame(&tracker, frame, Touch(0, 1.0 + static_cast<double>(frame)));
    const auto episodes = tracker.Episodes();
    ASSERT_EQ(episodes.size(), 1U);
    EXPECT_EQ(episodes[0].end_frame, frame);
    EXPECT_EQ(episodes[0].peak_frame, frame);
  }
}

TEST(ContactTracker, NothingButContactCounts) {
  ContactTracker tracker;
  for (const auto verdict : {core::Verdict::kNear, core::Verdict::kClear, core::Verdict::kUndecided}) {
    core::PartContact contact = Touch(0, 1.0);
    contact.verdict = verdict;
    AddFrame(&tracker, 0, contact);
  }
  EXPECT_TRUE(tracker.Episodes().empty());
}

TEST(ContactTracker, RefusesAGapThatIsNone) {
  for (const double gap_s : {-0.1, std::nan(""), HUGE_VAL}) {
    TrackerOptions options;
    options.max_gap_s = gap_s;
    EXPECT_THROW(ContactTracker{options}, core::Error) << gap_s;
  }
}

}  // namespace
}  // namespace elbowroom::review
