#include "recon/light/gain_history.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::recon {

void GainHistory::Add(const GainAtTime& at) {
  recent_.push_back(at);
  while (recent_.front().time_s < at.time_s - kPulseS) recent_.pop_front();
  if (block_count_ == 0) block_start_s_ = at.time_s;
  if (at.time_s >= block_start_s_ + kBlockS && block_count_ > 0) {
    blocks_.push_back({block_start_s_ + 0.5 * kBlockS, block_sum_ / block_count_});
    block_start_s_ = at.time_s, block_sum_ = 0.0, block_count_ = 0;
    while (blocks_.front().time_s < at.time_s - kDriftS) blocks_.pop_front();
  }
  block_sum_ += at.gain, ++block_count_;
}

double GainHistory::Now() const {
  double sum = 0.0;
  int count = 0;
  for (auto at = recent_.rbegin(); at != recent_.rend(); ++at) {
    if (at->time_s < recent_.back().time_s - kNowS) break;
    sum += at->gain, ++count;
  }
  return count == 0 ? 1.0 : sum / count;
}

double GainHistory::RateHz() const {
  if (recent_.size() < 2) return 0.0;
  return static_cast<double>(recent_.size() - 1) / (recent_.back().time_s - recent_.front().time_s);
}

std::optional<LightPulse> GainHistory::Pulse() const {
  const std::vector<GainAtTime> gains(recent_.begin(), recent_.end());
  return FindPulse(gains);
}

std::optional<SlowDrift> GainHistory::Drift() const {
  constexpr std::size_t kLeastBlocks = 6;
  constexpr double kLeastChange = 0.01, kStandardErrors = 3.0, kHourS = 3600.0, kTenth = 0.1;
  if (blocks_.size() < kLeastBlocks) return std::nullopt;
  const auto n = static_cast<double>(blocks_.size());
  double t = 0.0, g = 0.0, tt = 0.0, tg = 0.0, rest = 0.0;
  for (const GainAtTime& block : blocks_) t += block.time_s / n, g += block.gain / n;
  for (const GainAtTime& block : blocks_) {
    tt += (block.time_s - t) * (block.time_s - t);
    tg += (block.time_s - t) * (block.gain - g);
  }
  const double slope = tg / tt;
  for (const GainAtTime& block : blocks_) {
    const double miss = block.gain - g - slope * (block.time_s - t);
    rest += miss * miss;
  }
  const double slope_sigma = std::sqrt(rest / (n - 2.0) / tt);
  const double over_s = blocks_.back().time_s - blocks_.front().time_s + kBlockS;
  if (std::abs(slope) * over_s < kLeastChange * g || std::abs(slope) < kStandardErrors * slope_sigma)
    return std::nullopt;
  const double share_per_s = slope / Now();
  return SlowDrift{share_per_s * kHourS, over_s, kTenth / std::abs(share_per_s)};
}

}  // namespace elbowroom::recon
