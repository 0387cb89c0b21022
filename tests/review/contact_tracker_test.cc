#include "review/contact_tracker.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "review/clearance.h"

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

core::FrameRecord RecordOf(core::FrameIndex frame, double time_s, std::vector<core::PartContact> contacts,
                           std::vector<double> spacing_mm = {}) {
  core::FrameRecord record;
  record.frame = frame;
  record.time_s = time_s;
  record.spacing_mm = std::move(spacing_mm);
  record.contacts = std::move(contacts);
  return record;
}

void AddFrame(ContactTracker* tracker, core::FrameIndex frame, const core::PartContact& contact,
              double spacing_mm = 140.0) {
  tracker->Add(
      {RecordOf(frame, static_cast<double>(frame) / kFramesPerSecond, {contact}, {spacing_mm}), {}, {}});
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
    const std::vector touch{Touch(0, 1.0)};
    tracker.Add({RecordOf(0, 0.0, touch), {}, {}});
    tracker.Add({RecordOf(gap_frames, gap_frames / 16.0, touch), {}, {}});
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
  const std::vector one{Clear(0), Touch(1, 1.0), Clear(2)}, all{Touch(0, 1.0), Touch(1, 1.0), Touch(2, 4.0)},
      later{Touch(0, 1.0), Clear(1), Clear(2)};
  tracker.Add({RecordOf(0, 0.0, one), {}, {}});
  tracker.Add({RecordOf(1, 0.1, all), {}, {}});
  tracker.Add({RecordOf(20, 2.0, later), {}, {}});
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

TEST(ContactTracker, AFrameThatLacksACameraIsPassedOver) {
  ContactTracker tracker(TrackerOptions{.required_clearance_mm = 20.0});
  const auto add = [&](core::FrameIndex frame, core::PartContact contact, bool lacks_camera) {
    if (lacks_camera) contact.verdict = core::Verdict::kUndecided;
    core::FrameRecord record = RecordOf(frame, static_cast<double>(frame) / 10.0, {contact});
    if (lacks_camera) record.stamps = {core::CameraStamp{1, record.time_s}, std::nullopt};
    tracker.Add({record, {}, {}});
  };
  core::PartContact meets = Touch(0, 1.0);
  meets.clearance = core::PartClearance{};
  meets.clearance->interval.upper_mm = 0.0;
  add(0, meets, true);
  EXPECT_TRUE(tracker.Episodes().empty());
  EXPECT_TRUE(tracker.NearMisses().empty()) << "the hull's size alone may have done it";
  add(1, meets, false);
  for (core::FrameIndex frame = 2; frame < 6; ++frame) add(frame, meets, true);
  add(6, meets, false);
  ASSERT_EQ(tracker.Episodes().size(), 1U) << "a gap that ends within 0.5 s";
  EXPECT_EQ(tracker.Episodes()[0].frames_in_contact, 2);
  EXPECT_EQ(tracker.Episodes()[0].end_frame, 6);
}

TEST(ContactTracker, SaysWhereOnThePartAndWithWhichTools) {
  ContactTracker tracker;
  const std::vector touch{Touch(0, 3.0)};  // at (3, 0, 0)
  const std::array pose{core::RigidTransform{Eigen::Matrix3d::Identity(), {1.0, 2.0, 3.0}}};
  const std::array<std::string, 1> tongs{"tongs"};
  const std::array<std::string, 1> driver{"driver"};
  tracker.Add({RecordOf(0, 0.0, touch), pose, {}});
  tracker.Add({RecordOf(1, 0.1, touch), pose, tongs});
  tracker.Add({RecordOf(2, 0.2, touch), pose, driver});
  const std::vector clear{Clear(0)};
  const std::array<std::string, 1> saw{"saw"};
  tracker.Add({RecordOf(3, 0.3, clear), pose, saw});
  const core::ContactEpisode episode = tracker.Episodes().at(0);
  EXPECT_EQ(episode.peak_position_in_part_mm, Eigen::Vector3d(2.0, -2.0, -3.0));
  EXPECT_EQ(episode.tools, (std::vector<std::string>{"driver", "tongs"})) << "not the one taken afterwards";
}

TEST(ContactTracker, ATouchBeginsAtADepthAndGoesOnAtAny) {
  TrackerOptions options;
  options.enter_depth_mm = 2.0;
  ContactTracker tracker(options);
  AddFrame(&tracker, 0, Touch(0, 1.9));
  EXPECT_TRUE(tracker.Episodes().empty());
  AddFrame(&tracker, 1, Touch(0, 2.0));
  AddFrame(&tracker, 2, Touch(0, 0.1));
  ASSERT_EQ(tracker.Episodes().size(), 1U);
  EXPECT_EQ(tracker.Episodes()[0].begin_frame, 1);
  EXPECT_EQ(tracker.Episodes()[0].end_frame, 2);
  core::PartContact inside = Touch(1, 0.0);
  inside.deepest.reset();
  AddFrame(&tracker, 3, inside);
  EXPECT_EQ(tracker.Episodes().size(), 2U) << "matter inside a part has no depth to fall short of";
}

// Not in contact, as far as that.
core::PartContact Away(double lower_mm, double upper_mm, double required_mm = 20.0) {
  core::PartContact contact = Clear(0);
  contact.resolution_mm = 0.5;
  contact.clearance = core::PartClearance{};
  contact.clearance->interval.lower_mm = lower_mm;
  contact.clearance->interval.upper_mm = upper_mm;
  contact.verdict =
      Judge({.interval = contact.clearance->interval, .meets = upper_mm == 0.0}, required_mm, 0.0);
  return contact;
}
core::PartContact TouchAndMeet(double depth_mm) {
  core::PartContact contact = Touch(0, depth_mm);
  contact.clearance = core::PartClearance{};
  contact.clearance->interval.upper_mm = 0.0;
  return contact;
}
TrackerOptions Requiring20Mm() {
  TrackerOptions options;
  options.required_clearance_mm = 20.0;
  return options;
}

TEST(ContactTracker, ATouchIsHeldAsLongAsThePartIsWithinAPixel) {
  for (const auto& [upper_mm, touches] : {std::pair{1.0, 1U}, std::pair{1.1, 2U}}) {
    ContactTracker tracker(Requiring20Mm());
    AddFrame(&tracker, 0, TouchAndMeet(1.0));
    for (core::FrameIndex frame = 1; frame < 100; ++frame) AddFrame(&tracker, frame, Away(0.2, upper_mm));
    AddFrame(&tracker, 100, TouchAndMeet(1.0));
    EXPECT_EQ(tracker.Episodes().size(), touches) << upper_mm;
    EXPECT_EQ(tracker.Episodes()[0].frames_in_contact, touches == 1 ? 2 : 1) << "held frames don't count";
    EXPECT_TRUE(tracker.NearMisses().empty()) << "one approach, that touched";
  }
}

TEST(ContactTracker, ANearMissIsAnApproachWithoutATouch) {
  ContactTracker tracker(Requiring20Mm());
  AddFrame(&tracker, 0, Away(30.0, 31.0), 1.0);
  AddFrame(&tracker, 1, Away(19.5, 20.5), 2.0);
  AddFrame(&tracker, 2, Away(8.0, 9.0), 3.0);
  AddFrame(&tracker, 3, Away(7.0, 9.0), 4.0);
  AddFrame(&tracker, 4, Away(7.0, 9.0), 5.0);
  AddFrame(&tracker, 5, Away(20.5, 21.4), 6.0);  // clear, but within the margin
  AddFrame(&tracker, 6, Away(21.0, HUGE_VAL), 7.0);
  EXPECT_TRUE(tracker.Episodes().empty());
  ASSERT_EQ(tracker.NearMisses().size(), 1U) << "still open";
  AddFrame(&tracker, 60, Away(21.0, HUGE_VAL), 8.0);
  ASSERT_EQ(tracker.NearMisses().size(), 1U) << "closed";
  const core::NearMiss miss = tracker.NearMisses()[0];
  EXPECT_EQ(miss.id, 1);
  EXPECT_EQ(miss.verdict, core::Verdict::kNear);
  EXPECT_EQ(miss.begin_frame, 1);
  EXPECT_EQ(miss.closest_frame, 3) << "least upper bound, then least lower, then first";
  EXPECT_EQ(miss.end_frame, 4);
  EXPECT_EQ(miss.frames_below, 4);
  EXPECT_EQ(miss.closest.interval.lower_mm, 7.0);
  EXPECT_EQ(miss.closest.interval.upper_mm, 9.0);
  EXPECT_EQ(miss.spacing_at_closest_mm, std::vector{4.0});
  EXPECT_EQ(miss.closest_time_s, 3 / kFramesPerSecond);
}

TEST(ContactTracker, JitterAboutTheRequiredClearanceIsOneNearMiss) {
  ContactTracker tracker(Requiring20Mm());
  for (core::FrameIndex frame = 0; frame < 400; ++frame)  // 16 s: longer than any gap, but for the margin
    AddFrame(&tracker, frame, frame % 100 == 0 ? Away(19.8, 19.9) : Away(20.2, 20.9));
  EXPECT_EQ(tracker.NearMisses().size(), 1U);
  EXPECT_EQ(tracker.NearMisses()[0].frames_below, 4);
}

TEST(ContactTracker, DrawingBackFromATouchIsNoNearMiss) {
  ContactTracker tracker(Requiring20Mm());
  core::FrameIndex frame = 0;
  for (const double mm : {15.0, 10.0, 5.0}) AddFrame(&tracker, frame++, Away(mm, mm + 1.0));
  AddFrame(&tracker, frame++, TouchAndMeet(0.5));
  for (int i = 0; i < 60; ++i) AddFrame(&tracker, frame++, Away(5.0, 6.0));
  for (int i = 0; i < 60; ++i) AddFrame(&tracker, frame++, Away(50.0, 51.0));
  EXPECT_EQ(tracker.Episodes().size(), 1U);
  EXPECT_TRUE(tracker.NearMisses().empty());
  for (int i = 0; i < 3; ++i) AddFrame(&tracker, frame++, Away(5.0, 6.0));
  EXPECT_EQ(tracker.NearMisses().size(), 1U) << "another approach";
}

TEST(ContactTracker, AnApproachThatIsNeverSureSaysSo) {
  TrackerOptions options = Requiring20Mm();
  options.uncertainty_mm = 2.0;
  ContactTracker tracker(options);
  core::PartContact contact = Away(20.5, 21.0);
  contact.verdict = core::Verdict::kUndecided;
  AddFrame(&tracker, 0, contact);
  ASSERT_EQ(tracker.NearMisses().size(), 1U);
  EXPECT_EQ(tracker.NearMisses()[0].verdict, core::Verdict::kUndecided);
}

TEST(ContactTracker, AGrazeShallowerThanATouchIsANearMissOfNoDistance) {
  TrackerOptions options = Requiring20Mm();
  options.enter_depth_mm = 2.0;
  ContactTracker tracker(options);
  AddFrame(&tracker, 0, TouchAndMeet(0.5));
  EXPECT_TRUE(tracker.Episodes().empty());
  ASSERT_EQ(tracker.NearMisses().size(), 1U);
  EXPECT_EQ(tracker.NearMisses()[0].closest.interval.upper_mm, 0.0);
}

TEST(ContactTracker, RefusesWhatIsNoRule) {
  for (double TrackerOptions::*option :
       {&TrackerOptions::max_gap_s, &TrackerOptions::enter_depth_mm, &TrackerOptions::leave_resolutions,
        &TrackerOptions::required_clearance_mm, &TrackerOptions::uncertainty_mm,
        &TrackerOptions::leave_margin_mm}) {
    for (const double value : {-0.1, std::nan(""), HUGE_VAL}) {
      TrackerOptions options;
      options.*option = value;
      EXPECT_THROW(ContactTracker{options}, core::Error) << value;
    }
  }
}

}  // namespace
}  // namespace elbowroom::review
