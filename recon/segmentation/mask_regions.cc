#include "recon/segmentation/mask_regions.h"

#include <algorithm>
#include <bit>
#include <opencv2/core/types.hpp>
#include <span>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

std::uint64_t BitsFrom(int first) { return ~std::uint64_t{0} << static_cast<unsigned>(first); }

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

// Most words hold no object, so only the others cost more than a comparison.
std::vector<Run> ObjectRuns(const core::BitMask& mask) {
  const auto words = mask.words();
  std::vector<Run> runs;
  runs.reserve(static_cast<std::size_t>(mask.height_px()) * 2);
  Run* last = nullptr;
  std::size_t row_begin = 0;
  int y = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == 0) continue;
    for (; i >= row_begin + mask.words_per_row(); ++y) row_begin += mask.words_per_row();
    const int x = static_cast<int>(i - row_begin) * 64;
    for (std::uint64_t left = words[i]; left != 0;) {
      const int begin = std::countr_zero(left);
      const int end = begin + std::countr_one(left >> static_cast<unsigned>(begin));
      if (last != nullptr && last->y == y && last->x1 == x + begin) {  // goes on from the word before
        last->x1 = x + end;
      } else {
        last = &runs.emplace_back(Run{y, x + begin, x + end, 0});
      }
      left = end < 64 ? left & BitsFrom(end) : 0;
    }
  }
  return runs;
}

// Union-find over runs; the root of a region is its first run.
class RunForest {
 public:
  // Runs by row, then from the left.
  explicit RunForest(std::vector<Run> runs) : runs_(std::move(runs)) {
    for (std::uint32_t i = 0; i < runs_.size(); ++i) runs_[i].region = i;
  }

  // Joins runs of adjoining rows that overlap, or (reach 1) touch at a corner.
  void Join(int reach) {
    std::uint32_t above = 0;  // the first run of the row above that isn't to the left
    for (std::uint32_t i = 0; i < runs_.size(); ++i) {
      const Run run = runs_[i];
      const auto is_before = [&](const Run& other) {
        return other.y < run.y - 1 || (other.y == run.y - 1 && other.x1 + reach <= run.x0);
      };
      while (is_before(runs_[above])) ++above;  // ends at run i, if not earlier
      for (std::uint32_t j = above; runs_[j].y < run.y && runs_[j].x0 < run.x1 + reach; ++j) Unite(i, j);
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
};

// Calls visit(x0, x1) for each gap beside and between a row's runs of object.
template <typename Visit>
void ForEachGap(std::span<const Run> object, int width, Visit visit) {
  int x = 0;
  for (const Run& run : object) {
    if (run.x0 > x) visit(x, run.x0);
    x = run.x1;
  }
  if (x < width) visit(x, width);
}

// The background's runs that can decide which regions have fewer than `least_px` pixels. A gap of so many
// pixels in one row is in none of them. So only rows with a shorter gap matter, and the rows above and below
// these, where a longer gap may adjoin it.
std::vector<Run> DecidingGaps(std::span<const Run> object, const cv::Size& size, int least_px) {
  // The object's rows, one above and one below; all rows where even one without object is short.
  const bool is_wide = size.width >= least_px;
  const int top = is_wide ? std::max(object.front().y - 1, 0) : 0;
  const int bottom = is_wide ? std::min(object.back().y + 2, size.height) : size.height;
  std::vector<Run> gaps;
  const auto add = [&](std::span<const Run> of_row, int y) {
    ForEachGap(of_row, size.width, [&](int x0, int x1) { gaps.push_back({y, x0, x1, 0}); });
  };
  std::span<const Run> above;
  bool was_short = false, was_added = true;  // no row above the first
  for (int y = top; y < bottom; ++y) {
    std::size_t count = 0;
    while (count < object.size() && object[count].y == y) ++count;
    const std::span<const Run> here = object.first(count);
    bool is_short = false;
    ForEachGap(here, size.width, [&](int x0, int x1) { is_short |= x1 - x0 < least_px; });
    if (is_short && !was_added) add(above, y - 1);
    was_added = is_short || was_short;
    if (was_added) add(here, y);
    was_short = is_short;
    above = here;
    object = object.subspan(count);
  }
  return gaps;
}

// Fills the holes between runs of object.
void FillBetween(core::BitMask& mask, std::span<const Run> object, int least_px) {
  if (object.empty()) return;
  RunForest forest(DecidingGaps(object, {mask.width_px(), mask.height_px()}, least_px));
  forest.Join(0);
  const Regions regions = std::move(forest).Take();
  for (const Run& run : regions.runs) {
    if (regions.area_px[run.region] < least_px) Fill(RowOf(mask, run.y), run.x0, run.x1, true);
  }
}

}  // namespace

Regions ObjectRegions(const core::BitMask& mask) {
  RunForest forest(ObjectRuns(mask));
  forest.Join(1);
  return std::move(forest).Take();
}

void ClearRegions(core::BitMask& mask, const Regions& regions, const std::vector<bool>& keep) {
  core::Require(keep.size() == regions.area_px.size(), "one decision a region");
  for (const Run& run : regions.runs) {
    if (!keep[run.region]) Fill(RowOf(mask, run.y), run.x0, run.x1, false);
  }
}

void RemoveSmallBlobs(core::BitMask& mask, int least_px) { CleanUp(mask, least_px, 0); }

void FillSmallHoles(core::BitMask& mask, int least_px) { CleanUp(mask, 0, least_px); }

void CleanUp(core::BitMask& mask, int least_blob_px, int least_hole_px) {
  if (least_blob_px <= 1 && least_hole_px <= 1) return;
  std::vector<Run> object;
  if (least_blob_px > 1) {
    Regions regions = ObjectRegions(mask);
    std::erase_if(regions.runs, [&](const Run& run) {
      const bool is_small = regions.area_px[run.region] < least_blob_px;
      if (is_small) Fill(RowOf(mask, run.y), run.x0, run.x1, false);
      return is_small;
    });
    object = std::move(regions.runs);
  } else {
    object = ObjectRuns(mask);
  }
  if (least_hole_px > 1) FillBetween(mask, object, least_hole_px);
}

}  // namespace elbowroom::recon
