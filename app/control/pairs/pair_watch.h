// Judges a layout's pair rules beside the frames of a trial.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "app/control/pairs/pair_judge.h"

namespace elbowroom::control {

// One PairJudge on a thread of its own. A setting that equals the last one asked costs a comparison of its
// values. A setting that waits while an earlier one is judged is given up for a later one, so that the
// judging is never more than one setting behind. Without pair rules there is no thread. Thread: one that
// calls.
class PairWatch {
 public:
  // Throws: what RuledPairsOf throws.
  explicit PairWatch(const core::Layout& layout);
  ~PairWatch();
  PairWatch(const PairWatch&) = delete;
  PairWatch& operator=(const PairWatch&) = delete;

  // Begins to judge the spacings of a frame, unless they are those asked for last. Returns at once.
  void Ask(core::FrameIndex frame, double time_s, std::span<const double> spacing_mm);

  // The verdicts that came since the last call, in the order of their settings. Waits for the one asked for
  // last: as long as it takes, or `patience`. Throws: what the judging threw.
  [[nodiscard]] std::vector<SharedPairVerdicts> Take(std::optional<std::chrono::milliseconds> patience);

  [[nodiscard]] const std::vector<review::PairDemand>& pairs() const { return pairs_; }

 private:
  void Run(const std::stop_token& stop);
  [[nodiscard]] bool IsIdle() const { return !waiting_ && !is_judging_; }

  const std::vector<review::PairDemand> pairs_;
  std::optional<PairJudge> judge_;               // the thread's, once it runs
  std::optional<std::vector<double>> asked_mm_;  // the caller's
  std::mutex mutex_;                             // guards the following
  std::condition_variable_any changed_;
  std::optional<PairSetting> waiting_;
  bool is_judging_ = false;
  std::vector<SharedPairVerdicts> answers_;
  std::exception_ptr failure_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace elbowroom::control
