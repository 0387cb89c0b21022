// Reproducible image noise: a function of (seed, frame, camera, row) alone, whatever thread asks.
#pragma once

#include <cstdint>

#include "core/ids.h"

namespace elbowroom::recon {

// Mixes the numbers that identify a random stream into its seed.
[[nodiscard]] std::uint64_t StreamSeed(std::uint64_t seed, std::int64_t frame, std::uint64_t camera,
                                       std::uint64_t row);

// Uniform in [0, 1).
[[nodiscard]] double UniformFrom(std::uint64_t stream_seed);

// One row's worth of standard normal numbers, three at a time; drawn from 16,384 quantiles (|value| < 4.02).
class RowNoise {
 public:
  explicit RowNoise(std::uint64_t stream_seed) : state_(stream_seed) {}
  void Next(float (&bgr)[3]);

 private:
  std::uint64_t state_;
};

}  // namespace elbowroom::recon
