#include "app/control/calibration/calibration_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sessions/report/chart.h"

namespace elbowroom::control {
namespace {

using recon::UncertaintyMap;
using sessions::Anchor;

constexpr double kLongestLinePx = 40.0;  // of the median residual's line it is a third, about

// Residuals are drawn this many times as long as they are: a round number.
double Enlargement(double rms_px) {
  const double wanted = kLongestLinePx / 3.0 / std::max(rms_px, 1e-3);
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double step : {5.0, 2.0})
    if (wanted >= step * decade) return step * decade;
  return decade;
}

std::string Cross(const Eigen::Vector2d& at) {
  return fmt::format("<path d='M{0:.1f} {1:.1f}l8 8m0 -8l-8 8' stroke='#94a1ad' stroke-width='1.5'/>",
                     at.x() - 4.0, at.y() - 4.0);
}

std::string ResidualLine(const recon::PointResidual& point, double enlargement, double worst_px) {
  const Eigen::Vector2d to = point.pixel + enlargement * point.residual_px;
  const std::string colour = sessions::DepthColour(std::min(point.residual_px.norm() / worst_px, 1.0));
  return fmt::format("<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='{}' stroke-width='1.3'/>",
                     point.pixel.x(), point.pixel.y(), to.x(), to.y(), colour);
}

// One slice of the map, seen from above.
class Slice {
 public:
  Slice(const UncertaintyMap& map, int layer, double left, double top, double scale, double worst_mm)
      : map_(map), layer_(layer), left_(left), top_(top), scale_(scale), worst_mm_(worst_mm) {}

  [[nodiscard]] double width() const { return scale_ * map_.nodes.x(); }
  [[nodiscard]] double height() const { return scale_ * map_.nodes.y(); }

  [[nodiscard]] std::string Svg() const {
    std::string svg =
        fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='#dde3e9'/>", left_,
                    top_, width(), height());
    for (int y = 0; y < map_.nodes.y(); ++y)
      for (int x = 0; x < map_.nodes.x();) x = AddRun(x, y, &svg);
    const double z_mm = map_.first_node_mm.z() + map_.edge_mm * layer_;
    return svg + sessions::Label(left_, top_ - 8.0, fmt::format("at a height of {:.0f} mm", z_mm), "quiet");
  }

 private:
  [[nodiscard]] const UncertaintyMap::Node& At(int x, int y) const {
    return map_.values[static_cast<std::size_t>((layer_ * map_.nodes.y() + y) * map_.nodes.x() + x)];
  }
  // Steps of colour, so that neighbours of one colour become one rectangle; -1: unknown.
  [[nodiscard]] int Shade(int x, int y) const {
    const UncertaintyMap::Node& node = At(x, y);
    if (!node.is_known) return -1;
    return std::min(static_cast<int>(kShades * node.sigma_mm / worst_mm_), kShades);
  }
  // Draws the nodes from x on that have one colour, and returns the first one after them.
  int AddRun(int x, int y, std::string* svg) const {
    const int shade = Shade(x, y);
    int end = x + 1;
    while (end < map_.nodes.x() && Shade(end, y) == shade) ++end;
    if (shade < 0) return end;
    *svg +=
        fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}'/>",
                    left_ + scale_ * x, top_ + scale_ * (map_.nodes.y() - 1 - y), scale_ * (end - x) + 0.2,
                    scale_ + 0.2, sessions::DepthColour(static_cast<double>(shade) / kShades));
    return end;
  }

  static constexpr int kShades = 24;
  const UncertaintyMap& map_;
  int layer_;
  double left_;
  double top_;
  double scale_;
  double worst_mm_;
};

std::string Legend(double left, double top, double worst_mm) {
  constexpr int kSteps = 24;
  constexpr double kWidth = 8.0, kHeight = 12.0;
  std::string svg;
  for (int i = 0; i < kSteps; ++i) {
    svg +=
        fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{}' fill='{}'/>", left + kWidth * i,
                    top, kWidth + 0.2, kHeight, sessions::DepthColour(static_cast<double>(i) / (kSteps - 1)));
  }
  const double right = left + kWidth * kSteps;
  return svg + sessions::Label(left, top + kHeight + 15.0, "0 mm", "tick") +
         sessions::Label(right, top + kHeight + 15.0, fmt::format("{:.2f} mm and more", worst_mm), "tick",
                         Anchor::kEnd) +
         sessions::Label(right + 24.0, top + kHeight - 2.0, "grey: fewer than two cameras see it", "tick");
}

}  // namespace

std::string ResidualPicture(const CalibrationOutcome& outcome, int camera) {
  const auto at = static_cast<std::size_t>(camera);
  const recon::CalibrationCamera& of_input = outcome.input.cameras[at];
  const double rms_px = outcome.result.cameras[at].rms_px, enlargement = Enlargement(rms_px);
  // Pictures of all sizes are drawn as wide, so that the words below have one size.
  constexpr double kWidth = 1040.0;
  const double scale = kWidth / of_input.width_px, height = scale * of_input.height_px;
  std::string svg = fmt::format(
      "<svg viewBox='-1 -1 {} {:.1f}' role='img'><g transform='scale({:.5f})'><rect width='{}' height='{}' "
      "fill='#f4f6f8' stroke='#94a1ad'/>",
      kWidth + 2.0, height + 24.0, scale, of_input.width_px, of_input.height_px);
  for (std::size_t i = 0; i < outcome.input.views.size(); ++i) {
    if (outcome.input.views[i].camera != camera) continue;
    const recon::ViewOutcome& view = outcome.result.views[i];
    for (const recon::PointResidual& point : view.residuals)
      svg +=
          view.is_used && point.is_used ? ResidualLine(point, enlargement, 3.0 * rms_px) : Cross(point.pixel);
  }
  return svg + "</g>" +
         sessions::Label(
             0.0, height + 18.0,
             fmt::format("lines: residuals, {:.0f} times as long; crosses: points left out", enlargement),
             "remark") +
         "</svg>";
}

std::string UncertaintyPicture(const CalibrationOutcome& outcome) {
  if (!outcome.uncertainty_mm) return "";
  const UncertaintyMap& map = outcome.map;
  constexpr double kWidth = 1040.0, kGap = 20.0, kTop = 30.0;
  const double scale = std::min((kWidth - 2.0 * kGap) / 3.0 / map.nodes.x(), 320.0 / map.nodes.y());
  const double worst_mm = std::max(outcome.uncertainty_mm->p95, 1e-3);
  const std::array<int, 3> layers = {0, map.nodes.z() / 2, map.nodes.z() - 1};
  std::string svg;
  double left = 0.0, bottom = 0.0;
  for (const int layer : layers) {
    const Slice slice(map, layer, left, kTop, scale, worst_mm);
    svg += slice.Svg();
    left += slice.width() + kGap;
    bottom = kTop + slice.height();
  }
  return fmt::format("<svg viewBox='0 0 {} {:.0f}' role='img'>", kWidth, bottom + 60.0) + svg +
         Legend(0.0, bottom + 18.0, worst_mm) + "</svg>";
}

}  // namespace elbowroom::control
