// What the experimenter asks of a running trial.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/session.h"

namespace elbowroom::control {

struct SpacingRequest {
  std::string spacing;
  double to_mm = 0.0;  // kept within the spacing's limits
};
struct ToolRequest {
  std::string tool;
  bool in_use = false;
};

// The step under way ends, and this one begins; empty: none.
struct StepRequest {
  std::string step;
};

// A mailbox: any thread puts requests in, and the trial takes them out between two frames.
// Thread: any.
class TrialControls {
 public:
  struct Requests {
    std::vector<SpacingRequest> spacings;  // in order: the last one for a spacing holds
    std::vector<ToolRequest> tools;
    std::vector<std::string> notes;
    std::vector<std::variant<StepRequest, core::Bookmark>> moments;  // in order
  };

  void SetSpacing(const std::string& spacing, double to_mm) {
    const std::lock_guard lock(mutex_);
    requests_.spacings.push_back({spacing, to_mm});
  }
  void MarkTool(const std::string& tool, bool in_use) {
    const std::lock_guard lock(mutex_);
    requests_.tools.push_back({tool, in_use});
  }
  // What the experimenter sees or hears at this moment.
  void AddNote(const std::string& note) {
    const std::lock_guard lock(mutex_);
    requests_.notes.push_back(note);
  }
  // Ends the step under way and begins this one; empty: none.
  void BeginStep(const std::string& step) {
    const std::lock_guard lock(mutex_);
    requests_.moments.emplace_back(StepRequest{step});
  }
  void SetBookmark(const std::string& name) {
    const std::lock_guard lock(mutex_);
    requests_.moments.emplace_back(core::Bookmark{name});
  }
  [[nodiscard]] Requests Take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(requests_, {});
  }

 private:
  std::mutex mutex_;
  Requests requests_;
};

}  // namespace elbowroom::control
