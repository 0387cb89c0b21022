#include "recon/segmentation/coverage.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "core/error.h"
#include "recon/segmentation/coverage_kernel.h"
#include "recon/segmentation/coverage_reading.h"

namespace elbowroom::recon {
namespace {

// Squared difference of a picture's colour and a mean's, in quarters of a level.
int Difference2(std::uint32_t image, std::uint32_t mean) {
  int sum = 0;
  for (unsigned c = 0; c < 3; ++c) {
    const int difference =
        static_cast<int>(((image >> 8U * c) & 255U) * 4U) - static_cast<int>((mean >> 10U * c) & 1023U);
    sum += difference * difference;
  }
  return sum;
}

}  // namespace

cv::Mat PackedMean(const cv::Mat& mean_bgr) {
  core::Require(mean_bgr.type() == CV_32FC3, "a background's mean is CV_32FC3");
  cv::Mat packed(mean_bgr.size(), CV_32SC1);
  for (int y = 0; y < mean_bgr.rows; ++y) {
    const auto* mean = mean_bgr.ptr<float>(y);
    auto* out = packed.ptr<std::int32_t>(y);
    const auto quarters = [&](int i) {
      const float half_more = 4.0F * mean[i] + 0.5F;  // positive: cut off, it is the nearest number
      return static_cast<std::int32_t>(half_more);
    };
    for (int x = 0; x < mean_bgr.cols; ++x)
      out[x] = quarters(3 * x) | quarters(3 * x + 1) << 10 | quarters(3 * x + 2) << 20;
  }
  return packed;
}

CoverageEstimator::CoverageEstimator(const core::BitMask& detected, const cv::Mat& image_bgr,
                                     const cv::Mat& packed_mean, double least_contrast_levels,
                                     const FixedExposure* exposure)
    : least_contrast2_(static_cast<float>(least_contrast_levels * least_contrast_levels)) {
  const cv::Size size(detected.width_px(), detected.height_px());
  core::Require(image_bgr.type() == CV_8UC3 && packed_mean.type() == CV_32SC1 && image_bgr.size() == size &&
                    packed_mean.size() == size,
                "coverage is estimated in an 8-bit BGR picture of its mask's and packed mean's size");
  const auto rows = static_cast<std::size_t>(std::max(size.height, 1));
  core::Require(std::max(image_bgr.step[0], packed_mean.step[0]) <= std::numeric_limits<int>::max() / rows,
                "a picture has less than 2 GiB");  // places are reckoned in 32 bits
  picture_ = {&detected,
              image_bgr.data,
              static_cast<int>(image_bgr.step[0]),
              reinterpret_cast<const std::uint32_t*>(packed_mean.data),
              static_cast<int>(packed_mean.step[0] / sizeof(std::uint32_t)),
              exposure};
}

// The object pixel among 3 x 3 that differs most from the background: for objects without an interior.
std::uint32_t CoverageEstimator::StrongestAround(PixelPlace place) const {
  const core::BitMask& detected = *picture_.detected;
  std::uint32_t strongest = Image(place.x, place.y);
  int most = -1;
  for (int y = std::max(place.y - 1, 0); y <= std::min(place.y + 1, detected.height_px() - 1); ++y) {
    for (int x = std::max(place.x - 1, 0); x <= std::min(place.x + 1, detected.width_px() - 1); ++x) {
      if (!detected.At(x, y)) continue;
      const int difference2 = Difference2(Image(x, y), Mean(x, y));
      if (difference2 <= most) continue;
      most = difference2;
      strongest = Image(x, y);
    }
  }
  return strongest;
}

void CoverageEstimator::ReadStrongest(std::span<const PixelPlace> places, std::uint64_t which,
                                      CoverageSamples* samples) const {
  for (; which != 0; which &= which - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(which));
    samples->near[i] = samples->far[i] = StrongestAround(places[i]);
  }
}

void CoverageEstimator::Estimate(std::span<const PixelPlace> places, std::span<std::uint32_t> levels) const {
  constexpr std::size_t kBatch = CoverageSamples::kBatch;
  core::Require(places.size() == levels.size(), "one level a place");
  CoverageSamples samples;
  for (std::size_t begin = 0; begin < places.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, places.size() - begin);
    std::array<PixelPlace, kBatch> rest;
    const PixelPlace* batch = places.data() + begin;
    if (count < kBatch) {  // vectors read whole batches
      rest.fill(places[begin]);
      std::copy_n(batch, count, rest.begin());
      batch = rest.data();
    }
    ReadStrongest({batch, count}, ReadSamples(picture_, batch, count, &samples), &samples);
    ReckonCoverage(samples, least_contrast2_, levels.subspan(begin, count));
  }
}

}  // namespace elbowroom::recon
