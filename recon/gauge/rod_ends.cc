#include "recon/gauge/rod_ends.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace elbowroom::recon {

using Eigen::Vector2d;

std::optional<SeenEnd> FreeEnd(const RodView& view, const Strip& strip, bool is_forward) {
  const StraightRun &before = is_forward ? strip.first : strip.second,
                    &after = is_forward ? strip.second : strip.first;
  if (before.loop != after.loop) return std::nullopt;
  const auto& loop = view.loops[before.loop];
  const Vector2d outward = is_forward ? strip.along : Vector2d(-strip.along);
  const auto start = std::ranges::find(loop, before.points.back()) - loop.begin();
  SeenEnd end{strip.middle, 0.0};
  double extreme = 0.0, way = 0.0;
  Vector2d last = view.points[before.points.back()].position;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const std::uint32_t at = loop[(static_cast<std::size_t>(start) + k) % loop.size()];
    const ContourPoint& point = view.points[at];
    if (point.is_at_border) return std::nullopt;
    way += (point.position - last).norm();
    last = point.position;
    end.step = std::max(end.step, std::abs(outward.dot(point.step_in_plane)));
    extreme = std::max(extreme, outward.dot(point.position - strip.middle));
    if (at == after.points.front()) break;
    if (way > 3.0 * strip.width + 12.0 * point.step_in_plane.norm()) return std::nullopt;
  }
  end.position += extreme * outward;
  return end;
}

}  // namespace elbowroom::recon
