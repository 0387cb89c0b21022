#include "app/control/coverage/coverage_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/control/coverage/coverage_text.h"
#include "sessions/report/chart.h"
#include "sessions/report/markup.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using recon::CoverageNode;
using sessions::Anchor;

constexpr int kShades = 20;  // steps of colour, so that neighbours of one colour become one rectangle

std::optional<double> ValueOf(const CoverageNode& node, CoverageQuantity quantity) {
  switch (quantity) {
    case CoverageQuantity::kUncertainty:
      return node.has_sigma ? std::optional<double>(node.sigma_mm) : std::nullopt;
    case CoverageQuantity::kFootprint:
      return node.cameras > 0 ? std::optional<double>(node.footprint_mm) : std::nullopt;
    case CoverageQuantity::kCameras:
      return node.cameras;
    case CoverageQuantity::kPhantom:
      return node.has_phantom ? std::optional<double>(node.phantom) : std::nullopt;
  }
  return std::nullopt;
}

// From what value to what value the colours go.
struct ColourScale {
  double low = 0.0;
  double high = 1.0;
  bool more_is_better = false;

  [[nodiscard]] int ShadeOf(double value) const {
    const double share = std::clamp((value - low) / (high - low), 0.0, 1.0);
    return static_cast<int>(std::lround(kShades * (more_is_better ? 1.0 - share : share)));
  }
};

ColourScale ScaleFor(const CoverageOutcome& outcome, CoverageQuantity quantity) {
  std::vector<double> values;
  for (const CoverageNode& node : outcome.nodes)
    if (const std::optional<double> value = ValueOf(node, quantity)) values.push_back(*value);
  if (quantity == CoverageQuantity::kCameras) {
    const auto most = static_cast<double>(std::min<std::size_t>(outcome.rig.rig.cameras.size(), 255));
    return {0.0, most, true};
  }
  if (values.empty()) return {};
  std::ranges::sort(values);
  const double low = core::PercentileOf(values, 0.05), high = core::PercentileOf(values, 0.95);
  // A quantity that is the same everywhere has one colour.
  return {low, std::max(high, low + std::max(1e-3 * low, 1e-9)), false};
}

std::string ShadeColour(int shade) { return sessions::DepthColour(static_cast<double>(shade) / kShades); }

// A slice across one axis, `u` to the right and `v` upwards.
struct Panel {
  std::string title;
  Eigen::Index u = 0;
  Eigen::Index v = 1;
  Eigen::Index across = 2;
  int layer = 0;
};

std::vector<Panel> PanelsOf(const recon::CoverageGrid& grid) {
  std::vector<Panel> panels;
  const auto layer_at = [&](Eigen::Index axis, double share) {
    return static_cast<int>(std::lround(share * (grid.counts[axis] - 1)));
  };
  const auto add = [&](const char* how, Eigen::Index u, Eigen::Index v, Eigen::Index across, double share) {
    const int layer = layer_at(across, share);
    const double at_mm = grid.first_mm[across] + grid.edge_mm * layer;
    panels.push_back({fmt::format("{}, {} = {:.0f} mm", how, "xyz"[across], at_mm), u, v, across, layer});
  };
  std::vector<double> heights = {0.1, 0.5, 0.9};
  if (grid.counts.z() < 3) heights = {0.0};
  for (const double height : heights) add("from above", 0, 1, 2, height);
  add("from the front", 0, 2, 1, 0.5);
  add("from the right", 1, 2, 0, 0.5);
  return panels;
}

// Draws one panel.
class SlicePicture {
 public:
  SlicePicture(const CoverageOutcome& outcome, CoverageQuantity quantity, const ColourScale& colours,
               const Panel& panel, const Vector2d& corner, double width)
      : outcome_(outcome), quantity_(quantity), colours_(colours), panel_(panel) {
    const Eigen::AlignedBox3d& box = outcome.rig.rig.workspace_mm;
    const double margin_mm = kMargin * box.sizes().maxCoeff();
    low_ = Vector2d(box.min()[panel.u], box.min()[panel.v]).array() - margin_mm;
    high_ = Vector2d(box.max()[panel.u], box.max()[panel.v]).array() + margin_mm;
    scale_ = width / (high_ - low_).x();
    corner_ = corner;
  }

  [[nodiscard]] double height() const { return scale_ * (high_ - low_).y(); }

  [[nodiscard]] std::string Svg() const {
    const Vector2d size = scale_ * (high_ - low_);
    std::string svg =
        fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='#f4f6f8'/>",
                    corner_.x(), corner_.y(), size.x(), size.y());
    const Eigen::AlignedBox3d& box = outcome_.rig.rig.workspace_mm;
    svg += RectangleOf({box.min()[panel_.u], box.min()[panel_.v]}, {box.max()[panel_.u], box.max()[panel_.v]},
                       "fill='#cfd6dd'");
    svg += "<g shape-rendering='crispEdges'>";
    for (int row = 0; row < outcome_.grid.counts[panel_.v]; ++row)
      for (int column = 0; column < outcome_.grid.counts[panel_.u];) column = AddRun(column, row, &svg);
    svg += "</g>";
    for (std::size_t i = 0; i < outcome_.layout.parts.size(); ++i) svg += Outline(i);
    svg += Dots();
    return svg + sessions::Label(corner_.x(), corner_.y() - 7.0, panel_.title, "quiet") +
           sessions::Label(corner_.x() + size.x() - 4.0, corner_.y() + size.y() - 5.0,
                           fmt::format("{} \u2192, {} \u2191", "xyz"[panel_.u], "xyz"[panel_.v]), "tick",
                           Anchor::kEnd);
  }

 private:
  [[nodiscard]] Vector2d At(const Vector2d& uv_mm) const {
    return corner_ + scale_ * Vector2d(uv_mm.x() - low_.x(), high_.y() - uv_mm.y());
  }
  [[nodiscard]] Vector2d UvOf(const Vector3d& x_mm) const { return {x_mm[panel_.u], x_mm[panel_.v]}; }

  [[nodiscard]] std::string RectangleOf(const Vector2d& from_mm, const Vector2d& to_mm,
                                        const std::string& fill) const {
    const Vector2d a = At(from_mm), b = At(to_mm);
    return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' {}/>", a.x(), b.y(),
                       b.x() - a.x() + 0.2, a.y() - b.y() + 0.2, fill);
  }

  [[nodiscard]] int ShadeAt(int column, int row) const {
    Eigen::Vector3i node;
    node[panel_.u] = column, node[panel_.v] = row, node[panel_.across] = panel_.layer;
    const auto value = ValueOf(outcome_.nodes[outcome_.grid.NodeAt(node.x(), node.y(), node.z())], quantity_);
    return value ? colours_.ShadeOf(*value) : -1;
  }

  // Draws the nodes from `column` on that have one colour, each as a cell around it that the workspace cuts
  // off. Returns the first one after them.
  int AddRun(int column, int row, std::string* svg) const {
    const int shade = ShadeAt(column, row);
    int end = column + 1;
    while (end < outcome_.grid.counts[panel_.u] && ShadeAt(end, row) == shade) ++end;
    if (shade < 0) return end;
    const Eigen::AlignedBox3d& box = outcome_.rig.rig.workspace_mm;
    const Vector2d first = UvOf(outcome_.grid.first_mm), least(box.min()[panel_.u], box.min()[panel_.v]),
                   most(box.max()[panel_.u], box.max()[panel_.v]);
    const Vector2d from = first + outcome_.grid.edge_mm * Vector2d(column - 0.5, row - 0.5),
                   to = first + outcome_.grid.edge_mm * Vector2d(end - 0.5, row + 0.5);
    *svg +=
        RectangleOf(from.cwiseMax(least), to.cwiseMin(most), fmt::format("fill='{}'", ShadeColour(shade)));
    return end;
  }

  // The convex outline of a part's shadow on the slice.
  [[nodiscard]] std::string Outline(std::size_t part) const {
    std::vector<Vector2d> points;
    for (const Vector3d& x : outcome_.layout.parts[part].mesh->vertices_mm)
      points.push_back(UvOf(outcome_.world_from_parts[part] * x));
    std::string path;
    for (const Vector2d& corner : ConvexOutline(std::move(points))) {
      const Vector2d at = At(corner.cwiseMax(low_).cwiseMin(high_));
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", at.x(), at.y());
    }
    return fmt::format(
        "<path d='{}Z' fill='none' stroke='#1c5d99' stroke-width='1.4'><title>{}</title></path>", path,
        sessions::Escaped(outcome_.layout.parts[part].name));
  }

  // Andrew's monotone chain.
  [[nodiscard]] static std::vector<Vector2d> ConvexOutline(std::vector<Vector2d> points) {
    std::ranges::sort(points, [](const Vector2d& a, const Vector2d& b) {
      return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
    });
    std::vector<Vector2d> outline;
    for (int side = 0; side < 2; ++side) {
      const std::size_t begin = outline.size();
      for (const Vector2d& p : points) {
        while (outline.size() >= begin + 2) {
          const Vector2d a = outline[outline.size() - 2], b = outline.back();
          if ((b - a).x() * (p - a).y() - (b - a).y() * (p - a).x() > 0.0) break;
          outline.pop_back();
        }
        outline.push_back(p);
      }
      if (!outline.empty()) outline.pop_back();
      std::ranges::reverse(points);
    }
    return outline;
  }

  // All cameras, with names that don't lie on each other, on a white halo.
  [[nodiscard]] std::string Dots() const {
    std::vector<Vector2d> names;
    std::string svg = "<g style='paint-order:stroke;stroke:#ffffff;stroke-width:2.5px'>";
    for (const core::CameraModel& camera : outcome_.rig.rig.cameras)
      svg += Dot(camera.center_in_world(), camera.name(), "#1d2733", &names);
    if (outcome_.next && !outcome_.next->best.empty())
      svg += Dot(outcome_.next->best.front().center_mm, "next", "#2e7d4f", &names);
    return svg + "</g>";
  }

  // Hollow and on the picture's edge where the place is beyond it.
  [[nodiscard]] std::string Dot(const Vector3d& x_mm, const std::string& name, const char* colour,
                                std::vector<Vector2d>* names) const {
    constexpr double kNameWidth = 60.0, kNameHeight = 12.0;
    const Vector2d uv = UvOf(x_mm), inset = 0.03 * (high_ - low_),
                   held = uv.cwiseMax(low_ + inset).cwiseMin(high_ - inset);
    const Vector2d at = At(held);
    const bool at_right = at.x() > corner_.x() + 0.5 * scale_ * (high_ - low_).x();
    Vector2d name_at = at + Vector2d(at_right ? -7.0 : 7.0, 4.0);
    const auto lies_on = [&](const Vector2d& other) {
      return std::abs(other.x() - name_at.x()) < kNameWidth &&
             std::abs(other.y() - name_at.y()) < kNameHeight;
    };
    while (std::ranges::any_of(*names, lies_on)) name_at.y() += kNameHeight;
    names->push_back(name_at);
    return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4' style='fill:{};stroke:{};stroke-width:1.6px'/>",
                       at.x(), at.y(), held != uv ? "#ffffff" : colour, colour) +
           sessions::Label(name_at.x(), name_at.y(), sessions::Shortened(name, 14), "remark",
                           at_right ? Anchor::kEnd : Anchor::kStart);
  }

  static constexpr double kMargin = 0.22;  // around the workspace, of its longest side
  const CoverageOutcome& outcome_;
  CoverageQuantity quantity_;
  const ColourScale& colours_;
  const Panel& panel_;
  Vector2d low_;   // mm
  Vector2d high_;  // mm
  Vector2d corner_;
  double scale_ = 1.0;  // of the picture's units to a mm
};

std::string Shown(double value, CoverageQuantity quantity) {
  switch (quantity) {
    case CoverageQuantity::kUncertainty:
    case CoverageQuantity::kFootprint:
      return MmText(value) + " mm";
    case CoverageQuantity::kCameras:
      return fmt::format("{:.0f}", value);
    case CoverageQuantity::kPhantom:
      return PercentText(value);
  }
  return "";
}

const char* GreyOf(CoverageQuantity quantity) {
  switch (quantity) {
    case CoverageQuantity::kUncertainty:
      return "grey: fewer than two cameras see it";
    case CoverageQuantity::kFootprint:
      return "grey: no camera sees it";
    case CoverageQuantity::kCameras:
      return "";
    case CoverageQuantity::kPhantom:
      return "grey: nothing can be found there";
  }
  return "";
}

std::string Legend(const ColourScale& colours, CoverageQuantity quantity, bool has_parts, double top) {
  constexpr double kWidth = 15.0, kHeight = 13.0;
  std::string svg;
  for (int i = 0; i <= kShades; ++i) {
    const int shade = colours.more_is_better ? kShades - i : i;
    svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}'/>", kWidth * i,
                       top, kWidth + 0.2, kHeight, ShadeColour(shade));
  }
  const double right = kWidth * (kShades + 1);
  const bool is_exact = quantity == CoverageQuantity::kCameras;  // else a twentieth is beyond either end
  const std::array<std::pair<double, Anchor>, 3> marks = {
      {{0.0, Anchor::kStart}, {0.5, Anchor::kMiddle}, {1.0, Anchor::kEnd}}};
  for (const auto& [share, anchor] : marks) {
    const double value = colours.low + share * (colours.high - colours.low);
    if (is_exact && value != std::round(value)) continue;
    const char* beyond = is_exact || share == 0.5 ? "" : share == 0.0 ? " and less" : " and more";
    svg +=
        sessions::Label(share * right, top + kHeight + 15.0, Shown(value, quantity) + beyond, "tick", anchor);
  }
  return svg + sessions::Label(
                   right + 24.0, top + kHeight - 2.0,
                   fmt::format("{}{}dots: cameras; hollow: beyond the picture's edge{}", GreyOf(quantity),
                               *GreyOf(quantity) ? "; " : "", has_parts ? "; blue: parts" : ""),
                   "tick");
}

}  // namespace

const char* NameOf(CoverageQuantity quantity) {
  switch (quantity) {
    case CoverageQuantity::kUncertainty:
      return "uncertainty_mm";
    case CoverageQuantity::kFootprint:
      return "footprint_mm";
    case CoverageQuantity::kCameras:
      return "cameras_seeing";
    case CoverageQuantity::kPhantom:
      return "phantom_fraction";
  }
  return "";
}

const char* TitleOf(CoverageQuantity quantity) {
  switch (quantity) {
    case CoverageQuantity::kUncertainty:
      return "Error of a point";
    case CoverageQuantity::kFootprint:
      return "Width of a pixel";
    case CoverageQuantity::kCameras:
      return "Cameras that see";
    case CoverageQuantity::kPhantom:
      return "Phantom volume";
  }
  return "";
}

std::string ExplanationOf(CoverageQuantity quantity, const CoverageOutcome& outcome) {
  switch (quantity) {
    case CoverageQuantity::kUncertainty:
      return "How far a point, located by all cameras that see it, is off: one standard deviation, in mm.";
    case CoverageQuantity::kFootprint:
      return "How wide a pixel is at that place, in the camera that sees it the most coarsely. Finer things "
             "may be lost.";
    case CoverageQuantity::kCameras:
      return "How many cameras have the place in their pictures.";
    case CoverageQuantity::kPhantom:
      return fmt::format(
          "How much of what the rig takes for a ball of {} mm isn't the ball: what no camera refutes.",
          MmText(outcome.options.ball_mm));
  }
  return "";
}

const std::optional<core::Spread>& SpreadOf(const recon::CoverageFigures& figures,
                                            CoverageQuantity quantity) {
  switch (quantity) {
    case CoverageQuantity::kUncertainty:
      return figures.uncertainty_mm;
    case CoverageQuantity::kFootprint:
      return figures.footprint_mm;
    case CoverageQuantity::kCameras:
      return figures.cameras_seeing;
    case CoverageQuantity::kPhantom:
      break;
  }
  return figures.phantom_fraction;
}

std::string CoveragePicture(const CoverageOutcome& outcome, CoverageQuantity quantity) {
  constexpr double kWidth = 1040.0, kGap = 20.0, kTitle = 26.0;
  const double panel_width = (kWidth - 2.0 * kGap) / 3.0;
  const ColourScale colours = ScaleFor(outcome, quantity);
  std::string svg;
  Vector2d corner(0.0, kTitle);
  double row_height = 0.0;
  for (const Panel& panel : PanelsOf(outcome.grid)) {
    if (panel.across != 2 && corner.x() > 0.0 && panel.u == 0)
      corner = {0.0, corner.y() + row_height + kTitle}, row_height = 0.0;
    const SlicePicture slice(outcome, quantity, colours, panel, corner, panel_width);
    svg += slice.Svg();
    row_height = std::max(row_height, slice.height());
    corner.x() += panel_width + kGap;
  }
  const double bottom = corner.y() + row_height;
  return fmt::format("<svg viewBox='0 0 {} {:.0f}' role='img'>", kWidth, bottom + 56.0) + svg +
         Legend(colours, quantity, !outcome.layout.parts.empty(), bottom + 16.0) + "</svg>";
}

std::string StandaloneSvg(const std::string& svg) {
  constexpr std::string_view kBegin = "<svg ";
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' {}<style>text{{font:12px sans-serif;fill:#1d2733}}"
      ".tick,.remark,.quiet{{fill:#5c6b7a}}</style>{}\n",
      svg.substr(kBegin.size(), svg.find('>') + 1 - kBegin.size()), svg.substr(svg.find('>') + 1));
}

}  // namespace elbowroom::control
