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
// Room for the rounding of rays' angles to float32.
constexpr double kAngleSlack = 1e-6;

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
  Sweep(std::span<const OrderedEdge> edges, CastIntervals* intervals) : edges_(edges), out_(*intervals) {
    out_.begins.reserve(edges.size() + 2);
    out_.first_crossing.reserve(edges.size() + 2);
    out_.crossings.reserve(16 * edges.size() + 4);
  }

  void Run() {
    float at = -kInfinity;
    while (next_ < edges_.size() || !met_.empty()) {
      Emit(at);
      at = NextAngle();
      Leave(at);
      Enter(at);
    }
    Emit(at);
    out_.begins.push_back(kInfinity);
    out_.first_crossing.push_back(out_.first_crossing.back());
    out_.crossings.resize(out_.crossings.size() + 4, 0.0F);
  }

 private:
  // Where the next edge begins or ends.
  [[nodiscard]] float NextAngle() const {
    float next = next_ < edges_.size() ? edges_[next_].cast.from : kInfinity;
    for (const std::uint32_t edge : met_) next = std::min(next, edges_[edge].cast.to);
    return next;
  }

  void Leave(float at) {
    std::erase_if(met_, [&](std::uint32_t edge) { return edges_[edge].cast.to <= at; });
  }

  void Enter(float at) {
    const std::size_t first = next_;
    float end = kInfinity;
    for (; next_ < edges_.size() && edges_[next_].cast.from <= at; ++next_)
      end = std::min(end, edges_[next_].cast.to);
    if (first == next_) return;
    if (next_ < edges_.size()) end = std::min(end, edges_[next_].cast.from);
    for (const std::uint32_t edge : met_) end = std::min(end, edges_[edge].cast.to);
    const Direction middle = DirectionAt(0.5 * (std::max(double{at}, -2.0) + std::min(double{end}, 2.0)));
    const auto order = [&](std::uint32_t edge) {
      return middle.x * edges_[edge].order.dx + middle.y * edges_[edge].order.dy;
    };
    for (std::size_t i = first; i < next_; ++i) {
      const auto edge = static_cast<std::uint32_t>(i);
      const double place = order(edge);
      auto before = met_.end();
      while (before != met_.begin() && order(*(before - 1)) > place) --before;
      met_.insert(before, edge);
    }
  }

  void Emit(float at) {
    if (!out_.begins.empty() && out_.begins.back() == at) {  // edges from -infinity on
      out_.crossings.resize(4 * static_cast<std::size_t>(out_.first_crossing.back()));
    } else {
      out_.begins.push_back(at);
      out_.first_crossing.push_back(static_cast<std::int32_t>(out_.crossings.size() / 4));
    }
    for (const std::uint32_t number : met_) {
      const CastEdge& edge = edges_[number].cast;
      const CrossingTag tag{static_cast<std::int32_t>(number), edge.is_entry};
      out_.crossings.insert(out_.crossings.end(),
                            {edge.key.du, edge.key.dv, edge.key.at_origin, BitsOf(tag)});
    }
  }

  std::span<const OrderedEdge> edges_;
  CastIntervals& out_;
  std::size_t next_ = 0;
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
    const double begin =
        pencil->least_angle + bin / static_cast<double>(pencil->bins_per_angle) - kAngleSlack;
    while (intervals.begins[interval + 1] <= begin) ++interval;
    intervals.first_interval[bin] = static_cast<std::int32_t>(interval);
  }
}

}  // namespace

void FillIntervals(std::vector<OrderedEdge> edges, CastPencil* pencil) {
  std::sort(edges.begin(), edges.end(),
            [](const OrderedEdge& a, const OrderedEdge& b) { return a.cast.from < b.cast.from; });
  pencil->edges.clear();
  for (const OrderedEdge& edge : edges) pencil->edges.push_back(edge.cast);
  Sweep(edges, &pencil->intervals).Run();
  FillBins(pencil);
}

std::pair<std::size_t, std::size_t> IntervalsOf(const CastPencil& pencil, std::uint32_t first_bin,
                                                std::uint32_t last_bin) {
  const CastIntervals& intervals = pencil.intervals;
  const auto first = static_cast<std::size_t>(intervals.first_interval[first_bin]);
  if (last_bin + 1 == pencil.bins) return {first, intervals.begins.size() - 2};
  auto last = static_cast<std::size_t>(intervals.first_interval[last_bin + 1]);
  while (intervals.begins[last + 1] <= BeginOf(pencil, last_bin + 1) + kAngleSlack) ++last;
  return {first, last};
}

}  // namespace elbowroom::recon
