#include "recon/exact_view/cast_intervals.h"

#include <hwy/contrib/sort/vqsort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "core/infinity.h"

namespace elbowroom::recon {
namespace {

using core::kFloatInfinity;
constexpr std::size_t kBinsPerInterval = 2;
constexpr std::size_t kMostCastBins = 8192;
constexpr double kLeastBinWidth = 8.0 * kAngleSlack;

struct Direction {
  double x = 0.0;
  double y = 0.0;
};

// The inverse of PencilAngle, |x| + |y| = 1.
Direction DirectionAt(double angle) {
  if (angle > 1.0) return {1.0 - angle, 2.0 - angle};
  if (angle < -1.0) return {1.0 + angle, -2.0 - angle};
  return {1.0 - std::abs(angle), angle};
}

// The edges' numbers, sorted by `from`. The bits of a float are changed so that they ascend as an integer;
// they are sorted together with the number in one word.
std::vector<std::uint32_t> ByFrom(std::span<const CastEdge> edges) {
  std::vector<std::uint64_t> keys(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(edges[i].from);
    const std::uint32_t ascending = (bits >> 31U) != 0 ? ~bits : bits | 0x80000000U;
    keys[i] = std::uint64_t{ascending} << 32U | i;
  }
  hwy::Sorter()(keys.data(), keys.size(), hwy::SortAscending());
  std::vector<std::uint32_t> numbers(edges.size());
  for (std::size_t i = 0; i < keys.size(); ++i) numbers[i] = static_cast<std::uint32_t>(keys[i]);
  return numbers;
}

// Goes through the angles and keeps the edges that rays meet, in order.
class AngleSweep {
 public:
  AngleSweep(std::span<const EdgeOrder> orders, CastPencil* pencil)
      : edges_(pencil->edges),
        orders_(orders),
        by_from_(ByFrom(edges_)),
        starts_inside_(pencil->starts_inside),
        out_(pencil->intervals) {
    out_.begins.reserve(edges_.size() + 2);
    out_.firsts.reserve(edges_.size() + 2);
    out_.crossings.reserve(kCrossingsPerEdge * edges_.size() + 2);
    ranges_.reserve(edges_.size() + 2);
  }

  std::vector<OrderRange> Run() {
    float at = -kFloatInfinity;
    AddLast();
    end_ = NextAngle();
    for (;;) {
      if (end_ > at) Emit(at);
      if (next_ == edges_.size() && met_.empty()) break;
      at = end_;
      Pass(at);
    }
    out_.begins.push_back(kFloatInfinity);
    out_.firsts.push_back(NextPlace());
    return std::move(ranges_);
  }

 private:
  // About how many crossings are listed for an edge of a compact object: a guess for the memory to reserve.
  static constexpr std::size_t kCrossingsPerEdge = 8;

  // An edge that rays meet now.
  struct Met {
    EdgeOrder order;
    float to = 0.0F;
    CastCrossing crossing;
    [[nodiscard]] double OrderAt(const Direction& direction) const {
      return direction.x * order.dx + direction.y * order.dy;
    }
  };

  [[nodiscard]] float NextBegin() const {
    return next_ < edges_.size() ? edges_[by_from_[next_]].from : kFloatInfinity;
  }

  // Where the next edge begins or ends.
  [[nodiscard]] float NextAngle() const {
    float next = NextBegin();
    for (const Met& edge : met_) next = edge.to < next ? edge.to : next;
    return next;
  }

  [[nodiscard]] Met MetAt(std::size_t place) const {
    const std::uint32_t number = by_from_[place];
    const CastEdge& edge = edges_[number];
    return {orders_[number], edge.to, CastCrossing(edge.key, static_cast<std::int32_t>(number))};
  }

  // Removes the edges that end at `at` and adds those that begin there. Where only one ends and one begins,
  // the contour goes on: the new edge takes the place of the old one, which is right or nearly so.
  void Pass(float at) {
    const std::size_t first = next_;
    while (next_ < edges_.size() && NextBegin() <= at) ++next_;
    const auto has_ended = [at](const Met& edge) { return edge.to <= at; };
    const auto ended = std::ranges::find_if(met_, has_ended);
    std::size_t unsettled = static_cast<std::size_t>(ended - met_.begin());
    if (next_ == first + 1 && ended != met_.end() && std::none_of(ended + 1, met_.end(), has_ended)) {
      *ended = MetAt(first);
      end_ = NextAngle();
      return Settle(unsettled, met_.size(), MiddleOf(at, end_));
    }
    std::erase_if(met_, has_ended);
    unsettled = met_.size();
    for (std::size_t i = first; i < next_; ++i) met_.push_back(MetAt(i));
    end_ = NextAngle();
    const Direction middle = MiddleOf(at, end_);
    for (; unsettled < met_.size(); ++unsettled) Settle(unsettled, unsettled + 1, middle);
  }

  static Direction MiddleOf(double begin, double end) {
    return DirectionAt(0.5 * (std::max(begin, -2.0) + std::min(end, 2.0)));
  }

  // Moves edge i to its place among the first `count`, which are in order but for itself. Contours don't
  // cross themselves, so the order in the middle of an interval is that of the whole interval.
  void Settle(std::size_t i, std::size_t count, const Direction& middle) {
    const double order = met_[i].OrderAt(middle);
    for (; i > 0 && met_[i - 1].OrderAt(middle) > order; --i) std::swap(met_[i - 1], met_[i]);
    for (; i + 1 < count && met_[i + 1].OrderAt(middle) < order; ++i) std::swap(met_[i], met_[i + 1]);
  }

  // The orders between which rays of the interval can be in the object. An order is linear in the angle
  // between whole numbers, so its extremes are at the ends of the interval and at the whole numbers in it.
  [[nodiscard]] OrderRange RangeOf(double begin, double end) {
    const Direction begins_along = std::exchange(next_begins_along_, DirectionAt(end));
    if (met_.empty() && !starts_inside_) return {kFloatInfinity, -kFloatInfinity};
    const bool has_first = !starts_inside_;
    const bool has_last = starts_inside_ == (met_.size() % 2 != 0);
    OrderRange range{has_first ? kFloatInfinity : -kFloatInfinity,
                     has_last ? -kFloatInfinity : kFloatInfinity};
    const auto add = [&](const Direction& direction) {
      if (has_first) range.first = std::min(range.first, met_.front().OrderAt(direction));
      if (has_last) range.last = std::max(range.last, met_.back().OrderAt(direction));
    };
    add(begins_along);
    for (const double whole : {-1.0, 0.0, 1.0})
      if (begin < whole && whole < end) add(DirectionAt(whole));
    add(next_begins_along_);
    return range;
  }

  // The interval from `at` to end_.
  void Emit(float at) {
    out_.begins.push_back(at);
    out_.firsts.push_back(NextPlace());
    for (const Met& edge : met_) out_.crossings.push_back(edge.crossing);
    AddLast();
    ranges_.push_back(RangeOf(std::max(double{at}, -2.0), std::min(double{end_}, 2.0)));
  }
  void AddLast() { out_.Add({0.0F, 0.0F, kFloatInfinity}, 0); }
  [[nodiscard]] std::int32_t NextPlace() const { return static_cast<std::int32_t>(out_.crossings.size()); }

  std::span<const CastEdge> edges_;
  std::span<const EdgeOrder> orders_;
  const std::vector<std::uint32_t> by_from_;
  const bool starts_inside_;
  CastIntervals& out_;
  std::vector<OrderRange> ranges_;
  std::size_t next_ = 0;        // in by_from_
  float end_ = kFloatInfinity;  // of the present interval: the next edge begins or one of `met_` ends
  std::vector<Met> met_;
  Direction next_begins_along_ = DirectionAt(-2.0);  // the next interval begins where the last one ended
};

double BeginOf(const CastPencil& pencil, std::uint32_t bin) {
  return pencil.least_angle + bin * (1.0 / pencil.bins_per_angle);
}

// Spreads bins over the angles at which intervals begin. None begins in the first bin or the last one: these
// take all angles beyond.
std::size_t ChooseBins(CastPencil* pencil) {
  const std::vector<float>& begins = pencil->intervals.begins;
  if (pencil->intervals.size() == 1) return 1;
  const double first = std::max(begins[1], -2.0F), last = std::min(begins[begins.size() - 2], 2.0F);
  const std::size_t bins = std::min(kBinsPerInterval * begins.size(), kMostCastBins);
  const double width = std::max((last - first) / static_cast<double>(bins), kLeastBinWidth);
  pencil->least_angle = static_cast<float>(first - 1.25 * width);
  pencil->bins_per_angle = static_cast<float>(1.0 / width);
  return bins + 3;
}

void FillBins(CastPencil* pencil) {
  const std::vector<float>& begins = pencil->intervals.begins;
  const std::size_t bins = ChooseBins(pencil);
  pencil->intervals.bins.resize(bins);
  std::uint32_t interval = 0;
  double begin = -kFloatInfinity;  // of the first bin, which takes what lies before
  for (std::uint32_t bin = 0; bin < bins; ++bin) {
    const double end = BeginOf(*pencil, bin + 1);
    while (begins[interval + 1] <= begin - kAngleSlack) ++interval;
    const bool has_more = interval + 2 < begins.size() && begins[interval + 2] <= end + kAngleSlack;
    pencil->intervals.bins[bin] = CastBin{interval, has_more, begins[interval + 1]}.Pack();
    begin = end;
  }
}

}  // namespace

std::vector<OrderRange> FillIntervals(std::span<const EdgeOrder> orders, CastPencil* pencil) {
  std::vector<OrderRange> ranges = AngleSweep(orders, pencil).Run();
  FillBins(pencil);
  return ranges;
}

std::uint32_t BinOf(const CastPencil& pencil, double angle) {
  const double bin = (angle - pencil.least_angle) * pencil.bins_per_angle;
  return static_cast<std::uint32_t>(std::clamp(bin, 0.0, pencil.bins() - 1.0));
}

std::pair<std::size_t, std::size_t> IntervalsOf(const CastPencil& pencil, std::uint32_t first_bin,
                                                std::uint32_t last_bin) {
  const CastIntervals& intervals = pencil.intervals;
  const std::size_t first = CastBin::IntervalOf(intervals.bins[first_bin]);
  if (last_bin + 1 == pencil.bins()) return {first, intervals.size() - 1};
  std::size_t last = CastBin::IntervalOf(intervals.bins[last_bin + 1]);
  while (intervals.begins[last + 1] <= BeginOf(pencil, last_bin + 1) + kAngleSlack) ++last;
  return {first, last};
}

}  // namespace elbowroom::recon
