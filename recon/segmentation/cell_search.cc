#include "recon/segmentation/cell_search.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

namespace elbowroom::recon {
namespace {

// The pixels between those that are looked at: rows 1 to 3 of a cell, from pixel 42 to pixel 21 of the next
// one. A region that holds no pixel that is looked at lies within such a gap, so it has at most
// kMostSkippedPx pixels.
constexpr int kSkippedOfRowPx = 64 - (kLookToPx - kLookFromPx);
constexpr int kMostSkippedPx = (kCellRows - 1) * kSkippedOfRowPx;

constexpr int kStripCells = 30;  // rows of cells

class CellSearch {
 public:
  CellSearch(std::size_t width_px, std::size_t height_px, const CellKernel& kernel)
      : kernel_(kernel),
        height_px_(height_px),
        full_(width_px / 64),
        across_((width_px + 63) / 64),
        down_((height_px + kCellRows - 1) / kCellRows) {}

  void All() const {
    for (std::size_t group = 0; group < down_; ++group)
      for (std::size_t word = 0; word < across_; ++word) (void)kernel_.differ_in(group, word);
  }

  // Visits the cells in which a pixel that is looked at differs, and from there on all cells that adjoin one
  // with a differing pixel. So a region that has a pixel that is looked at is found as a whole.
  [[nodiscard]] std::int64_t Large() && {
    is_known_.assign(down_ * across_, 0);
    const std::vector<std::uint64_t> hits = Look();
    for (std::size_t group = 0; group < down_; ++group) VisitHits(group, hits);
    while (!waiting_.empty()) {
      const Cell cell = waiting_.back();
      waiting_.pop_back();
      Visit(cell);
    }
    return unseen_px_;
  }

 private:
  struct Cell {
    std::size_t group, word;
  };

  [[nodiscard]] std::size_t HitWords() const { return (across_ + 63) / 64; }

  // A row of bits for each row of cells. Strips are looked at in parallel, since reading is all that an empty
  // table costs. They are small, since a thread may start late.
  [[nodiscard]] std::vector<std::uint64_t> Look() const {
    std::vector<std::uint64_t> hits(down_ * HitWords());
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, down_, kStripCells),
        [&](const tbb::blocked_range<std::size_t>& strip) {
          for (std::size_t group = strip.begin(); group < strip.end(); ++group)
            kernel_.look_at(group, hits.data() + group * HitWords());
        },
        tbb::simple_partitioner());
    return hits;
  }

  void VisitHits(std::size_t group, const std::vector<std::uint64_t>& hits) {
    unseen_px_ += UnseenOfCellPx(group) * static_cast<std::int64_t>(full_);
    const auto visit = [&](std::size_t word) {
      if (BecomesKnown({group, word})) Visit({group, word});
    };
    for (std::size_t i = 0; i < HitWords(); ++i)
      for (std::uint64_t left = hits[group * HitWords() + i]; left != 0; left &= left - 1)
        visit(64 * i + static_cast<std::size_t>(std::countr_zero(left)));
    if (full_ < across_) visit(full_);  // CellKernel::look_at leaves it out
  }

  [[nodiscard]] std::int64_t UnseenOfCellPx(std::size_t group) const {
    const std::size_t rows = std::min<std::size_t>(kCellRows, height_px_ - group * kCellRows);
    return kSkippedOfRowPx * (static_cast<std::int64_t>(rows) - 1);
  }

  // False if the cell was known before. A known cell is visited, or waits for it.
  [[nodiscard]] bool BecomesKnown(const Cell& cell) {
    return std::exchange(is_known_[cell.group * across_ + cell.word], std::uint8_t{1}) == 0;
  }

  void Visit(const Cell& cell) {
    if (cell.word < full_) unseen_px_ -= UnseenOfCellPx(cell.group);
    if (!kernel_.differ_in(cell.group, cell.word)) return;
    const std::size_t left = cell.word - std::min<std::size_t>(cell.word, 1);
    const std::size_t right = std::min(cell.word + 1, across_ - 1);
    for (std::size_t group = cell.group - std::min<std::size_t>(cell.group, 1);
         group <= std::min(cell.group + 1, down_ - 1); ++group)
      for (std::size_t word = left; word <= right; ++word)
        if (BecomesKnown({group, word})) waiting_.push_back({group, word});
  }

  const CellKernel& kernel_;
  const std::size_t height_px_, full_, across_, down_;  // cells; `full_` have all 64 columns
  std::vector<Cell> waiting_;
  std::vector<std::uint8_t> is_known_;  // for each cell
  std::int64_t unseen_px_ = 0;
};

}  // namespace

std::int64_t SearchCells(std::size_t width_px, std::size_t height_px, const CellKernel& kernel,
                         int least_px) {
  CellSearch search(width_px, height_px, kernel);
  if (least_px > kMostSkippedPx) return std::move(search).Large();
  search.All();
  return 0;
}

}  // namespace elbowroom::recon
