#include "app/control/replay/finding_matches.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace elbowroom::control {
namespace {

core::Layout LayoutOf(const std::vector<std::string>& names) {
  core::Layout layout;
  for (const std::string& name : names) {
    core::Part part;
    part.name = name;
    layout.parts.push_back(part);
  }
  return layout;
}

core::Finding Origin(const std::string& id, const std::string& part, double begin_s, double end_s,
                     const Eigen::Vector3d& place) {
  core::Finding finding;
  finding.id = id;
  finding.part = part;
  finding.begin_s = begin_s;
  finding.end_s = end_s;
  finding.place_in_part_mm = place;
  return finding;
}

core::ContactEpisode Touch(core::PartIndex part, double begin_s, double end_s, const Eigen::Vector3d& place) {
  core::ContactEpisode episode;
  episode.part = part;
  episode.begin_time_s = begin_s;
  episode.end_time_s = end_s;
  episode.peak_position_in_part_mm = place;
  return episode;
}

TEST(MatchFindings, ByPartTimeAndPlace) {
  // Two touches of one part at once, at two ends of it: only the place tells them apart.
  const std::vector<core::Finding> origin = {
      Origin("left", "A", 1.0, 2.0, {0, 0, 0}), Origin("right", "A", 1.0, 2.0, {500, 0, 0}),
      Origin("other part", "B", 1.0, 2.0, {0, 0, 0}), Origin("later", "A", 5.0, 6.0, {0, 0, 0})};
  core::SessionOutcome outcome;
  outcome.episodes = {Touch(1, 1.1, 2.1, {490, 0, 0}), Touch(1, 1.1, 2.1, {5, 0, 0}),
                      Touch(1, 3.0, 4.0, {0, 0, 0}), Touch(0, 1.0, 2.0, {0, 0, 0})};
  MatchFindings(origin, LayoutOf({"B", "A"}), &outcome);
  EXPECT_EQ(outcome.episodes[0].finding_id, "right");
  EXPECT_EQ(outcome.episodes[1].finding_id, "left");
  EXPECT_EQ(outcome.episodes[2].finding_id, "");
  EXPECT_EQ(outcome.episodes[3].finding_id, "other part");
}

TEST(MatchFindings, ATouchMayBecomeANearMissButOneOfItsKindComesFirst) {
  const std::vector<core::Finding> origin = {Origin("touch", "A", 1.0, 2.0, {0, 0, 0}),
                                             Origin("second", "A", 4.0, 5.0, {0, 0, 0})};
  core::SessionOutcome outcome;
  outcome.episodes = {Touch(0, 1.9, 2.5, {90, 0, 0})};
  core::NearMiss same_time, second;
  same_time.begin_time_s = 1.0;
  same_time.end_time_s = 2.0;
  second.begin_time_s = 4.0;
  second.end_time_s = 5.0;
  outcome.near_misses = {same_time, second};
  MatchFindings(origin, LayoutOf({"A"}), &outcome);
  EXPECT_EQ(outcome.episodes[0].finding_id, "touch");
  EXPECT_EQ(outcome.near_misses[0].finding_id, "");
  EXPECT_EQ(outcome.near_misses[1].finding_id, "second");
}

TEST(TakeOverReview, TellsGoneFromNotChecked) {
  std::vector<core::Finding> origin = {
      Origin("gone", "A", 1.0, 2.0, {0, 0, 0}), Origin("approved", "A", 1.0, 2.0, {0, 0, 0}),
      Origin("no part", "B", 1.0, 2.0, {0, 0, 0}), Origin("no frames", "A", 1.0, 9.0, {0, 0, 0}),
      Origin("here", "A", 1.0, 2.0, {0, 0, 0})};
  origin[1].remarks = {{"t", "Ann", core::ReviewStatus::kApproved, ""}};
  origin[4].remarks = {{"t", "Ann", core::ReviewStatus::kResolved, "gone for good"}};
  core::SessionOutcome outcome;
  outcome.episodes = {Touch(0, 1.0, 2.0, {0, 0, 0})};
  outcome.episodes[0].finding_id = "here";
  const sessions::SessionClosing closing =
      TakeOverReview(origin, LayoutOf({"A"}), {0.0, 5.0}, outcome, "replay", "now");
  ASSERT_EQ(closing.absent.size(), 4U);
  EXPECT_EQ(closing.absent[0].presence, core::FindingPresence::kGone);
  EXPECT_EQ(closing.absent[1].presence, core::FindingPresence::kGone);
  EXPECT_EQ(closing.absent[2].presence, core::FindingPresence::kNotChecked);
  EXPECT_EQ(closing.absent[3].presence, core::FindingPresence::kNotChecked);
  const auto status_of = [&](const std::string& id) {
    core::Finding finding;
    for (const auto& [of, remark] : closing.remarks)
      if (of == id) finding.remarks.push_back(remark);
    return finding.status();
  };
  EXPECT_EQ(status_of("gone"), core::ReviewStatus::kResolved);
  EXPECT_EQ(status_of("approved"), core::ReviewStatus::kApproved);
  EXPECT_EQ(status_of("no part"), core::ReviewStatus::kNew);
  EXPECT_EQ(status_of("no frames"), core::ReviewStatus::kNew);
  EXPECT_EQ(status_of("here"), core::ReviewStatus::kActive);
}

}  // namespace
}  // namespace elbowroom::control
