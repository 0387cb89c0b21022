// The light of the last seconds and hours.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "recon/light/light_pulse.h"
#include "recon/light/light_report.h"

namespace elbowroom::recon {

// Keeps each gain for kPulseS, and means over kBlockS for kDriftS.
class GainHistory {
 public:
  static constexpr double kPulseS = 10.0, kNowS = 2.0, kBlockS = 30.0, kDriftS = 1800.0;

  // `at`: later than the last one.
  void Add(const GainAtTime& at);

  [[nodiscard]] double Now() const;     // mean of the last kNowS; 1 without a gain
  [[nodiscard]] double RateHz() const;  // of the gains of the last kPulseS; 0 if there are fewer than two
  [[nodiscard]] std::optional<LightPulse> Pulse() const;

  // A straight line through the block means: nothing unless the light changed by a hundredth in the time,
  // and by three times what the scatter of the means around the line allows.
  [[nodiscard]] std::optional<SlowDrift> Drift() const;

 private:
  std::deque<GainAtTime> recent_;
  std::deque<GainAtTime> blocks_;  // means
  double block_start_s_ = 0.0, block_sum_ = 0.0;
  int block_count_ = 0;
};

}  // namespace elbowroom::recon
