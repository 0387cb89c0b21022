#include "app/control/import_picture.h"

#include <fmt/format.h>

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "app/control/line_drawing.h"
#include "core/size_text.h"
#include "core/units.h"
#include "recon/appearance/orbit_camera.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

constexpr int kImportWidthPx = 960, kImportViewPx = 660, kLegendPx = 60;
constexpr const char* kOpen = "#d62728";
constexpr const char* kNonManifold = "#9d2bd6";
constexpr const char* kInconsistent = "#1f5fd6";
constexpr const char* kCrossing = "#ff8c00";

recon::SceneView ViewOf(const Eigen::AlignedBox3d& bounds_mm) {
  recon::OrbitCamera camera;
  camera.azimuth_rad = core::RadiansFromDegrees(-55.0);
  camera.elevation_rad = core::RadiansFromDegrees(30.0);
  return recon::ViewFrom(recon::FittedTo(camera, bounds_mm, kImportWidthPx, kImportViewPx), kImportWidthPx,
                         kImportViewPx);
}

recon::gl::Scene SceneOf(const cad_import::CadModel& model, const recon::SceneView& view) {
  recon::gl::Scene scene;
  scene.view = view;
  scene.lamp = recon::gl::LampOver(model.report.bounds_mm);
  scene.background_top = scene.background_bottom = Eigen::Vector3f::Ones();
  for (const cad_import::CadInstance& instance : model.instances) {
    recon::gl::ScenePart part;
    part.mesh = model.shapes[instance.shape].mesh;
    part.world_from_part = instance.model_from_shape;
    if (instance.color) part.color = {(*instance.color)[0], (*instance.color)[1], (*instance.color)[2]};
    scene.parts.push_back(std::move(part));
  }
  return scene;
}

// Lines on the picture; those that reach behind the eye are left out.
class Overlay {
 public:
  Overlay(const recon::SceneView& view, LineDrawing* drawing) : view_(view), drawing_(drawing) {}

  void Add(const std::vector<Vector3d>& points, const char* color, double width) {
    LineDrawing::Line line{{}, color, width};
    for (const Vector3d& point : points) {
      const std::optional<Eigen::Vector2d> pixel = view_.Project(point);
      if (!pixel) return;
      line.points.push_back({pixel->x(), pixel->y()});
    }
    drawing_->lines.push_back(std::move(line));
  }
  void AddAll(const std::vector<cad_import::SurfaceDefects::Segment>& segments, const char* color) {
    for (const auto& [a, b] : segments) Add({a, b}, color, 2.0);
  }

 private:
  const recon::SceneView& view_;
  LineDrawing* drawing_;
};

void AddLegend(const cad_import::CadModel& model, const cad_import::SurfaceDefects& defects,
               LineDrawing* drawing) {
  constexpr double kLeft = 20.0, kFirstLine = kImportViewPx + 24.0, kSecondLine = kImportViewPx + 46.0,
                   kColumn = 230.0;
  drawing->texts.push_back(
      {{kLeft, kFirstLine},
       fmt::format("{} mm, its unit: {}; {} part{}, {} triangles, {}",
                   core::SizeText(model.report.bounds_mm.sizes()), model.report.unit, model.report.parts,
                   model.report.parts == 1 ? "" : "s", model.report.triangles,
                   model.report.watertight ? "watertight" : "open")});
  double left = kLeft;
  const auto add = [&](std::size_t count, const char* what, const char* color) {
    if (count == 0) return;
    drawing->texts.push_back(
        {{left, kSecondLine}, fmt::format("{} {}", count, what), LineDrawing::Anchor::kStart, 13.0, color});
    left += kColumn;
  };
  add(defects.open_edges.size(), "open edges", kOpen);
  add(defects.non_manifold_edges.size(), "edges of 3 or more", kNonManifold);
  add(defects.inconsistent_edges.size(), "edges of turned faces", kInconsistent);
  add(defects.crossing.size(), "triangles that cross", kCrossing);
}

}  // namespace

recon::Image ImportPicture(recon::gl::SceneRenderer& renderer, const cad_import::CadModel& model,
                           const cad_import::SurfaceDefects& defects) {
  LineDrawing sheet;
  sheet.width_px = kImportWidthPx;
  sheet.height_px = kImportViewPx + kLegendPx;
  recon::Image picture = ImageOf(sheet);
  const recon::SceneView view = ViewOf(model.report.bounds_mm);
  const recon::Image scene = renderer.Render(SceneOf(model, view));
  std::memcpy(picture.rgb.data(), scene.rgb.data(), scene.rgb.size());
  LineDrawing drawing;
  Overlay overlay(view, &drawing);
  for (const auto& [a, b, c] : defects.crossing) overlay.Add({a, b, c, a}, kCrossing, 1.5);
  overlay.AddAll(defects.inconsistent_edges, kInconsistent);
  overlay.AddAll(defects.non_manifold_edges, kNonManifold);
  overlay.AddAll(defects.open_edges, kOpen);
  AddLegend(model, defects, &drawing);
  PaintOn(&picture, drawing);
  return picture;
}

}  // namespace elbowroom::control
