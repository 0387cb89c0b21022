#include "recon/synthetic/sensor_noise.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace elbowroom::recon {
namespace {

constexpr unsigned kQuantileBits = 14;
constexpr std::size_t kQuantiles = std::size_t{1} << kQuantileBits;

// SplitMix64 (Steele, Lea, Flood 2014): the output of a 64-bit counter.
std::uint64_t Mixed(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}
constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;

// x with P(standard normal < x) = p, by bisection.
double NormalQuantile(double p) {
  double low = -10.0;
  double high = 10.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::numbers::sqrt2) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

const std::vector<float>& Quantiles() {
  static const std::vector<float> quantiles = [] {
    std::vector<float> values(kQuantiles);
    for (std::size_t i = 0; i < kQuantiles / 2; ++i) {
      const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(kQuantiles);
      values[i] = static_cast<float>(NormalQuantile(p));
      values[kQuantiles - 1 - i] = -values[i];
    }
    return values;
  }();
  return quantiles;
}

}  // namespace

std::uint64_t StreamSeed(std::uint64_t seed, std::int64_t frame, std::uint64_t camera, std::uint64_t row) {
  std::uint64_t mixed = Mixed(seed + kStep);
  for (const std::uint64_t part : {static_cast<std::uint64_t>(frame), camera, row}) {
    mixed = Mixed(mixed ^ (part + kStep));
  }
  return mixed;
}

double UniformFrom(std::uint64_t stream_seed) {
  return static_cast<double>(Mixed(stream_seed + kStep) >> 11U) * 0x1.0p-53;
}

void DrawRowNoise(std::uint64_t stream_seed, std::span<float> draws) {
  const float* const quantiles = Quantiles().data();
  std::uint64_t state = stream_seed;
  for (std::size_t i = 0; i + 2 < draws.size(); i += 3) {
    state += kStep;
    std::uint64_t bits = Mixed(state);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      draws[i + channel] = quantiles[bits & (kQuantiles - 1)];
      bits >>= kQuantileBits;
    }
  }
}

}  // namespace elbowroom::recon
