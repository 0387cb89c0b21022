#include "review/contact_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/error.h"

namespace elbowroom::review {
namespace {

void Extend(core::ContactEpisode* episode, core::FrameIndex frame, double time_s,
            const core::PartContact& contact, std::span<const double> spacing_mm) {
  episode->end_frame = frame;
  episode->end_time_s = time_s;
  const bool is_first = episode->frames_in_contact++ == 0;
  const double depth_mm = contact.deepest ? contact.deepest->depth_mm : 0.0;
  const bool is_peak = is_first || std::tie(depth_mm, contact.contact_area_mm2) >
                                       std::tie(episode->peak_depth_mm, episode->peak_area_mm2);
  if (!is_peak) return;
  episode->peak_frame = frame;
  episode->peak_time_s = time_s;
  episode->peak_depth_mm = depth_mm;
  episode->peak_area_mm2 = contact.contact_area_mm2;
  if (contact.deepest) episode->peak_position_in_world_mm = contact.deepest->position_in_world_mm;
  episode->spacing_at_peak_mm.assign(spacing_mm.begin(), spacing_mm.end());
}

}  // namespace

void TrackerOptions::Validate() const {
  if (!(max_gap_s >= 0.0) || !std::isfinite(max_gap_s)) {
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("contact tracker: the longest gap must not be negative, not {} s", max_gap_s));
  }
}

ContactTracker::ContactTracker(const TrackerOptions& options) : options_(options) { options_.Validate(); }

void ContactTracker::Add(core::FrameIndex frame, double time_s, std::span<const core::PartContact> contacts,
                         std::span<const double> spacing_mm) {
  for (auto it = open_.begin(); it != open_.end();) {
    if (time_s - it->second.end_time_s > options_.max_gap_s) {
      closed_.push_back(it->second);
      it = open_.erase(it);
    } else {
      ++it;
    }
  }
  for (const core::PartContact& contact : contacts) {
    if (contact.verdict != core::Verdict::kContact) continue;
    const auto [it, is_new] = open_.try_emplace(contact.part);
    if (is_new) {
      it->second.part = contact.part;
      it->second.begin_frame = frame;
      it->second.begin_time_s = time_s;
    }
    Extend(&it->second, frame, time_s, contact, spacing_mm);
  }
}

std::vector<core::ContactEpisode> ContactTracker::Episodes() const {
  std::vector<core::ContactEpisode> episodes = closed_;
  for (const auto& [part, episode] : open_) episodes.push_back(episode);
  std::sort(episodes.begin(), episodes.end(), [](const auto& a, const auto& b) {
    return std::tie(a.begin_frame, a.part) < std::tie(b.begin_frame, b.part);
  });
  for (std::size_t i = 0; i < episodes.size(); ++i) episodes[i].id = static_cast<core::EpisodeId>(i) + 1;
  return episodes;
}

}  // namespace elbowroom::review
