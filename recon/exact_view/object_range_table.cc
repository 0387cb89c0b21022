#include "recon/exact_view/object_range_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/infinity.h"

namespace elbowroom::recon {
namespace {

constexpr std::size_t kIntervalsPerBin = 4;
constexpr std::size_t kFewestBins = 64;
constexpr std::size_t kMostTableBins = 1024;

using core::kInfinity;
constexpr OrderRange kNowhere{kInfinity, -kInfinity};

OrderRange Union(const OrderRange& a, const OrderRange& b) {
  return {std::min(a.first, b.first), std::max(a.last, b.last)};
}

}  // namespace

ObjectRangeTable::ObjectRangeTable(std::span<const float> begins, std::span<const OrderRange> ranges)
    : bins_(std::clamp(std::bit_ceil(ranges.size() / kIntervalsPerBin), kFewestBins, kMostTableBins)) {
  if (ranges.size() > 1) {
    const double last_angle = begins[ranges.size() - 1];
    first_angle_ = begins[1];
    const auto inner = static_cast<double>(bins_ - 2);
    if (last_angle > first_angle_) bins_per_angle_ = inner / (last_angle - first_angle_);
  }
  const auto levels = static_cast<std::size_t>(std::bit_width(bins_));
  items_.reserve(levels * bins_);
  items_.resize(bins_, kNowhere);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const std::size_t last = BinOf(begins[i + 1]);
    for (std::size_t bin = BinOf(begins[i]); bin <= last; ++bin) items_[bin] = Union(items_[bin], ranges[i]);
  }
  for (std::size_t level = 1; level < levels; ++level) {
    const std::size_t span = std::size_t{1} << level;
    const OrderRange* half = &items_[(level - 1) * bins_];
    for (std::size_t i = 0; i + span <= bins_; ++i) items_.push_back(Union(half[i], half[i + span / 2]));
    items_.resize((level + 1) * bins_);  // where a range would reach beyond the last bin: never asked for
  }
}

// Never falls as the angle grows, so the bins of a range of angles are consecutive.
std::size_t ObjectRangeTable::BinOf(double angle) const {
  const double bin = (angle - first_angle_) * bins_per_angle_ + 1.0;
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins_ - 1)));
}

OrderRange ObjectRangeTable::Over(double least_angle, double most_angle) const {
  const std::size_t first = BinOf(least_angle), end = BinOf(most_angle) + 1;
  const std::size_t span = std::bit_floor(end - first);
  const auto level = static_cast<std::size_t>(std::countr_zero(span));
  const OrderRange* items = &items_[level * bins_];
  return Union(items[first], items[end - span]);
}

}  // namespace elbowroom::recon
