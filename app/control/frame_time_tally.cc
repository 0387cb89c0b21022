#include "app/control/frame_time_tally.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::control {
namespace {

constexpr double kLeastMs = 1e-3, kStep = 1.01;

}  // namespace

void FrameTimeTally::Add(double time_ms) {
  const double steps = std::log(std::max(time_ms, kLeastMs) / kLeastMs) / std::log(kStep);
  ++frames_[std::min(static_cast<std::size_t>(steps), kSteps - 1)];
  ++all_;
}

std::optional<double> FrameTimeTally::QuantileMs(double share) const {
  std::int64_t shorter = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    shorter += frames_[i];
    if (static_cast<double>(shorter) > share * static_cast<double>(all_))
      return kLeastMs * std::pow(kStep, static_cast<double>(i) + 0.5);
  }
  return std::nullopt;
}

}  // namespace elbowroom::control
