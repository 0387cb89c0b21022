#include "app/control/layout_picture.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "app/control/layout_editing/gap_line.h"
#include "app/control/line_drawing.h"
#include "core/size_text.h"
#include "recon/appearance/orbit_camera.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

constexpr int kLayoutWidthPx = 1200;
constexpr int kLayoutHeightPx = 800;
constexpr std::size_t kMostNamed = 24;  // in the legend
constexpr double kRowPx = 20.0;
constexpr double kElevationRad = 0.25;  // low, so that gaps along z aren't hidden by what is above
constexpr const char* kGapColor = "#b4400a";

// Colours that differ clearly, and are light enough to show shading. Further parts take them again.
constexpr std::array<std::array<int, 3>, 8> kLayoutColors = {{{96, 143, 190},
                                                              {214, 164, 92},
                                                              {113, 173, 125},
                                                              {172, 131, 186},
                                                              {205, 124, 120},
                                                              {92, 176, 180},
                                                              {158, 158, 110},
                                                              {150, 150, 160}}};

Eigen::Vector3f ColorOf(std::size_t part) {
  const auto& [r, g, b] = kLayoutColors[part % kLayoutColors.size()];
  return Eigen::Vector3f(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)) / 255.0F;
}

std::string HexOf(std::size_t part) {
  const auto& [r, g, b] = kLayoutColors[part % kLayoutColors.size()];
  return fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
}

// Puts the text to the right of the point, on a white ground, because parts may have any colour.
void AddLabel(const Eigen::Vector2d& at, const std::string& text, LineDrawing* drawing) {
  constexpr double kSize = 15.0, kLetterPx = 12.0, kFromLinePx = 12.0, kMarginPx = 4.0;
  const double left = at.x() + kFromLinePx, base = at.y() + 0.35 * kSize;
  const double right = left + kLetterPx * static_cast<double>(text.size());
  drawing->areas.push_back(
      {{{left - kMarginPx, base - kSize}, {right + kMarginPx, base + 0.4 * kSize}}, "#ffffff"});
  drawing->texts.push_back(
      {{0.5 * (left + right), base}, text, LineDrawing::Anchor::kMiddle, kSize, kGapColor});
}

void AddGap(const core::Layout& layout, const core::Spacing& gap,
            std::span<const core::RigidTransform> world_from_parts, const recon::SceneView& view,
            LineDrawing* drawing) {
  constexpr double kTickPx = 6.0;
  const auto [from, to] = GapLine(layout, gap, world_from_parts);
  const auto a = view.Project(from), b = view.Project(to);
  if (!a || !b) return;
  drawing->lines.push_back({{{a->x(), a->y()}, {b->x(), b->y()}}, kGapColor, 2.0});
  const Eigen::Vector2d along = *b - *a;
  if (along.norm() > 0.0) {
    const Eigen::Vector2d tick = kTickPx * Eigen::Vector2d(-along.y(), along.x()).normalized();
    for (const Eigen::Vector2d& end : {*a, *b})
      drawing->lines.push_back(
          {{{end.x() - tick.x(), end.y() - tick.y()}, {end.x() + tick.x(), end.y() + tick.y()}},
           kGapColor,
           2.0});
  }
  AddLabel(0.5 * (*a + *b), fmt::format("{} {:.6g} mm", gap.name, core::GapMm(layout, gap, world_from_parts)),
           drawing);
}

// Each part's own size, along its own axes.
void AddLegend(const core::Layout& layout, LineDrawing* drawing) {
  constexpr double kLeft = 14.0, kTop = 14.0, kSquare = 12.0;
  for (std::size_t i = 0; i < layout.parts.size() && i <= kMostNamed; ++i) {
    const double top = kTop + kRowPx * static_cast<double>(i);
    const LineDrawing::Point at{kLeft + kSquare + 8.0, top + kSquare - 1.0};
    if (i == kMostNamed) {
      drawing->texts.push_back({at, fmt::format("and {} more", layout.parts.size() - i)});
      return;
    }
    const Vector3d size_mm = core::BoundsOf(*layout.parts[i].mesh).sizes();
    drawing->areas.push_back({{{kLeft, top}, {kLeft + kSquare, top + kSquare}}, HexOf(i)});
    drawing->texts.push_back({at, fmt::format("{}  {} mm", layout.parts[i].name, core::SizeText(size_mm))});
  }
}

}  // namespace

recon::Image LayoutPicture(recon::gl::SceneRenderer& renderer, const core::Layout& layout,
                           std::span<const core::RigidTransform> world_from_parts) {
  Eigen::AlignedBox3d all;
  recon::gl::Scene scene;
  for (core::PartIndex i = 0; i < layout.parts.size(); ++i) {
    const core::SharedMesh& mesh = layout.parts[i].mesh;
    all.extend(core::BoundsOf(*mesh, world_from_parts[i]));
    recon::gl::ScenePart& part = scene.parts.emplace_back();
    part.mesh = mesh;
    part.world_from_part = world_from_parts[i];
    part.color = ColorOf(i);
  }
  recon::OrbitCamera camera;
  camera.elevation_rad = kElevationRad;
  scene.view = recon::ViewFrom(recon::FittedTo(camera, all, kLayoutWidthPx, kLayoutHeightPx), kLayoutWidthPx,
                               kLayoutHeightPx);
  scene.lamp = recon::gl::LampOver(all);
  recon::Image picture = renderer.Render(scene);
  LineDrawing drawing;
  AddLegend(layout, &drawing);
  for (const core::Spacing& gap : layout.spacings)
    AddGap(layout, gap, world_from_parts, scene.view, &drawing);
  PaintOn(&picture, drawing);
  return picture;
}

}  // namespace elbowroom::control
