#include "recon/segmentation/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "recon/segmentation/coverage_kernel.h"

namespace elbowroom::recon {
namespace {

// In bytes, so that the table of all steps stays small.
struct Offset {
  std::int8_t x = 0, y = 0;
  bool operator==(const Offset&) const = default;
};

// From background to object: first moments of the labels of 5 x 5 pixels.
struct Direction {
  int x = 0, y = 0;
};

// One to three pixels along a direction, rounded to pixels; zero without a direction.
struct Steps {
  std::array<Offset, 3> to;
  Offset axis{1, 0};  // across the boundary, as nearly as a row or a column can be
};

constexpr int kMostMoment = 15;  // of 5 x 5 labels
constexpr int kMoments = 2 * kMostMoment + 1;
using StepTable = std::array<Steps, static_cast<std::size_t>(kMoments* kMoments)>;
std::size_t StepIndex(Direction direction) {
  return static_cast<std::size_t>((direction.y + kMostMoment) * kMoments + direction.x + kMostMoment);
}

Steps StepsAlong(Direction direction) {
  if (direction.x == 0 && direction.y == 0) return {};
  const double length = std::hypot(direction.x, direction.y);
  const auto step = [&](double steps) {
    return Offset{static_cast<std::int8_t>(std::lround(steps * direction.x / length)),
                  static_cast<std::int8_t>(std::lround(steps * direction.y / length))};
  };
  const bool is_along_x = std::abs(direction.x) >= std::abs(direction.y);
  return {{step(1.0), step(2.0), step(3.0)}, is_along_x ? Offset{1, 0} : Offset{0, 1}};
}

StepTable AllSteps() {
  StepTable made;
  for (int y = -kMostMoment; y <= kMostMoment; ++y)
    for (int x = -kMostMoment; x <= kMostMoment; ++x) made[StepIndex({x, y})] = StepsAlong({x, y});
  return made;
}

// Five pixels of a row as bits; those beyond the picture repeat its edge.
unsigned FiveAtEdge(const std::uint64_t* row, int x, int width) {
  unsigned bits = 0;
  for (int i = 0; i < 5; ++i) {
    const auto at = static_cast<unsigned>(std::clamp(x - 2 + i, 0, width - 1));
    bits |= (static_cast<unsigned>(row[at >> 6U] >> (at & 63U)) & 1U) << static_cast<unsigned>(i);
  }
  return bits;
}

struct Five {
  int count = 0, moment = 0;
};
constexpr std::array<Five, 32> kFives = [] {
  std::array<Five, 32> fives{};
  for (unsigned bits = 0; bits < 32; ++bits) {
    for (int i = 0; i < 5; ++i) {
      const int bit = static_cast<int>(bits >> static_cast<unsigned>(i)) & 1;
      fives[bits].count += bit;
      fives[bits].moment += bit * (i - 2);
    }
  }
  return fives;
}();

Direction Inwards(const core::BitMask& mask, int x, int y) {
  const std::size_t per_row = mask.words_per_row();
  const auto row_at = [&](int v) { return mask.words().data() + static_cast<std::size_t>(v) * per_row; };
  Direction gradient;
  const auto add = [&](unsigned five, int dy) {
    gradient.x += kFives[five].moment;
    gradient.y += dy * kFives[five].count;
  };
  if (x < 2 || x + 2 >= mask.width_px() || y < 2 || y + 2 >= mask.height_px()) {
    for (int dy = -2; dy <= 2; ++dy)
      add(FiveAtEdge(row_at(std::clamp(y + dy, 0, mask.height_px() - 1)), x, mask.width_px()), dy);
    return gradient;
  }
  const auto first = static_cast<unsigned>(x - 2), last = first + 4;
  const unsigned shift = first & 63U;
  const std::uint64_t* low = row_at(y - 2) + (first >> 6U);
  const std::uint64_t* high = row_at(y - 2) + (last >> 6U);  // the same word, or the next one
  for (int dy = -2; dy <= 2; ++dy, low += per_row, high += per_row)
    add(static_cast<unsigned>((*low >> shift) | (*high << 1U << (63U - shift))) & 31U, dy);
  return gradient;
}

PixelPlace Moved(PixelPlace p, Offset by) { return {p.x + by.x, p.y + by.y}; }
PixelPlace MovedBack(PixelPlace p, Offset by) { return {p.x - by.x, p.y - by.y}; }

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
                                     const cv::Mat& packed_mean, double least_contrast_levels)
    : detected_(detected),
      image_(image_bgr.data),
      image_stride_(image_bgr.step[0]),
      mean_(reinterpret_cast<const std::uint32_t*>(packed_mean.data)),
      mean_stride_(packed_mean.step[0] / sizeof(std::uint32_t)),
      width_(detected.width_px()),
      height_(detected.height_px()),
      least_contrast2_(static_cast<float>(least_contrast_levels * least_contrast_levels)) {
  core::Require(image_bgr.type() == CV_8UC3 && packed_mean.type() == CV_32SC1 &&
                    image_bgr.size() == cv::Size(width_, height_) && packed_mean.size() == image_bgr.size(),
                "coverage is estimated in an 8-bit BGR picture of its mask's and packed mean's size");
}

// The object pixel among 3 x 3 that differs most from the background: for objects without an interior.
std::uint32_t CoverageEstimator::StrongestAround(PixelPlace place) const {
  std::uint32_t strongest = Image(place);
  int most = -1;
  for (int y = place.y - 1; y <= place.y + 1; ++y) {
    for (int x = place.x - 1; x <= place.x + 1; ++x) {
      if (!IsObject({x, y})) continue;
      const int difference2 = Difference2(Image({x, y}), Mean({x, y}));
      if (difference2 <= most) continue;
      most = difference2;
      strongest = Image({x, y});
    }
  }
  return strongest;
}

void CoverageEstimator::ReadObject(PixelPlace place, PixelPlace first, PixelPlace second, std::size_t i,
                                   CoverageSamples* samples) const {
  const bool has_interior = !(first.x == place.x && first.y == place.y) && IsObject(first);
  samples->near[i] = has_interior ? Image(first) : StrongestAround(place);
  samples->far[i] = has_interior && IsObject(second) ? Image(second) : samples->near[i];
}

void CoverageEstimator::Read(PixelPlace place, std::size_t i, CoverageSamples* samples) const {
  static const StepTable kSteps = AllSteps();
  const Steps& steps = kSteps[StepIndex(Inwards(detected_, place.x, place.y))];
  const auto read = [&](PixelPlace at, CoverageSamples::Pair* pair) {
    pair->image[i] = Image(at), pair->mean[i] = Mean(at);
  };
  read(place, &samples->here);
  // The neighbours across the boundary, along the row or column that crosses it more steeply. Past the
  // picture's edge the pixel itself is taken.
  const PixelPlace before = MovedBack(place, steps.axis), after = Moved(place, steps.axis);
  read(IsPixel(before) ? before : place, &samples->before);
  read(IsPixel(after) ? after : place, &samples->after);
  // The light is measured at two background pixels outwards. `kept` is all ones as long as they are
  // background pixels of the picture, and zero, which makes them black, from the first that isn't; without a
  // direction it is zero from the start. It is a mask, since a branch would often be mispredicted.
  std::uint32_t kept = steps.to[1] == Offset{} ? 0 : ~std::uint32_t{0};
  for (std::size_t k = 0; k < 2; ++k) {
    const PixelPlace outwards = MovedBack(place, steps.to[k + 1]);
    const bool is_pixel = IsPixel(outwards);
    const PixelPlace at = is_pixel ? outwards : place;
    kept = is_pixel ? kept & (static_cast<std::uint32_t>(detected_.At(at.x, at.y)) - 1U) : 0;
    samples->light[k].image[i] = Image(at) & kept;
    samples->light[k].mean[i] = Mean(at) & kept;
  }
  const std::size_t first = detected_.At(place.x, place.y) ? 0 : 1;
  ReadObject(place, Moved(place, steps.to[first]), Moved(place, steps.to[first + 1]), i, samples);
}

void CoverageEstimator::Estimate(std::span<const PixelPlace> places, std::span<Coverage> coverages) const {
  constexpr std::size_t kBatch = CoverageSamples::kBatch;
  core::Require(places.size() == coverages.size(), "one coverage a place");
  CoverageSamples samples;
  std::array<std::uint32_t, kBatch> levels;
  for (std::size_t begin = 0; begin < places.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, places.size() - begin);
    for (std::size_t i = 0; i < count; ++i) Read(places[begin + i], i, &samples);
    ReckonCoverage(samples, least_contrast2_, count, &levels);
    for (std::size_t i = 0; i < count; ++i)
      coverages[begin + i] = {static_cast<std::uint8_t>(levels[i] & 255U), levels[i] >= kCoverageKnown};
  }
}

}  // namespace elbowroom::recon
