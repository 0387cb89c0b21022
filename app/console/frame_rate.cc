#include "app/console/frame_rate.h"

namespace elbowroom::console {
namespace {

constexpr std::chrono::seconds kWindow(2);

}  // namespace

void FrameRate::Add(core::FrameIndex frame, Clock::time_point at) {
  recent_.push_back({frame, at});
  while (at - recent_.front().at > kWindow) recent_.pop_front();
}

std::optional<double> FrameRate::frames_per_s() const {
  if (recent_.size() < 2) return std::nullopt;
  const double seconds = std::chrono::duration<double>(recent_.back().at - recent_.front().at).count();
  if (seconds <= 0.0) return std::nullopt;
  return static_cast<double>(recent_.back().frame - recent_.front().frame) / seconds;
}

}  // namespace elbowroom::console
