// The touches so far, part by part, for those who watch a trial while it runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/control/frame_result.h"
#include "review/contact_tracker.h"

namespace elbowroom::control {

struct PartTally {
  std::int64_t episodes = 0;  // begun; one that goes on counts
  std::int64_t frames_in_contact = 0;
  double deepest_mm = 0.0;  // of all episodes; a certified lower bound
};

// Fed every frame in order; the rule that merges frames to episodes is the session's own. Thread: one.
class EpisodeTally {
 public:
  explicit EpisodeTally(std::size_t parts) : parts_(parts) {}

  void Add(const FrameResult& result);
  [[nodiscard]] std::vector<PartTally> Parts() const;  // in the layout's order

 private:
  std::size_t parts_;
  review::ContactTracker tracker_;
};

}  // namespace elbowroom::control
