#include "app/control/gauge/gauge_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sessions/report/chart.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using sessions::Anchor;
using sessions::Label;

constexpr const char* kFailed = "#7a0010";
constexpr const char* kQuiet = "#94a1ad";

double LargestErrorMm(const GaugeOutcome& outcome) {
  return std::max(std::abs(outcome.worst_place().error_mm), 1e-3);
}

// A map of two of the world's axes, the first to the right and the second upwards.
struct Map {
  int right;
  int up;
  const char* title;
  double left;
  double top;
  double scale;  // px per mm
  Eigen::AlignedBox3d workspace_mm;

  [[nodiscard]] double width() const { return scale * workspace_mm.sizes()[right]; }
  [[nodiscard]] double height() const { return scale * workspace_mm.sizes()[up]; }
  [[nodiscard]] Vector2d At(const Vector3d& x_in_world) const {
    return {left + scale * (x_in_world[right] - workspace_mm.min()[right]),
            top + scale * (workspace_mm.max()[up] - x_in_world[up])};
  }
};

std::string RodLine(const Map& map, const GaugePlace& place, double largest_mm) {
  const Vector3d half = 0.5 * place.rod.seen_mm * place.rod.direction_in_world;
  const Vector2d from = map.At(place.rod.position_in_world - half);
  const Vector2d to = map.At(place.rod.position_in_world + half);
  const Vector2d middle = map.At(place.rod.position_in_world);
  const std::string colour = sessions::DepthColour(std::abs(place.error_mm) / largest_mm);
  std::string svg = fmt::format(
      "<g><title>frame {}: {:+.3f} mm, bound {:.3f} mm</title>"
      "<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='{}' stroke-width='2.5' stroke-linecap='round'/>"
      "<circle cx='{:.1f}' cy='{:.1f}' r='6' fill='{}' stroke='#36424d' stroke-width='0.8'/>",
      place.frame, place.error_mm, place.rod.diameter.bound.total_mm(), from.x(), from.y(), to.x(), to.y(),
      colour, middle.x(), middle.y(), colour);
  if (!place.passed())
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='10' fill='none' stroke='{}' stroke-width='2.5'/>",
                       middle.x(), middle.y(), kFailed);
  return svg + "</g>";
}

std::string MapSvg(const Map& map, const core::Rig& rig, const GaugeOutcome& outcome) {
  std::string svg =
      Label(map.left, map.top - 10.0, map.title, "quiet") +
      fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='#f4f6f8' stroke='{}'/>",
                  map.left, map.top, map.width(), map.height(), kQuiet);
  for (const core::CameraModel& camera : rig.cameras) {
    const Vector3d sight = (map.workspace_mm.center() - camera.center_in_world()).normalized();
    const Vector2d direction(sight[map.right], -sight[map.up]);
    if (direction.norm() < 0.3) continue;  // looks along the map's sight
    // Cameras stand outside of the map: an arrow at its edge shows where they look from.
    const Vector2d center = map.At(map.workspace_mm.center());
    const Vector2d unit = direction.normalized();
    const double reach = std::min(0.5 * map.width() / std::max(std::abs(unit.x()), 1e-9),
                                  0.5 * map.height() / std::max(std::abs(unit.y()), 1e-9));
    const Vector2d tip = center - reach * unit, side(-unit.y(), unit.x());
    const Vector2d one = tip - 12.0 * unit + 6.0 * side, other = tip - 12.0 * unit - 6.0 * side;
    svg += fmt::format(
        "<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z' fill='{}'><title>{}</title></path>", tip.x(),
        tip.y(), one.x(), one.y(), other.x(), other.y(), kQuiet, "camera");
  }
  for (const GaugePlace& place : outcome.places) svg += RodLine(map, place, LargestErrorMm(outcome));
  return svg;
}

std::string Legend(double left, double top, double largest_mm) {
  constexpr int kSteps = 24;
  constexpr double kWidth = 8.0, kHeight = 12.0;
  std::string svg;
  for (int i = 0; i < kSteps; ++i)
    svg +=
        fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{}' fill='{}'/>", left + kWidth * i,
                    top, kWidth + 0.2, kHeight, sessions::DepthColour(static_cast<double>(i) / (kSteps - 1)));
  const double right = left + kWidth * kSteps;
  return svg + Label(left, top + kHeight + 15.0, "0 mm", "tick") +
         Label(right, top + kHeight + 15.0, fmt::format("{:.3g} mm off", largest_mm), "tick", Anchor::kEnd) +
         Label(right + 24.0, top + kHeight - 2.0,
               "ringed: doesn't pass; triangles: where the cameras look from", "tick");
}

// The bound as a bar, the error as a dot.
std::string ErrorMark(const sessions::Plot& plot, double x, const GaugePlace& place) {
  const double bound_mm = place.rod.diameter.bound.total_mm();
  const char* colour = place.passed() ? "#2a6f97" : kFailed;
  const auto y = [&](double value) { return plot.Y(std::clamp(value, plot.low, plot.high)); };
  return fmt::format(
      "<g><title>frame {}: {:+.3f} mm, bound {:.3f} mm</title>"
      "<path d='M{:.1f} {:.1f}V{:.1f}' stroke='{}' stroke-width='5' stroke-opacity='0.3'/>"
      "<circle cx='{:.1f}' cy='{:.1f}' r='4' fill='{}'/></g>",
      place.frame, place.error_mm, bound_mm, x, y(bound_mm), y(-bound_mm), colour, x, y(place.error_mm),
      colour);
}

}  // namespace

std::string PlacesPicture(const core::Rig& rig, const GaugeOutcome& outcome) {
  constexpr double kWidth = 1040.0, kGap = 40.0, kTop = 40.0, kMargin = 20.0, kTallest = 420.0;
  Eigen::AlignedBox3d box = rig.workspace_mm;
  for (const GaugePlace& place : outcome.places) box.extend(place.rod.position_in_world);
  const Vector3d size = box.sizes();
  const double scale =
      std::min((kWidth - kGap - 2.0 * kMargin) / (2.0 * size.x()), kTallest / std::max(size.y(), size.z()));
  const Map above{0, 1, "from above", kMargin, kTop, scale, box};
  const Map beside{0, 2, "from the side", kMargin + above.width() + kGap, kTop, scale, box};
  const double bottom = kTop + std::max(above.height(), beside.height());
  return fmt::format("<svg viewBox='0 0 {} {:.0f}' role='img'>", kWidth, bottom + 70.0) +
         MapSvg(above, rig, outcome) + MapSvg(beside, rig, outcome) +
         Legend(kMargin, bottom + 25.0, LargestErrorMm(outcome)) + "</svg>";
}

std::string ErrorsPicture(const GaugeOutcome& outcome) {
  double most_mm = 0.0;
  for (const GaugePlace& place : outcome.places)
    most_mm = std::max({most_mm, std::abs(place.error_mm), place.rod.diameter.bound.total_mm()});
  sessions::Plot plot;
  plot.left = 70.0;
  plot.top = 20.0;
  plot.width = 950.0;
  plot.height = 260.0;
  plot.low = -1.1 * most_mm;
  plot.high = 1.1 * most_mm;
  std::string svg = "<svg viewBox='0 0 1040 330' role='img'>" + sessions::ValueAxis(plot, 8);
  const double step = plot.width / static_cast<double>(outcome.places.size());
  const std::size_t every = 1 + outcome.places.size() / 30;  // places with a number
  for (std::size_t i = 0; i < outcome.places.size(); ++i) {
    const double x = plot.left + (static_cast<double>(i) + 0.5) * step;
    svg += ErrorMark(plot, x, outcome.places[i]);
    if (i % every == 0)
      svg +=
          Label(x, plot.bottom() + 18.0, fmt::format("{}", outcome.places[i].frame), "tick", Anchor::kMiddle);
  }
  return svg + Label(plot.left, plot.bottom() + 40.0, "frame; dots: the error, bars: its bound", "remark") +
         "</svg>";
}

}  // namespace elbowroom::control
