#include "recon/gauge/straight_strips.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Chain = std::vector<std::uint32_t>;

// A straight edge's crossings are at most half a pixel beside it, and a fitted line nearly so.
constexpr double kStraightPx = 0.9;
constexpr std::size_t kFewestPoints = 6;  // of a run: fewer have no direction

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
Vector2d LeftOf(const Vector2d& along) { return {-along.y(), along.x()}; }

// The contour's loops, cut where they run along the picture's border. A loop without a cut starts at a
// corner.
std::vector<Chain> ChainsOf(const RodView& view, const Chain& loop) {
  const auto at_border = [&](std::uint32_t i) { return view.points[i].is_at_border; };
  Vector2d center = Vector2d::Zero();
  for (const std::uint32_t i : loop) center += view.points[i].position / static_cast<double>(loop.size());
  const auto cut = std::ranges::find_if(loop, at_border);
  const auto corner = std::ranges::max_element(
      loop, {}, [&](std::uint32_t i) { return (view.points[i].position - center).squaredNorm(); });
  Chain turned = loop;
  std::rotate(turned.begin(), turned.begin() + ((cut != loop.end() ? cut : corner) - loop.begin()),
              turned.end());
  std::vector<Chain> chains(1);
  for (const std::uint32_t i : turned) {
    if (!at_border(i))
      chains.back().push_back(i);
    else if (!chains.back().empty())
      chains.emplace_back();
  }
  return chains;
}

struct Span {
  std::size_t first;
  std::size_t last;
};

// Douglas and Peucker: stretches of the chain that stay beside their chord.
std::vector<Span> Split(const RodView& view, const Chain& chain) {
  std::vector<Span> waiting, straight;
  if (chain.size() >= kFewestPoints) waiting.push_back({0, chain.size() - 1});
  while (!waiting.empty()) {
    const Span span = waiting.back();
    waiting.pop_back();
    if (span.last - span.first + 1 < kFewestPoints) continue;
    const Vector2d from = view.points[chain[span.first]].position;
    const Vector2d chord = view.points[chain[span.last]].position - from;
    const Vector2d normal = chord.norm() > 0.0 ? LeftOf(chord.normalized()) : Vector2d::UnitX();
    double worst = 1.0;
    std::optional<std::size_t> split;
    for (std::size_t i = span.first + 1; i < span.last; ++i) {
      const ContourPoint& point = view.points[chain[i]];
      const double off =
          std::abs(normal.dot(point.position - from)) / AcrossLimit(point, normal, 1.2 * kStraightPx);
      if (off > worst) {
        worst = off;
        split = i;
      }
    }
    if (split) {
      waiting.push_back({span.first, *split});
      waiting.push_back({*split, span.last});
    } else {
      straight.push_back(span);
    }
  }
  return straight;
}

void MeasureReach(const RodView& view, StraightRun* run) {
  run->from = run->to = 0.0;
  for (const std::uint32_t i : run->points) {
    const double s = run->along.dot(view.points[i].position - run->middle);
    run->from = std::min(run->from, s);
    run->to = std::max(run->to, s);
  }
}

// Total least squares; the direction is that from the first to the last point.
void FitLine(const RodView& view, StraightRun* run) {
  run->middle = Vector2d::Zero();
  for (const std::uint32_t i : run->points)
    run->middle += view.points[i].position / static_cast<double>(run->points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const std::uint32_t i : run->points) {
    const Vector2d off = view.points[i].position - run->middle;
    spread += off * off.transpose();
  }
  run->along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
  const Vector2d course =
      view.points[run->points.back()].position - view.points[run->points.front()].position;
  if (run->along.dot(course) < 0.0) run->along = -run->along;
  MeasureReach(view, run);
}

bool IsOn(const RodView& view, const StraightRun& run, std::uint32_t i, double px) {
  const Vector2d normal = LeftOf(run.along);
  const ContourPoint& point = view.points[i];
  return std::abs(normal.dot(point.position - run.middle)) <= AcrossLimit(point, normal, px);
}

StraightRun Grown(const RodView& view, const Chain& chain, Span span, std::uint32_t loop) {
  StraightRun run;
  run.loop = loop;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    run.points.assign(chain.begin() + static_cast<std::ptrdiff_t>(span.first),
                      chain.begin() + static_cast<std::ptrdiff_t>(span.last) + 1);
    FitLine(view, &run);
    while (span.first > 0 && IsOn(view, run, chain[span.first - 1], kStraightPx)) --span.first;
    while (span.last + 1 < chain.size() && IsOn(view, run, chain[span.last + 1], kStraightPx)) ++span.last;
  }
  return run;
}

std::vector<StraightRun> FindRuns(const RodView& view) {
  std::vector<StraightRun> runs;
  std::vector<bool> taken(view.points.size(), false);
  for (std::uint32_t loop = 0; loop < view.loops.size(); ++loop) {
    for (const Chain& chain : ChainsOf(view, view.loops[loop])) {
      std::vector<Span> spans = Split(view, chain);
      std::ranges::sort(spans, std::greater(), [](const Span& span) { return span.last - span.first; });
      for (const Span& span : spans) {
        if (taken[chain[(span.first + span.last) / 2]]) continue;
        runs.push_back(Grown(view, chain, span, loop));
        for (const std::uint32_t i : runs.back().points) taken[i] = true;
      }
    }
  }
  return runs;
}

std::optional<Strip> Paired(const StraightRun& a, const StraightRun& b) {
  constexpr double kMostConvergence = 0.9;  // cosine: the sides of a rod that points at the camera converge
  if (a.along.dot(b.along) > -kMostConvergence) return std::nullopt;
  Strip strip{a, b, {}, (a.along - b.along).normalized(), 0.0, 0.0, 0.0};
  const auto range = [&](const StraightRun& run) -> std::pair<double, double> {
    const double one = strip.along.dot(run.middle + run.from * run.along);
    const double other = strip.along.dot(run.middle + run.to * run.along);
    return std::minmax(one, other);
  };
  const auto [a_from, a_to] = range(a);
  const auto [b_from, b_to] = range(b);
  const double from = std::max(a_from, b_from), to = std::min(a_to, b_to);
  if (to - from < 0.3 * std::min(a_to - a_from, b_to - b_from)) return std::nullopt;
  const double middle = 0.5 * (from + to);
  const auto at = [&](const StraightRun& run) -> Vector2d {
    return run.middle + (middle - strip.along.dot(run.middle)) / strip.along.dot(run.along) * run.along;
  };
  const Vector2d on_a = at(a), on_b = at(b);
  strip.width = Cross(strip.along, on_b - on_a);  // positive: b is to the left of a, where the object is
  strip.middle = 0.5 * (on_a + on_b);
  strip.from = from - middle;
  strip.to = to - middle;
  if (strip.width <= 0.0 || strip.length() < strip.width) return std::nullopt;
  return strip;
}

// Stretches of a loop on the run's line, with a line's direction, less their ends, which may belong to what
// comes next.
Chain PointsOnLine(const RodView& view, const StraightRun& run, double from, double to) {
  constexpr double kPx = 0.8, kDirection = 0.9;
  constexpr std::size_t kTrimmed = 2;
  Chain found, stretch;
  const auto finish = [&] {
    if (stretch.size() >= kFewestPoints + 2 * kTrimmed)
      found.insert(found.end(), stretch.begin() + kTrimmed, stretch.end() - kTrimmed);
    stretch.clear();
  };
  for (const Chain& loop : view.loops) {
    for (const std::uint32_t i : loop) {
      const ContourPoint& point = view.points[i];
      const double s = run.along.dot(point.position - run.middle);
      const bool belongs = !point.is_at_border && s >= from && s <= to && IsOn(view, run, i, kPx) &&
                           point.along.dot(run.along) > kDirection;
      if (belongs)
        stretch.push_back(i);
      else
        finish();
    }
    finish();
  }
  return found;
}

}  // namespace

std::vector<Strip> FindStrips(const RodView& view, double least_width, double most_width) {
  const std::vector<StraightRun> runs = FindRuns(view);
  std::vector<Strip> strips;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t j = i + 1; j < runs.size(); ++j) {
      const std::optional<Strip> strip = Paired(runs[i], runs[j]);
      if (strip && strip->width >= least_width && strip->width <= most_width) strips.push_back(*strip);
    }
  }
  std::ranges::sort(strips, std::greater(), &Strip::length);
  return strips;
}

Strip WithAllPoints(const RodView& view, const Strip& strip) {
  Strip whole = strip;
  for (StraightRun* run : {&whole.first, &whole.second}) {
    // As far again to either side: beyond, a line by chance is likelier than the rod.
    const double length = std::max(strip.length(), run->to - run->from);
    Chain points = PointsOnLine(view, *run, run->from - length, run->to + length);
    if (points.size() < kFewestPoints) continue;
    run->points = std::move(points);
    const Vector2d before = run->along;
    FitLine(view, run);
    if (run->along.dot(before) < 0.0) {  // a loop may begin within the run
      run->along = -run->along;
      MeasureReach(view, run);
    }
  }
  return whole;
}

}  // namespace elbowroom::recon
