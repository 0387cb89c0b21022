// The arithmetic of coverage, many pixels at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace elbowroom::recon {

// The colours of up to kBatch boundary pixels and of the pixels that each is compared with. A picture's
// colour has blue in the lowest eight bits, then green, then red; a mean's is packed as by PackedMean.
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

// A level for each of the first levels.size() samples, as core::SoftMask has them: at least 128 where half of
// the pixel or more is object. kCoverageKnown is added where object and background differ enough for the
// level to mean something. The same bits for every instruction set
// (tests/recon/segmentation/difference_kernel_test.cc).
inline constexpr std::uint32_t kCoverageKnown = 256;
void ReckonCoverage(const CoverageSamples& samples, float least_contrast2, std::span<std::uint32_t> levels);

}  // namespace elbowroom::recon
