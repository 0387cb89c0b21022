#include "review/contact_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "core/error.h"

namespace elbowroom::review {
namespace {

std::vector<std::string> UnionOf(const std::vector<std::string>& a, std::span<const std::string> b) {
  std::vector<std::string> both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

// Where the contact is: at its deepest point. If it has no points, where the hull was found inside the part,
// or where the two meet.
std::optional<Eigen::Vector3d> PlaceOf(const core::PartContact& contact) {
  if (contact.deepest) return contact.deepest->position_in_world_mm;
  if (contact.contained_in_world_mm) return contact.contained_in_world_mm;
  if (contact.clearance && contact.clearance->has_witnesses)
    return contact.clearance->interval.witness_part_in_world_mm;
  return std::nullopt;
}

void SetPeak(const TrackedFrame& frame, const core::PartContact& contact, double depth_mm,
             core::ContactEpisode* episode) {
  episode->peak_frame = frame.record.frame;
  episode->peak_time_s = frame.record.time_s;
  episode->peak_depth_mm = depth_mm;
  episode->peak_area_mm2 = contact.contact_area_mm2;
  if (const auto place = PlaceOf(contact)) {
    episode->peak_position_in_world_mm = *place;
    if (contact.part < frame.world_from_parts.size())
      episode->peak_position_in_part_mm = frame.world_from_parts[contact.part].Inverse() * *place;
  }
  episode->spacing_at_peak_mm = frame.record.spacing_mm;
}

void Extend(const TrackedFrame& frame, const core::PartContact& contact, core::ContactEpisode* episode) {
  episode->end_frame = frame.record.frame;
  episode->end_time_s = frame.record.time_s;
  episode->tools = UnionOf(episode->tools, frame.tools_in_use);
  const bool is_first = episode->frames_in_contact++ == 0;
  const double depth_mm = contact.deepest ? contact.deepest->depth_mm : 0.0;
  if (is_first ||
      std::tie(depth_mm, contact.contact_area_mm2) > std::tie(episode->peak_depth_mm, episode->peak_area_mm2))
    SetPeak(frame, contact, depth_mm, episode);
}

// Whether the part is sure to be nearer than required.
bool IsSurelyBelow(core::Verdict verdict) {
  switch (verdict) {
    case core::Verdict::kContact:
    case core::Verdict::kNear:
      return true;
    case core::Verdict::kClear:
    case core::Verdict::kUndecided:
      break;
  }
  return false;
}

void Extend(const TrackedFrame& frame, const core::PartContact& contact, core::NearMiss* miss) {
  miss->end_frame = frame.record.frame;
  miss->end_time_s = frame.record.time_s;
  miss->tools = UnionOf(miss->tools, frame.tools_in_use);
  const bool is_first = miss->frames_below++ == 0;
  if (IsSurelyBelow(contact.verdict)) miss->verdict = core::Verdict::kNear;
  const auto bounds = [](const core::PartClearance& clearance) {
    return std::pair(clearance.interval.upper_mm, clearance.interval.lower_mm);
  };
  if (!is_first && bounds(*contact.clearance) >= bounds(miss->closest)) return;
  miss->closest = *contact.clearance;
  miss->place_in_part_mm.reset();
  if (contact.clearance->has_witnesses)
    miss->place_in_part_mm =
        frame.world_from_parts[contact.part].Inverse() * contact.clearance->interval.witness_part_in_world_mm;
  miss->closest_frame = frame.record.frame;
  miss->closest_time_s = frame.record.time_s;
  miss->spacing_at_closest_mm = frame.record.spacing_mm;
}

template <typename Episode>
void Number(std::vector<Episode>* episodes) {
  std::sort(episodes->begin(), episodes->end(), [](const auto& a, const auto& b) {
    return std::tie(a.begin_frame, a.part) < std::tie(b.begin_frame, b.part);
  });
  for (std::size_t i = 0; i < episodes->size(); ++i) (*episodes)[i].id = static_cast<core::EpisodeId>(i) + 1;
}

}  // namespace

void TrackerOptions::Validate() const {
  const auto require = [](double value, const char* what, const char* unit) {
    if (value >= 0.0 && std::isfinite(value)) return;
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("contact tracker: {} must not be negative, not {}{}", what, value, unit));
  };
  require(max_gap_s, "the longest gap", " s");
  require(enter_depth_mm, "the depth at which a touch begins", " mm");
  require(leave_resolutions, "the distance at which it ends", " resolutions");
  require(required_clearance_mm, "the required clearance", " mm");
  require(uncertainty_mm, "the uncertainty", " mm");
  require(leave_margin_mm, "the margin at which an approach ends", " mm");
}

ContactTracker::ContactTracker(const TrackerOptions& options) : options_(options) { options_.Validate(); }

void ContactTracker::Add(const TrackedFrame& frame) {
  if (frame.record.LacksCamera()) return;
  CloseWhatIsOver(frame.record.time_s);
  for (const core::PartContact& contact : frame.record.contacts) {
    PartState& state = parts_[contact.part];
    FollowTouch(frame, contact, &state);
    FollowApproach(frame, contact, &state);
  }
}

void ContactTracker::CloseWhatIsOver(double time_s) {
  const auto is_over = [&](const auto& open) {
    return open && time_s - open->held_until_s > options_.max_gap_s;
  };
  for (auto& [part, state] : parts_) {
    if (is_over(state.touch)) {
      touches_.push_back(std::move(state.touch->episode));
      state.touch.reset();
    }
    if (is_over(state.approach)) {
      if (!state.approach->has_touched) near_misses_.push_back(std::move(state.approach->miss));
      state.approach.reset();
    }
  }
}

void ContactTracker::FollowTouch(const TrackedFrame& frame, const core::PartContact& contact,
                                 PartState* state) const {
  if (contact.verdict == core::Verdict::kContact) {
    const bool begins = !contact.deepest || contact.deepest->depth_mm >= options_.enter_depth_mm;
    if (!state->touch && begins) {
      state->touch = Touch{};
      state->touch->episode.part = contact.part;
      state->touch->episode.begin_frame = frame.record.frame;
      state->touch->episode.begin_time_s = frame.record.time_s;
    }
    if (!state->touch) return;
    Extend(frame, contact, &state->touch->episode);
    state->touch->held_until_s = frame.record.time_s;
  } else if (state->touch && contact.clearance &&
             contact.clearance->interval.upper_mm <= options_.leave_resolutions * contact.resolution_mm) {
    state->touch->held_until_s = frame.record.time_s;
  }
}

void ContactTracker::FollowApproach(const TrackedFrame& frame, const core::PartContact& contact,
                                    PartState* state) const {
  if (!(options_.required_clearance_mm > 0.0) || !contact.clearance) return;
  const double sure_mm =
      contact.clearance->interval.lower_mm - contact.clearance->AllowedMm(options_.uncertainty_mm);
  const bool is_below = sure_mm < options_.required_clearance_mm;
  if (is_below && !state->approach) {
    state->approach = Approach{};
    state->approach->miss.part = contact.part;
    state->approach->miss.begin_frame = frame.record.frame;
    state->approach->miss.begin_time_s = frame.record.time_s;
  }
  if (!state->approach) return;
  if (sure_mm < options_.required_clearance_mm + options_.leave_margin_mm)
    state->approach->held_until_s = frame.record.time_s;
  if (is_below) Extend(frame, contact, &state->approach->miss);
  if (state->touch && state->touch->held_until_s == frame.record.time_s) state->approach->has_touched = true;
}

std::vector<core::ContactEpisode> ContactTracker::Episodes() const {
  std::vector<core::ContactEpisode> episodes = touches_;
  for (const auto& [part, state] : parts_) {
    if (state.touch) episodes.push_back(state.touch->episode);
  }
  Number(&episodes);
  return episodes;
}

std::vector<core::NearMiss> ContactTracker::NearMisses() const {
  std::vector<core::NearMiss> misses = near_misses_;
  for (const auto& [part, state] : parts_) {
    if (state.approach && !state.approach->has_touched) misses.push_back(state.approach->miss);
  }
  Number(&misses);
  return misses;
}

}  // namespace elbowroom::review
