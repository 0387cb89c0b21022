#include "app/control/heat_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "app/control/line_drawing.h"
#include "core/bvh.h"
#include "core/part_distance.h"
#include "core/surface_patches.h"
#include "core/units.h"
#include "recon/appearance/orbit_camera.h"
#include "sessions/report/chart.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

constexpr int kHeatViewPx = 600;    // of one view, square
constexpr double kTextSize = 20.0;  // a report shows the picture at half its size
constexpr int kBarPx = 76;          // below it
// The mean direction of the touched patches decides from which side to look only if its horizontal share is
// above this.
constexpr double kSideways = 0.1;
constexpr int kShades = 24;  // in the bar
// The part is drawn in this colour. The drawn colour divided by this one is the light on a pixel, by which
// the colour of its patch is multiplied.
const Eigen::Vector3f kPartColor(0.86F, 0.87F, 0.88F);

// The view and the part in it. As the lamp hangs above, a part that was touched from below is turned over
// about x.
struct HeatView {
  recon::SceneView view;
  core::RigidTransform world_from_part;
};

// The view that faces the sum of the touched patches' normals: from above, or from below by turning the part
// over, and from any side.
HeatView BestView(const core::TriangleMesh& mesh, const core::SurfacePatches& patches,
                  const core::HeatMap& map) {
  Vector3d heat = Vector3d::Zero();  // sum of the outward area normals, each times its patch's dwell time
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::size_t patch = patches.FirstOf(t);
    for (const core::SurfacePatches::Corners& p : patches.CornersOf(t))
      heat += static_cast<double>(map.dwell_s[patch++]) * (p.b - p.a).cross(p.c - p.a);
  }
  HeatView best;
  if (heat.z() < 0.0) best.world_from_part.rotation = Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const Vector3d to_heat = best.world_from_part.rotation * heat;
  recon::OrbitCamera camera;
  camera.elevation_rad = core::RadiansFromDegrees(45.0);
  camera.azimuth_rad = core::RadiansFromDegrees(-60.0);
  if (to_heat.head<2>().norm() > kSideways * to_heat.norm())
    camera.azimuth_rad = std::atan2(to_heat.y(), to_heat.x());
  const Eigen::AlignedBox3d bounds = core::BoundsOf(mesh, best.world_from_part);
  best.view =
      recon::ViewFrom(recon::FittedTo(camera, bounds, kHeatViewPx, kHeatViewPx), kHeatViewPx, kHeatViewPx);
  return best;
}

recon::gl::Scene SceneOf(const core::SharedMesh& mesh, const HeatView& view) {
  recon::gl::Scene scene;
  scene.view = view.view;
  scene.lamp = recon::gl::LampOver(core::BoundsOf(*mesh, view.world_from_part));
  scene.background_top = scene.background_bottom = Eigen::Vector3f::Ones();
  recon::gl::ScenePart part;
  part.mesh = mesh;
  part.world_from_part = view.world_from_part;
  part.color = kPartColor;
  scene.parts.push_back(std::move(part));
  return scene;
}

// Which patch each pixel shows; nothing where it shows no part.
std::vector<std::optional<std::size_t>> PatchesSeen(const recon::gl::DepthImage& depth, const HeatView& view,
                                                    const core::TriangleTree& tree,
                                                    const core::SurfacePatches& patches) {
  const core::RigidTransform part_from_cam =
      view.world_from_part.Inverse() * view.view.cam_from_world.Inverse();
  std::vector<std::optional<std::size_t>> seen(depth.depth_mm.size());
  std::uint32_t likely = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!(depth.depth_mm[i] > 0.0F)) continue;
    const auto width = static_cast<std::size_t>(depth.width_px);
    const std::size_t row = i / width;
    const Eigen::Vector2d pixel(static_cast<double>(i % width), static_cast<double>(row));
    const Vector3d x_in_part =
        part_from_cam * (view.view.RayInCam(pixel) * static_cast<double>(depth.depth_mm[i]));
    likely = core::FindNearest(tree, {.center = x_in_part}, likely).triangle;
    seen[i] = patches.PatchAt(likely, x_in_part);
  }
  return seen;
}

// The picture of the part with its touched patches coloured, as light as the part is there.
recon::Image Colored(recon::Image picture, const std::vector<std::optional<std::size_t>>& seen,
                     const std::vector<float>& values, float most) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i] || !(values[*seen[i]] > 0.0F)) continue;
    const auto rgb = std::stoul(sessions::DepthColour(static_cast<double>(values[*seen[i]] / most)).substr(1),
                                nullptr, 16);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double color = static_cast<double>((rgb >> (16 - 8 * channel)) & 255U);
      const double light = picture.rgb[3 * i + channel] /
                           (255.0 * static_cast<double>(kPartColor[static_cast<Eigen::Index>(channel)]));
      picture.rgb[3 * i + channel] = static_cast<std::uint8_t>(std::lround(color * std::min(light, 1.0)));
    }
  }
  return picture;
}

LineDrawing ColorBar(const std::string& what, float most, const char* unit) {
  constexpr double kLeft = 60.0, kWidth = 480.0, kTop = kHeatViewPx + 34.0, kHeight = 14.0;
  LineDrawing drawing;
  for (int shade = 0; shade < kShades; ++shade) {
    const double x = kLeft + kWidth * shade / kShades;
    drawing.areas.push_back({{{x, kTop}, {x + kWidth / kShades, kTop + kHeight}},
                             sessions::DepthColour((shade + 0.5) / kShades)});
  }
  drawing.texts = {{{kLeft + 0.5 * kWidth, kTop - 9.0}, what, LineDrawing::Anchor::kMiddle, kTextSize},
                   {{kLeft, kTop + kHeight + 21.0}, "0", LineDrawing::Anchor::kMiddle, kTextSize},
                   {{kLeft + kWidth, kTop + kHeight + 21.0},
                    fmt::format("{:.3g} {}", most, unit),
                    LineDrawing::Anchor::kMiddle,
                    kTextSize}};
  return drawing;
}

LineDrawing TurnedOverNote() {
  LineDrawing note;
  note.texts = {
      {{kHeatViewPx, 26.0}, "seen from below: turned over", LineDrawing::Anchor::kMiddle, kTextSize}};
  return note;
}

void CopyInto(const recon::Image& view, int left_px, recon::Image* picture) {
  for (int y = 0; y < view.height_px; ++y) {
    const auto row = static_cast<std::size_t>(y);
    const std::size_t width = static_cast<std::size_t>(3) * static_cast<std::size_t>(view.width_px);
    std::memcpy(&picture->rgb[3 * (row * static_cast<std::size_t>(picture->width_px) +
                                   static_cast<std::size_t>(left_px))],
                &view.rgb[row * width], width);
  }
}

}  // namespace

recon::Image HeatPicture(recon::gl::SceneRenderer& renderer, const core::SharedMesh& mesh,
                         const core::HeatMap& map) {
  LineDrawing sheet;
  sheet.width_px = 2 * kHeatViewPx;
  sheet.height_px = kHeatViewPx + kBarPx;
  recon::Image picture = ImageOf(sheet);
  const core::SurfacePatches patches(mesh, map.patch_mm);
  const HeatView view = BestView(*mesh, patches, map);
  const recon::gl::Scene scene = SceneOf(mesh, view);
  const recon::Image part = renderer.Render(scene);
  const auto seen = PatchesSeen(renderer.RenderDepth(scene), view, core::TriangleTree(mesh), patches);
  const auto add = [&](const std::vector<float>& values, const std::string& what, const char* unit,
                       int left_px) {
    const float most = std::max(*std::ranges::max_element(values), 1e-9F);
    CopyInto(Colored(part, seen, values, most), left_px, &picture);
    PaintOn(&picture, ColorBar(what, most, unit), left_px);
  };
  add(map.dwell_s, "touched for", "s", 0);
  add(map.peak_depth_mm, "deepest", "mm", kHeatViewPx);
  if (!view.world_from_part.rotation.isIdentity()) PaintOn(&picture, TurnedOverNote());
  return picture;
}

}  // namespace elbowroom::control
