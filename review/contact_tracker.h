// Frames to episodes: one touch is one episode, however the contact flickers.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/contact.h"
#include "core/ids.h"

namespace elbowroom::review {

struct TrackerOptions {
  // A part that is out of contact for no longer than this is still in the same touch, s.
  double max_gap_s = 0.5;

  // Throws: core::Error{kRange}.
  void Validate() const;
};

// Fed frame by frame, in order of time; episodes of one part never overlap. Thread: one.
class ContactTracker {
 public:
  explicit ContactTracker(const TrackerOptions& options = {});

  // contacts: one a part. A change of spacing between two frames doesn't end a touch by itself.
  void Add(core::FrameIndex frame, double time_s, std::span<const core::PartContact> contacts,
           std::span<const double> spacing_mm);

  // All episodes so far, those still open with what is known of them, by begin and then part; ids from 1.
  [[nodiscard]] std::vector<core::ContactEpisode> Episodes() const;

 private:
  TrackerOptions options_;
  std::vector<core::ContactEpisode> closed_;
  std::map<core::PartIndex, core::ContactEpisode> open_;
};

}  // namespace elbowroom::review
