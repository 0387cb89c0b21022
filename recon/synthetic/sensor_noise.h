// Reproducible image noise: a function of (seed, frame, camera, row) alone, whatever thread asks.
#pragma once

#include <cstdint>
#include <span>

#include "core/ids.h"

namespace elbowroom::recon {

// Mixes the numbers that identify a random stream into its seed.
[[nodiscard]] std::uint64_t StreamSeed(std::uint64_t seed, std::int64_t frame, std::uint64_t camera,
                                       std::uint64_t row);

// Uniform in [0, 1).
[[nodiscard]] double UniformFrom(std::uint64_t stream_seed);

// Standard normal numbers, three to a pixel, drawn from 16,384 quantiles (|value| < 4.02). `draws` has a
// multiple of three places.
void DrawRowNoise(std::uint64_t stream_seed, std::span<float> draws);

}  // namespace elbowroom::recon
