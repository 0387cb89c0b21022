#include "recon/gauge/width_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
  double low = -kInfinity;
  double high = kInfinity;

  [[nodiscard]] double gap() const { return low - high; }  // positive: empty
};

// Of a rod turned by t (mm per mm): the offsets outwards that a side's edge may have.
struct Sides {
  Interval one;    // of side 1
  Interval other;  // of side -1
};

Sides SidesAt(std::span<const SidePoint> points, double turn, double raised_mm) {
  Sides sides;
  for (const SidePoint& point : points) {
    Interval& side = point.side > 0 ? sides.one : sides.other;
    const double offset = point.error_mm - point.side * turn * point.along_mm;
    const double limit = point.limit_mm + raised_mm;
    side.low = std::max(side.low, offset - limit);
    side.high = std::min(side.high, offset + limit);
  }
  return sides;
}

double GapAt(std::span<const SidePoint> points, double turn) {
  const Sides sides = SidesAt(points, turn, 0.0);
  return std::max(sides.one.gap(), sides.other.gap());
}

// Of a convex function.
template <typename Function>
double LeastOf(double from, double to, const Function& value) {
  constexpr int kSteps = 60;  // 0.618^60 = 3e-13
  constexpr double kGolden = 0.6180339887498949;
  double a = to - kGolden * (to - from), b = from + kGolden * (to - from);
  double at_a = value(a), at_b = value(b);
  for (int i = 0; i < kSteps; ++i) {
    if (at_a < at_b) {
      to = b;
      b = a;
      at_b = at_a;
      a = to - kGolden * (to - from);
      at_a = value(a);
    } else {
      from = a;
      a = b;
      at_a = at_b;
      b = from + kGolden * (to - from);
      at_b = value(b);
    }
  }
  return 0.5 * (from + to);
}

// Where a convex function that is at most 0 at `inside` comes to 0 on the way to `outside`.
template <typename Function>
double ZeroBetween(double inside, double outside, const Function& value) {
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (inside + outside);
    (value(middle) <= 0.0 ? inside : outside) = middle;
  }
  return inside;
}

// Beyond this turn the longer side has points on opposite sides of its limits.
double LargestTurn(std::span<const SidePoint> points) {
  double longest_mm = 0.0, most_mm = 0.0;
  for (const int side : {1, -1}) {
    double from_mm = kInfinity, to_mm = -kInfinity;
    for (const SidePoint& point : points) {
      most_mm = std::max(most_mm, std::abs(point.error_mm) + point.limit_mm);
      if (point.side != side) continue;
      from_mm = std::min(from_mm, point.along_mm);
      to_mm = std::max(to_mm, point.along_mm);
    }
    longest_mm = std::max(longest_mm, to_mm - from_mm);
  }
  return longest_mm > 0.0 ? 4.0 * most_mm / longest_mm : 0.0;
}

}  // namespace

RadiusRange RadiiWithin(std::span<const SidePoint> points) {
  const auto ones = std::ranges::count(points, 1, &SidePoint::side);
  core::Require(ones >= 2 && std::ssize(points) - ones >= 2, "each side of a rod has two points or more");
  const double most_turn = LargestTurn(points);
  const double best = LeastOf(-most_turn, most_turn, [&](double turn) { return GapAt(points, turn); });
  RadiusRange range;
  range.excess_mm = std::max(0.0, 0.5 * GapAt(points, best));
  const double raised_mm = 2.0 * range.excess_mm;
  const auto excess_at = [&](double turn) { return GapAt(points, turn) - 2.0 * raised_mm; };
  const double from = ZeroBetween(best, -most_turn, excess_at), to = ZeroBetween(best, most_turn, excess_at);
  // The radius is half the sum of the sides' offsets; its largest value is a concave function of the turn.
  const auto most_at = [&](double turn) {
    const Sides sides = SidesAt(points, turn, raised_mm);
    return 0.5 * (sides.one.high + sides.other.high);
  };
  const auto least_at = [&](double turn) {
    const Sides sides = SidesAt(points, turn, raised_mm);
    return 0.5 * (sides.one.low + sides.other.low);
  };
  range.high_mm = most_at(LeastOf(from, to, [&](double turn) { return -most_at(turn); }));
  range.low_mm = least_at(LeastOf(from, to, least_at));
  return range;
}

}  // namespace elbowroom::recon
