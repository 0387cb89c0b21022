// The pixels that coverage is computed from, read for many boundary pixels at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/bit_mask.h"
#include "recon/segmentation/coverage_kernel.h"
#include "recon/segmentation/exposure.h"

namespace elbowroom::recon {

struct PixelPlace {
  int x = 0;
  int y = 0;
};

// A picture with the background's mean and the pixels that were detected in it, all of one size.
struct CoveragePicture {
  const core::BitMask* detected = nullptr;
  const std::uint8_t* image = nullptr;      // three bytes a pixel
  int image_stride = 0;                     // bytes
  const std::uint32_t* mean = nullptr;      // as PackedMean
  int mean_stride = 0;                      // pixels
  const FixedExposure* exposure = nullptr;  // null: the mean is as measured
};

// Reads what CoverageSamples holds for the first `count` of kBatch places. Every place must be a pixel, also
// those from `count` on, since vectors are read whole. Bit i of the result: place i has no object pixel one
// step inwards, so that the caller must find the colours samples->near[i] and samples->far[i]. The same for
// every instruction set (tests/recon/segmentation/difference_kernel_test.cc).
[[nodiscard]] std::uint64_t ReadSamples(const CoveragePicture& picture, const PixelPlace* places,
                                        std::size_t count, CoverageSamples* samples);

}  // namespace elbowroom::recon
