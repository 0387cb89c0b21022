#include "app/control/pairs/pair_watch.h"

#include <algorithm>
#include <utility>

#include "app/control/pairs/ruled_pairs.h"
#include "core/error.h"

namespace elbowroom::control {

PairWatch::PairWatch(const core::Layout& layout) : pairs_(RuledPairsOf(layout)) {
  if (pairs_.empty()) return;
  judge_.emplace(layout, pairs_);
  thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
}

PairWatch::~PairWatch() = default;  // the thread is asked to stop, and waited for

void PairWatch::Ask(core::FrameIndex frame, double time_s, std::span<const double> spacing_mm) {
  if (pairs_.empty() || (asked_mm_ && std::ranges::equal(*asked_mm_, spacing_mm))) return;
  asked_mm_.emplace(spacing_mm.begin(), spacing_mm.end());
  {
    const std::lock_guard lock(mutex_);
    waiting_ = PairSetting{frame, time_s, *asked_mm_};
  }
  changed_.notify_all();
}

std::vector<SharedPairVerdicts> PairWatch::Take(std::optional<std::chrono::milliseconds> patience) {
  if (pairs_.empty()) return {};
  std::unique_lock lock(mutex_);
  if (patience) {
    changed_.wait_for(lock, *patience, [this] { return IsIdle(); });
  } else {
    changed_.wait(lock, [this] { return IsIdle(); });
  }
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  return std::exchange(answers_, {});
}

void PairWatch::Run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return waiting_.has_value(); })) {
    PairSetting setting = *std::exchange(waiting_, std::nullopt);
    is_judging_ = true;
    lock.unlock();
    SharedPairVerdicts verdicts;
    std::exception_ptr failure;
    try {
      verdicts = judge_->Judge(std::move(setting), stop);
    } catch (const core::Error& error) {
      if (error.kind() != core::ErrorKind::kCancelled) failure = std::current_exception();
    } catch (...) {  // the worker's outermost loop: nothing may escape a thread
      failure = std::current_exception();
    }
    lock.lock();
    is_judging_ = false;
    if (failure) failure_ = failure;
    if (verdicts) answers_.push_back(std::move(verdicts));
    changed_.notify_all();
  }
}

}  // namespace elbowroom::control
