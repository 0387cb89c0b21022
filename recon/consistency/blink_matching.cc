#include "recon/consistency/blink_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elbowroom::recon {
namespace {

// The share at a time between two pictures, by the straight line; nothing where one is missing.
std::optional<double> ShareAt(const BlinkCurve& curve, const BlinkEdges& edges, double stamp_s) {
  constexpr double kLostPictures = 1.6;
  const auto after = std::ranges::upper_bound(curve.stamp_s, stamp_s);
  if (after == curve.stamp_s.begin() || after == curve.stamp_s.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - curve.stamp_s.begin());
  const double step_s = curve.stamp_s[i] - curve.stamp_s[i - 1];
  if (step_s > kLostPictures * edges.period_s) return std::nullopt;
  const double way = (stamp_s - curve.stamp_s[i - 1]) / step_s;
  return (1.0 - way) * edges.share[i - 1] + way * edges.share[i];
}

}  // namespace

std::optional<double> CoarseOffset(const BlinkCurve& first_curve, const BlinkEdges& first,
                                   const BlinkCurve& curve, const BlinkEdges& edges, double search_s) {
  constexpr int kFewestPictures = 100;
  const double step_s = edges.period_s / 6.0;
  const auto steps = static_cast<int>(std::ceil(search_s / step_s));
  double least = std::numeric_limits<double>::infinity();
  std::optional<double> best_s;
  for (int i = -steps; i <= steps; ++i) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < curve.stamp_s.size(); ++k) {
      const std::optional<double> there = ShareAt(first_curve, first, curve.stamp_s[k] + i * step_s);
      if (!there) continue;
      sum += std::abs(*there - edges.share[k]);
      ++count;
    }
    if (count < kFewestPictures || sum / count >= least) continue;
    least = sum / count;
    best_s = i * step_s;
  }
  return best_s;
}

std::vector<SharedEdge> MatchEdges(std::span<const BlinkEdges> cameras,
                                   std::span<const double> coarse_offset_s, double shortest_blink_s) {
  struct Timed {
    double time_s;
    SharedEdge::Seen seen;
  };
  std::vector<SharedEdge> shared;
  for (const bool is_on : {false, true}) {
    std::vector<Timed> all;
    for (core::CameraIndex camera = 0; camera < cameras.size(); ++camera)
      for (const BlinkEdge& edge : cameras[camera].edges)
        if (edge.is_on == is_on) all.push_back({edge.stamp_s + coarse_offset_s[camera], {camera, edge}});
    std::ranges::sort(all, {}, &Timed::time_s);
    for (std::size_t i = 0; i < all.size();) {
      SharedEdge group;
      std::size_t end = i;
      bool is_clean = true;
      for (; end < all.size() && all[end].time_s - all[i].time_s < shortest_blink_s; ++end) {
        const auto same = [&](const auto& seen) { return seen.camera == all[end].seen.camera; };
        is_clean = is_clean && std::ranges::none_of(group.seen, same);
        group.seen.push_back(all[end].seen);
      }
      if (is_clean && group.seen.size() >= 2) shared.push_back(std::move(group));
      i = end;
    }
  }
  return shared;
}

}  // namespace elbowroom::recon
