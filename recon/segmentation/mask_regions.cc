#include "recon/segmentation/mask_regions.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

std::uint64_t BitsFrom(int first) { return ~std::uint64_t{0} << static_cast<unsigned>(first); }

// The words of a mask that hold object: rows [top, bottom), words [first, last) of each.
struct ObjectWords {
  int top = 0, bottom = 0;
  std::size_t first = 0, last = 0;
};

// Calls visit(x0, x1) for each run of `value` in a row of `width` pixels, from the left. Words outside of
// [first, last) are known to be background.
template <typename Visit>
void ForEachRun(const std::uint64_t* row, int width, const ObjectWords& object, bool value, Visit visit) {
  const std::uint64_t flip = value ? 0 : ~std::uint64_t{0};
  int begin = !value && object.first > 0 ? 0 : -1;  // of the run that is open
  int x = static_cast<int>(object.first * 64);
  const auto visit_edges = [&](std::uint64_t bits) {
    // A bit where a run begins or ends.
    for (std::uint64_t edges = bits ^ ((bits << 1U) | (begin >= 0 ? 1U : 0U)); edges != 0;
         edges &= edges - 1) {
      const int at = x + std::countr_zero(edges);
      if (begin < 0) {
        begin = at;
      } else {
        visit(begin, at);
        begin = -1;
      }
    }
  };
  for (std::size_t i = object.first; i < object.last; ++i, x += 64) {
    const std::uint64_t bits = row[i] ^ flip;
    visit_edges(width - x < 64 ? bits & ~BitsFrom(width - x) : bits);
  }
  if (x < width && !value && begin < 0) begin = x;
  if (x < width && value && begin >= 0) visit(begin, x), begin = -1;
  if (begin >= 0) visit(begin, width);
}

// Sets or clears pixels [x0, x1) of a row.
void Fill(std::uint64_t* row, int x0, int x1, bool value) {
  for (int word = x0 / 64; word * 64 < x1; ++word) {
    std::uint64_t bits = ~std::uint64_t{0};
    if (word == x0 / 64) bits &= BitsFrom(x0 % 64);
    if (x1 - word * 64 < 64) bits &= ~BitsFrom(x1 - word * 64);
    row[word] = value ? row[word] | bits : row[word] & ~bits;
  }
}

std::uint64_t* RowOf(core::BitMask& mask, int y) {
  return mask.words().data() + static_cast<std::size_t>(y) * mask.words_per_row();
}
const std::uint64_t* RowOf(const core::BitMask& mask, int y) {
  return mask.words().data() + static_cast<std::size_t>(y) * mask.words_per_row();
}

ObjectWords ObjectWordsOf(const core::BitMask& mask) {
  const auto words = mask.words();
  const auto is_object = [](std::uint64_t word) { return word != 0; };
  const auto found = std::ranges::find_if(words, is_object);
  if (found == words.end()) return {};
  const auto found_last = std::find_if(words.rbegin(), words.rend(), is_object);
  const auto per_row = static_cast<std::ptrdiff_t>(mask.words_per_row());
  ObjectWords object{static_cast<int>((found - words.begin()) / per_row),
                     static_cast<int>((words.rend() - found_last - 1) / per_row) + 1, 0, 0};
  std::vector<std::uint64_t> any(mask.words_per_row());
  for (int y = object.top; y < object.bottom; ++y) {
    const std::uint64_t* row = RowOf(mask, y);
    for (std::size_t i = 0; i < any.size(); ++i) any[i] |= row[i];
  }
  object.first = static_cast<std::size_t>(std::ranges::find_if(any, is_object) - any.begin());
  object.last = static_cast<std::size_t>(any.rend() - std::find_if(any.rbegin(), any.rend(), is_object));
  return object;
}

// Union-find over runs; the root of a region is its first run.
class RunForest {
 public:
  RunForest(const core::BitMask& mask, bool value, const ObjectWords& object) {
    runs_.reserve(static_cast<std::size_t>(object.bottom - object.top) * 4);
    row_begin_.reserve(static_cast<std::size_t>(object.bottom - object.top) + 1);
    for (int y = object.top; y < object.bottom; ++y) {
      row_begin_.push_back(runs_.size());
      const std::uint64_t* row = RowOf(mask, y);
      ForEachRun(row, mask.width_px(), object, value, [&](int x0, int x1) {
        runs_.push_back({y, x0, x1, static_cast<std::uint32_t>(runs_.size())});
      });
    }
    row_begin_.push_back(runs_.size());
  }

  // Joins runs of adjoining rows that overlap, or (reach 1) touch at a corner.
  void Join(int reach) {
    for (std::size_t row = 1; row + 1 < row_begin_.size(); ++row) {
      std::size_t above = row_begin_[row - 1];
      for (std::size_t i = row_begin_[row]; i < row_begin_[row + 1]; ++i) {
        while (above < row_begin_[row] && runs_[above].x1 + reach <= runs_[i].x0) ++above;
        for (std::size_t j = above; j < row_begin_[row] && runs_[j].x0 < runs_[i].x1 + reach; ++j)
          Unite(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
      }
    }
  }

  // Numbers the regions in the order of their first runs.
  [[nodiscard]] Regions Take() && {
    Regions regions;
    for (std::uint32_t i = 0; i < runs_.size(); ++i) {
      // A link points to an earlier run, which has its region's number already.
      Run& run = runs_[i];
      if (run.region == i) {
        run.region = static_cast<std::uint32_t>(regions.area_px.size());
        regions.area_px.push_back(0);
      } else {
        run.region = runs_[run.region].region;
      }
      regions.area_px[run.region] += run.x1 - run.x0;
    }
    regions.runs = std::move(runs_);
    return regions;
  }

 private:
  std::uint32_t Root(std::uint32_t i) {
    while (runs_[i].region != i) {
      runs_[i].region = runs_[runs_[i].region].region;
      i = runs_[i].region;
    }
    return i;
  }

  void Unite(std::uint32_t a, std::uint32_t b) {
    a = Root(a), b = Root(b);
    runs_[std::max(a, b)].region = std::min(a, b);
  }

  std::vector<Run> runs_;  // region: a run of the same region that comes before, or itself
  std::vector<std::size_t> row_begin_;
};

}  // namespace

Regions ObjectRegions(const core::BitMask& mask) {
  RunForest forest(mask, true, ObjectWordsOf(mask));
  forest.Join(1);
  return std::move(forest).Take();
}

void ClearRegions(core::BitMask& mask, const Regions& regions, const std::vector<bool>& keep) {
  core::Require(keep.size() == regions.area_px.size(), "one decision a region");
  for (const Run& run : regions.runs) {
    if (!keep[run.region]) Fill(RowOf(mask, run.y), run.x0, run.x1, false);
  }
}

void RemoveSmallBlobs(core::BitMask& mask, int least_px) {
  if (least_px <= 1) return;
  const Regions regions = ObjectRegions(mask);
  std::vector<bool> keep;
  keep.reserve(regions.area_px.size());
  for (const std::int64_t area_px : regions.area_px) keep.push_back(area_px >= least_px);
  ClearRegions(mask, regions, keep);
}

void FillSmallHoles(core::BitMask& mask, int least_px) {
  if (least_px <= 1) return;
  ObjectWords object = ObjectWordsOf(mask);
  if (object.top == object.bottom) return;
  // One row of background above and one below stand for all such rows.
  object.top = std::max(object.top - 1, 0);
  object.bottom = std::min(object.bottom + 1, mask.height_px());
  RunForest forest(mask, false, object);
  forest.Join(0);
  Regions regions = std::move(forest).Take();
  const std::int64_t width = mask.width_px();
  const auto count_rows = [&](int begin, int end, std::uint32_t region) {
    if (begin == end) return;
    regions.area_px[region] += width * (end - begin);
    for (int y = begin; y < end; ++y) regions.runs.push_back({y, 0, mask.width_px(), region});
  };
  const std::uint32_t below = regions.runs.empty() ? 0 : regions.runs.back().region;
  count_rows(0, object.top, regions.runs.empty() ? 0 : regions.runs.front().region);
  count_rows(object.bottom, mask.height_px(), below);
  for (const Run& run : regions.runs) {
    if (regions.area_px[run.region] < least_px) Fill(RowOf(mask, run.y), run.x0, run.x1, true);
  }
}

}  // namespace elbowroom::recon
