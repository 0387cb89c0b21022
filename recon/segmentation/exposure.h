// A change of light or exposure of a whole picture against its background reference.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace elbowroom::recon {

// image = gain * mean + offset_levels, a channel (blue, green, red).
struct ExposureChange {
  std::array<double, 3> gain{1.0, 1.0, 1.0};
  std::array<double, 3> offset_levels{0.0, 0.0, 0.0};
  // Of the background's pixels that were looked at: how many agree with it, in all channels.
  double agreeing_share = 1.0;
};

// The change that segmentation can follow. What lies outside is cut to it. The limits are narrow on purpose:
// a wider one would let an object that covers most of a dark background pass as a lamp four times as bright.
inline constexpr double kLeastGain = 0.5, kMostGain = 2.0;
inline constexpr double kMostOffsetLevels = 40.0;

// A change in whole numbers, as segmentation applies it: so every instruction set gives the same bits.
struct FixedExposure {
  static constexpr int kGainBits = 13;   // gain in 1 / 8192
  static constexpr int kOffsetBits = 4;  // offset in sixteenths of a level

  // Cuts the change to the limits above. Throws: PreconditionError for what isn't a number.
  explicit FixedExposure(const ExposureChange& change);

  // The factors that are applied, as numbers.
  [[nodiscard]] double Gain(std::size_t channel) const;
  [[nodiscard]] double OffsetLevels(std::size_t channel) const;

  std::array<std::int16_t, 3> gain{};
  std::array<std::int16_t, 3> offset{};
};

// A packed mean (PackedMean in recon/segmentation/coverage.h) after the change: gain * mean + offset, rounded
// to the nearest quarter of a level and cut to 0..255.75.
[[nodiscard]] std::uint32_t WithExposure(std::uint32_t packed_mean, const FixedExposure& exposure);

// A level to quarters: (q G + 2^11 O + 2^12) >> 13 for a gain of G / 2^13 and an offset of O / 16 levels.
inline constexpr int kQuarterOffsetShift = FixedExposure::kGainBits + 2 - FixedExposure::kOffsetBits;
inline constexpr int kMostQuarters = 1023;

}  // namespace elbowroom::recon
