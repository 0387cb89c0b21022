// The arithmetic of coverage, many pixels at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace elbowroom::recon {

// Colours of up to kBatch boundary pixels and of those that each is compared with. Of the picture: blue in
// the lowest eight bits, then green, then red. Of the mean: as PackedMean.
struct CoverageSamples {
  static constexpr std::size_t kBatch = 64;
  using Colors = std::array<std::uint32_t, kBatch>;
  struct Pair {
    alignas(64) Colors image{};
    alignas(64) Colors mean{};
  };
  Pair here, before, after;   // the pixel and its neighbours across the boundary
  std::array<Pair, 2> light;  // background outwards; black where there is none
  alignas(64) Colors near{};  // the object's colour at the rim
  alignas(64) Colors far{};   // and a pixel further in
};

// For each of the first `count` samples a level as core::SoftMask has them, at least 128 where at least half
// of the pixel is object; plus kCoverageKnown where object and background differ enough. The same for every
// instruction set (tests/recon/segmentation/difference_kernel_test.cc).
inline constexpr std::uint32_t kCoverageKnown = 256;
void ReckonCoverage(const CoverageSamples& samples, float least_contrast2, std::size_t count,
                    std::array<std::uint32_t, CoverageSamples::kBatch>* levels);

}  // namespace elbowroom::recon
