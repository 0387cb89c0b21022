#include "recon/segmentation/boundary.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/segmentation/coverage.h"

namespace elbowroom::recon {
namespace {

constexpr int kRounds = 2;  // each moves the boundary by a pixel at most

// Rows [begin, end) that can hold the boundary in any round.
struct Rows {
  int begin = 0;
  int end = 0;
};

Rows RowsAround(const core::BitMask& mask) {
  const auto words = mask.words();
  const auto is_object = [](std::uint64_t word) { return word != 0; };
  const auto first = std::ranges::find_if(words, is_object);
  if (first == words.end()) return {};
  const auto last = std::find_if(words.rbegin(), words.rend(), is_object);
  const auto per_row = static_cast<std::ptrdiff_t>(mask.words_per_row());
  const auto top = static_cast<int>((first - words.begin()) / per_row);
  const auto bottom = static_cast<int>((words.rend() - last - 1) / per_row);
  return {std::max(top - kRounds - 1, 0), std::min(bottom + kRounds + 2, mask.height_px())};
}

// Calls visit(x, y) for each object pixel of `mask` that isn't one of `done` yet, row by row from the left,
// and adds it to `done`.
template <typename Visit>
void ForEachPixel(const core::BitMask& mask, core::BitMask* done, Rows rows, Visit visit) {
  const std::size_t per_row = mask.words_per_row();
  std::size_t word = static_cast<std::size_t>(rows.begin) * per_row;
  const std::span<const std::uint64_t> words = mask.words();
  const std::span<std::uint64_t> done_words = done->words();
  for (int y = rows.begin; y < rows.end; ++y) {
    for (std::size_t i = 0; i < per_row; ++i, ++word) {
      if (words[word] == 0) continue;
      std::uint64_t bits = words[word] & ~done_words[word];
      done_words[word] |= bits;
      for (; bits != 0; bits &= bits - 1) visit(static_cast<int>(i * 64) + std::countr_zero(bits), y);
    }
  }
}

// The levels of pixels along the boundary, and the mask that follows from them.
class Locating {
 public:
  Locating(const core::BitMask& detected, const CoverageEstimator& estimator)
      : estimator_(estimator),
        rows_(RowsAround(detected)),
        mask_(detected),
        known_(detected.width_px(), detected.height_px()),
        // Not cleared, since only those of known pixels are read.
        levels_(std::make_unique_for_overwrite<std::uint8_t[]>(detected.words().size() * 64)) {}

  // Measures the pixels of `boundary` that aren't known yet. With may_move it also labels them by their
  // coverage.
  void Measure(const core::BitMask& boundary, bool may_move);

  [[nodiscard]] const core::BitMask& mask() const { return mask_; }
  [[nodiscard]] core::SoftMask Take() &&;

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(mask_.width_px()) +
           static_cast<std::size_t>(x);
  }

  const CoverageEstimator& estimator_;
  Rows rows_;
  core::BitMask mask_, known_;
  std::unique_ptr<std::uint8_t[]> levels_;
  std::vector<PixelPlace> places_;
  std::vector<Coverage> coverages_;
};

void Locating::Measure(const core::BitMask& boundary, bool may_move) {
  constexpr std::uint8_t kHalfwayInside = 191, kHalfwayOutside = 64;  // where coverage isn't known
  places_.clear();
  ForEachPixel(boundary, &known_, rows_, [&](int x, int y) { places_.push_back({x, y}); });
  coverages_.resize(places_.size());
  estimator_.Estimate(places_, coverages_);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto [x, y] = places_[i];
    const Coverage& coverage = coverages_[i];
    const bool was_object = mask_.At(x, y), is_object = coverage.level >= 128;
    if (coverage.is_known && may_move && was_object != is_object) mask_.Set(x, y, is_object);
    levels_[Index(x, y)] =
        coverage.is_known ? coverage.level : (was_object ? kHalfwayInside : kHalfwayOutside);
  }
}

core::SoftMask Locating::Take() && {
  const core::BitMask boundary = core::BoundaryPixels(mask_);
  Measure(boundary, false);
  core::SoftMask located;
  core::BitMask listed(mask_.width_px(), mask_.height_px());
  ForEachPixel(boundary, &listed, rows_, [&](int x, int y) {
    const std::uint8_t level = levels_[Index(x, y)];
    located.levels.push_back(mask_.At(x, y) ? std::max<std::uint8_t>(level, 128)
                                            : std::min<std::uint8_t>(level, 127));
  });
  located.mask = std::move(mask_);
  return located;
}

}  // namespace

core::SoftMask LocateBoundary(const core::BitMask& detected, const cv::Mat& image_bgr,
                              const cv::Mat& packed_mean, double least_contrast_levels) {
  const CoverageEstimator estimator(detected, image_bgr, packed_mean, least_contrast_levels);
  Locating locating(detected, estimator);
  // The first round measures only object pixels along the boundary, since thresholds err outwards. The next
  // one measures both sides of the boundary that results.
  core::BitMask boundary = core::BoundaryPixels(detected);
  for (std::size_t i = 0; i < boundary.words().size(); ++i) boundary.words()[i] &= detected.words()[i];
  for (int round = 0; round < kRounds; ++round) {
    locating.Measure(boundary, true);
    boundary = core::BoundaryPixels(locating.mask());
  }
  return std::move(locating).Take();
}

}  // namespace elbowroom::recon
