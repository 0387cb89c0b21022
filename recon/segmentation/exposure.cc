#include "recon/segmentation/exposure.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr double kGainOne = 1 << FixedExposure::kGainBits;
constexpr double kOffsetOne = 1 << FixedExposure::kOffsetBits;

}  // namespace

FixedExposure::FixedExposure(const ExposureChange& change) {
  for (std::size_t c = 0; c < 3; ++c) {
    core::Require(std::isfinite(change.gain[c]) && std::isfinite(change.offset_levels[c]),
                  "gain and offset are numbers");
    gain[c] =
        static_cast<std::int16_t>(std::lround(kGainOne * std::clamp(change.gain[c], kLeastGain, kMostGain)));
    offset[c] = static_cast<std::int16_t>(
        std::lround(kOffsetOne * std::clamp(change.offset_levels[c], -kMostOffsetLevels, kMostOffsetLevels)));
  }
}

double FixedExposure::Gain(std::size_t channel) const { return gain.at(channel) / kGainOne; }
double FixedExposure::OffsetLevels(std::size_t channel) const { return offset.at(channel) / kOffsetOne; }

std::uint32_t WithExposure(std::uint32_t packed_mean, const FixedExposure& exposure) {
  std::uint32_t changed = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const unsigned shift = 10U * static_cast<unsigned>(c);
    const int quarters = static_cast<int>((packed_mean >> shift) & 1023U);
    const int sum = quarters * exposure.gain[c] + exposure.offset[c] * (1 << kQuarterOffsetShift) +
                    (1 << (FixedExposure::kGainBits - 1));
    const int rounded = std::clamp(sum >> FixedExposure::kGainBits, 0, kMostQuarters);
    changed |= static_cast<std::uint32_t>(rounded) << shift;
  }
  return changed;
}

}  // namespace elbowroom::recon
