#include "recon/cast_intervals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace elbowroom::recon {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

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

// Goes through the angles and keeps the edges that rays meet, in order.
class Sweep {
 public:
  Sweep(std::span<const OrderedEdge> edges, bool starts_inside, CastIntervals* intervals)
      : edges_(edges), starts_inside_(starts_inside), out_(*intervals) {
    out_.begins.reserve(edges.size() + 2);
    out_.runs.reserve(edges.size() + 2);
    out_.crossings.reserve(8 * edges.size() + 2);
    ranges_.reserve(edges.size() + 2);
  }

  std::vector<OrderRange> Run() {
    float at = -kInfinity;
    end_ = NextAngle();
    for (;;) {
      if (end_ > at) Emit(at);
      if (next_ == edges_.size() && met_.empty()) break;
      at = end_;
      Pass(at);
    }
    out_.begins.push_back(kInfinity);
    out_.crossings.resize(out_.crossings.size() + 2);
    return std::move(ranges_);
  }

 private:
  [[nodiscard]] double OrderOf(std::uint32_t edge, const Direction& direction) const {
    return direction.x * edges_[edge].order.dx + direction.y * edges_[edge].order.dy;
  }

  // Where the next edge begins or ends.
  [[nodiscard]] float NextAngle() const {
    float next = next_ < edges_.size() ? edges_[next_].cast.from : kInfinity;
    for (const std::uint32_t edge : met_) next = std::min(next, edges_[edge].cast.to);
    return next;
  }

  // Edges that end at an angle go, edges that begin there come.
  void Pass(float at) {
    std::erase_if(met_, [&](std::uint32_t edge) { return edges_[edge].cast.to <= at; });
    const std::size_t first = next_;
    for (; next_ < edges_.size() && edges_[next_].cast.from <= at; ++next_)
      met_.push_back(static_cast<std::uint32_t>(next_));
    end_ = NextAngle();
    if (first == next_) return;
    const Direction middle = DirectionAt(0.5 * (std::max(double{at}, -2.0) + std::min(double{end_}, 2.0)));
    std::size_t sorted = met_.size() - (next_ - first);
    for (; sorted < met_.size(); ++sorted) {
      const std::uint32_t edge = met_[sorted];
      const double place = OrderOf(edge, middle);
      std::size_t i = sorted;
      for (; i > 0 && OrderOf(met_[i - 1], middle) > place; --i) met_[i] = met_[i - 1];
      met_[i] = edge;
    }
  }

  // Orders are linear in an angle but for its whole numbers.
  [[nodiscard]] OrderRange RangeOf(double begin, double end) const {
    if (met_.empty() && !starts_inside_) return {kInfinity, -kInfinity};
    const bool has_first = !met_.empty() && edges_[met_.front()].cast.is_entry;
    const bool has_last = !met_.empty() && !edges_[met_.back()].cast.is_entry;
    OrderRange range{has_first ? kInfinity : -kInfinity, has_last ? -kInfinity : kInfinity};
    const auto add = [&](double angle) {
      const Direction direction = DirectionAt(angle);
      if (has_first) range.first = std::min(range.first, OrderOf(met_.front(), direction));
      if (has_last) range.last = std::max(range.last, OrderOf(met_.back(), direction));
    };
    add(begin);
    for (double whole = std::ceil(begin); whole < end; whole += 1.0) add(whole);
    add(end);
    return range;
  }

  // The interval from `at` to end_.
  void Emit(float at) {
    out_.begins.push_back(at);
    std::size_t place = out_.crossings.size() / 2;
    out_.runs.push_back(place | (place + met_.size()) << 32U);
    out_.crossings.resize(out_.crossings.size() + 2 * met_.size());
    for (const std::uint32_t number : met_)
      out_.SetCrossing(place++, {edges_[number].cast.key, number, edges_[number].cast.is_entry});
    ranges_.push_back(RangeOf(std::max(double{at}, -2.0), std::min(double{end_}, 2.0)));
  }

  std::span<const OrderedEdge> edges_;
  const bool starts_inside_;
  CastIntervals& out_;
  std::vector<OrderRange> ranges_;
  std::size_t next_ = 0;
  float end_ = kInfinity;  // of the edges met: where the next one comes or the first of them goes
  std::vector<std::uint32_t> met_;
};

double BeginOf(const CastPencil& pencil, std::uint32_t bin) {
  return pencil.least_angle + bin / static_cast<double>(pencil.bins_per_angle);
}

void FillBins(CastPencil* pencil) {
  CastIntervals& intervals = pencil->intervals;
  intervals.first_interval.assign(pencil->bins, 0);
  std::size_t interval = 0;
  for (std::uint32_t bin = 1; bin < pencil->bins; ++bin) {
    const double begin = BeginOf(*pencil, bin) - kAngleSlack;
    while (intervals.begins[interval + 1] <= begin) ++interval;
    intervals.first_interval[bin] = static_cast<std::int32_t>(interval);
  }
}

}  // namespace

std::vector<OrderRange> FillIntervals(std::vector<OrderedEdge> edges, bool starts_inside,
                                      CastPencil* pencil) {
  std::sort(edges.begin(), edges.end(),
            [](const OrderedEdge& a, const OrderedEdge& b) { return a.cast.from < b.cast.from; });
  pencil->edges.clear();
  for (const OrderedEdge& edge : edges) pencil->edges.push_back(edge.cast);
  std::vector<OrderRange> ranges = Sweep(edges, starts_inside, &pencil->intervals).Run();
  FillBins(pencil);
  return ranges;
}

std::uint32_t BinOf(const CastPencil& pencil, double angle) {
  const double bin = (angle - pencil.least_angle) * pencil.bins_per_angle;
  return static_cast<std::uint32_t>(std::clamp(bin, 0.0, pencil.bins - 1.0));
}

std::pair<std::size_t, std::size_t> IntervalsOf(const CastPencil& pencil, std::uint32_t first_bin,
                                                std::uint32_t last_bin) {
  const CastIntervals& intervals = pencil.intervals;
  const auto first = static_cast<std::size_t>(intervals.first_interval[first_bin]);
  if (last_bin + 1 == pencil.bins) return {first, intervals.size() - 1};
  auto last = static_cast<std::size_t>(intervals.first_interval[last_bin + 1]);
  while (intervals.begins[last + 1] <= BeginOf(pencil, last_bin + 1) + kAngleSlack) ++last;
  return {first, last};
}

}  // namespace elbowroom::recon
