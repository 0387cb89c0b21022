// Turns frames into touches and near misses. A touch stays one episode when the contact flickers.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/contact.h"
#include "core/ids.h"
#include "core/rigid_transform.h"
#include "core/session.h"

namespace elbowroom::review {

struct TrackerOptions {
  // A part that is out of contact for no longer than this is still in the same touch, s.
  double max_gap_s = 0.5;
  // A touch begins with a contact at least this deep, mm. 0: any.
  double enter_depth_mm = 0.0;
  // A touch goes on while the part is sure to be within this many times its contact's resolution of the hull.
  double leave_resolutions = 2.0;
  // As in PartReviewOptions, mm. A required clearance of 0: no near misses.
  double required_clearance_mm = 0.0;
  double uncertainty_mm = 0.0;  // of clearances without a budget of their own
  // An approach is over when the part is sure to be farther than required by this, mm.
  double leave_margin_mm = 1.0;

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
};

struct TrackedFrame {
  const core::FrameRecord& record;                         // at most one contact a part; no masks needed
  std::span<const core::RigidTransform> world_from_parts;  // of every part, by its index
  std::span<const std::string> tools_in_use;               // in order of name
};

// Frames are added one by one, in order of time. The rules are those of docs/contact_tracking.md. Episodes of
// one part never overlap. A frame that lacks a camera is passed over: it shows neither a touch nor its end.
// A change of spacing between two frames doesn't by itself end a touch. Thread: one.
class ContactTracker {
 public:
  explicit ContactTracker(const TrackerOptions& options = {});

  void Add(const TrackedFrame& frame);

  // All so far, including those that are still open, in order of begin and then of part; ids from 1.
  [[nodiscard]] std::vector<core::ContactEpisode> Episodes() const;
  [[nodiscard]] std::vector<core::NearMiss> NearMisses() const;

 private:
  struct Touch {
    core::ContactEpisode episode;
    double held_until_s = 0.0;  // time of the last frame in contact or near enough to continue it
  };
  // A run of frames in which the part is, or may be, nearer than required.
  struct Approach {
    core::NearMiss miss;
    double held_until_s = 0.0;
    bool has_touched = false;
  };
  struct PartState {
    std::optional<Touch> touch;
    std::optional<Approach> approach;
  };

  void CloseWhatIsOver(double time_s);
  void FollowTouch(const TrackedFrame& frame, const core::PartContact& contact, PartState* state) const;
  void FollowApproach(const TrackedFrame& frame, const core::PartContact& contact, PartState* state) const;

  TrackerOptions options_;
  std::vector<core::ContactEpisode> touches_;  // closed
  std::vector<core::NearMiss> near_misses_;    // closed
  std::map<core::PartIndex, PartState> parts_;
};

}  // namespace elbowroom::review
