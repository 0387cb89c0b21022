#include "recon/segmentation/boundary.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "recon/segmentation/boundary_words.h"
#include "recon/segmentation/coverage.h"

namespace elbowroom::recon {
namespace {

constexpr int kRounds = 2;  // each moves the boundary by a pixel at most

// The rows that can hold the boundary in any round.
MaskRows RowsAround(const core::BitMask& mask) {
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

// The levels of pixels along the boundary, and the mask that follows from them.
class Locating {
 public:
  Locating(const core::BitMask& detected, const CoverageEstimator& estimator)
      : estimator_(estimator),
        rows_(RowsAround(detected)),
        mask_(detected),
        known_(static_cast<std::size_t>(rows_.end - rows_.begin) * detected.words_per_row()),
        // Not cleared, since only those of known pixels are read.
        levels_(std::make_unique_for_overwrite<std::uint8_t[]>(known_.size() * 64)) {}

  // The mask's boundary pixels, as it is now.
  [[nodiscard]] std::vector<PixelWord> Boundary() const { return BoundaryWords(mask_, rows_); }

  // Measures the pixels of `words` that aren't known yet. With may_move it also labels them by their
  // coverage.
  void Measure(std::span<const PixelWord> words, bool may_move);

  [[nodiscard]] std::uint64_t ObjectOf(const PixelWord& word) const {
    return mask_.words()[FromRow(word, 0)];
  }
  [[nodiscard]] core::SoftMask Take() &&;

 private:
  // The number of a word, counted from row `first` on.
  [[nodiscard]] std::size_t FromRow(const PixelWord& word, int first) const {
    return static_cast<std::size_t>(word.y - first) * mask_.words_per_row() +
           static_cast<std::size_t>(word.x) / 64;
  }
  [[nodiscard]] std::uint8_t* LevelsOf(const PixelWord& word) const {
    return levels_.get() + FromRow(word, rows_.begin) * 64;
  }
  void ListUnknown(std::span<const PixelWord> words);

  const CoverageEstimator& estimator_;
  MaskRows rows_;
  core::BitMask mask_;
  std::vector<std::uint64_t> known_;  // a word of pixels each, from rows_.begin on
  std::unique_ptr<std::uint8_t[]> levels_;
  // What is measured in one round: pixels by words, one by one, and their coverage.
  std::vector<PixelWord> unknown_;
  std::vector<PixelPlace> places_;
  std::vector<std::uint32_t> coverages_;
};

void Locating::ListUnknown(std::span<const PixelWord> words) {
  unknown_.clear(), places_.clear();
  for (const PixelWord& word : words) {
    std::uint64_t& known = known_[FromRow(word, rows_.begin)];
    const std::uint64_t unknown = word.bits & ~known;
    if (unknown == 0) continue;
    known |= unknown;
    unknown_.push_back({word.x, word.y, unknown});
    for (std::uint64_t bits = unknown; bits != 0; bits &= bits - 1)
      places_.push_back({word.x + std::countr_zero(bits), word.y});
  }
}

void Locating::Measure(std::span<const PixelWord> words, bool may_move) {
  constexpr std::uint32_t kHalfwayInside = 191, kHalfwayOutside = 64;  // where coverage isn't known
  ListUnknown(words);
  coverages_.resize(places_.size());
  estimator_.Estimate(places_, coverages_);
  auto next = coverages_.begin();
  for (const PixelWord& word : unknown_) {
    std::uint64_t& object = mask_.words()[FromRow(word, 0)];
    std::uint8_t* const levels = LevelsOf(word);
    std::uint64_t moved = 0;
    for (std::uint64_t bits = word.bits; bits != 0; bits &= bits - 1, ++next) {
      const int i = std::countr_zero(bits);
      const bool was_object = (object >> static_cast<unsigned>(i) & 1U) != 0;
      const std::uint32_t otherwise = was_object ? kHalfwayInside : kHalfwayOutside;
      const std::uint32_t level = *next >= kCoverageKnown ? *next - kCoverageKnown : otherwise;
      levels[i] = static_cast<std::uint8_t>(level);
      moved |= std::uint64_t{was_object != (level >= 128)} << static_cast<unsigned>(i);
    }
    if (may_move) object ^= moved;
  }
}

core::SoftMask Locating::Take() && {
  const std::vector<PixelWord> boundary = Boundary();
  Measure(boundary, false);
  core::SoftMask located;
  for (const PixelWord& word : boundary) {
    const std::uint64_t object = ObjectOf(word);
    const std::uint8_t* const levels = LevelsOf(word);
    for (std::uint64_t bits = word.bits; bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      const bool is_object = (object >> static_cast<unsigned>(i) & 1U) != 0;
      located.levels.push_back(is_object ? std::max<std::uint8_t>(levels[i], 128)
                                         : std::min<std::uint8_t>(levels[i], 127));
    }
  }
  located.mask = std::move(mask_);
  return located;
}

}  // namespace

core::SoftMask LocateBoundary(const core::BitMask& detected, const cv::Mat& image_bgr,
                              const cv::Mat& packed_mean, double least_contrast_levels,
                              const FixedExposure* exposure) {
  const CoverageEstimator estimator(detected, image_bgr, packed_mean, least_contrast_levels, exposure);
  Locating locating(detected, estimator);
  // The first round measures only object pixels along the boundary, since thresholds err outwards. The next
  // one measures both sides of the boundary that results.
  std::vector<PixelWord> boundary = locating.Boundary();
  for (PixelWord& word : boundary) word.bits &= locating.ObjectOf(word);
  for (int round = 0; round < kRounds; ++round) {
    locating.Measure(boundary, true);
    if (round + 1 < kRounds) boundary = locating.Boundary();
  }
  return std::move(locating).Take();
}

}  // namespace elbowroom::recon
