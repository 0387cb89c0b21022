// How a trial went, for people and for programs.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/control/trial_runner.h"

namespace elbowroom::cli {

[[nodiscard]] CommandResult SummaryOf(const control::TrialOutcome& outcome, const core::Layout& layout);

// Passes the news of the session writer on while a trial runs: to a terminal at once, and into the summary.
// Thread: any.
class RecordingLog {
 public:
  explicit RecordingLog(const CommandContext& context) : context_(context) {}

  void Print(const sessions::RecordingNews& news);

  // As warnings of the result.
  void AddTo(CommandResult* result) const;

 private:
  const CommandContext& context_;
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

}  // namespace elbowroom::cli
