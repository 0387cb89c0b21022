#include "recon/gauge/width_range.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

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
  constexpr int kSteps = 45;  // 0.618^45 = 4e-10
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
  constexpr int kSteps = 35;  // 2^-35 = 3e-11
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

void RequireBothSides(std::span<const SidePoint> points) {
  const auto ones = std::ranges::count(points, 1, &SidePoint::side);
  core::Require(ones >= 2 && std::ssize(points) - ones >= 2, "each side of a rod has two points or more");
}

// The gap of the best turn, for points that are straightened by a bow.
double LeastGap(std::vector<SidePoint> points, double half_mm, double bow_mm) {
  for (SidePoint& point : points)
    point.error_mm -= point.side * bow_mm * std::pow(point.along_mm / half_mm, 2);
  const double most_turn = LargestTurn(points);
  return GapAt(points, LeastOf(-most_turn, most_turn, [&](double turn) { return GapAt(points, turn); }));
}

}  // namespace

RadiusRange RadiiWithin(std::span<const SidePoint> points) {
  RequireBothSides(points);
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

BowRange BowsWithin(std::span<const SidePoint> points, double half_mm) {
  RequireBothSides(points);
  core::Require(half_mm > 0.0, "a rod has a length");
  const std::vector<SidePoint> all(points.begin(), points.end());
  double most_mm = 0.0, reach_mm = 0.0;
  for (const SidePoint& point : points) {
    most_mm = std::max(most_mm, std::abs(point.error_mm) + point.limit_mm);
    reach_mm = std::max(reach_mm, std::abs(point.along_mm));
  }
  // A bow that is more than this over the points' reach can't be made up for by shift and turn.
  const double most_bow_mm = 16.0 * most_mm * std::pow(half_mm / std::max(reach_mm, 1e-9), 2);
  const auto gap_at = [&](double bow_mm) { return LeastGap(all, half_mm, bow_mm); };
  const double best_mm = LeastOf(-most_bow_mm, most_bow_mm, gap_at);
  const double raised_mm = std::max(0.0, gap_at(best_mm));
  const auto excess_at = [&](double bow_mm) { return gap_at(bow_mm) - 2.0 * raised_mm; };
  return {ZeroBetween(best_mm, -most_bow_mm, excess_at), ZeroBetween(best_mm, most_bow_mm, excess_at)};
}

}  // namespace elbowroom::recon
