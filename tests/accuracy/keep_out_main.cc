// keep_out_table SESSION.db [--picture OUT.png] --edge MM...: how far a keep-out volume reaches beyond the
// hulls that it holds, and what it costs (docs/keep_out.md). From random points of its surface, evenly by
// area, rays are cast straight in to the first point of any hull, exactly: an upper bound of the point's
// distance to the hulls.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "app/control/keep_out/keep_out_job.h"
#include "core/error.h"
#include "core/layout.h"
#include "core/spread.h"
#include "core/units.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "recon/images/png_file.h"
#include "sessions/session_reader.h"

namespace {

using namespace elbowroom;
using Eigen::Vector3d;

struct Sample {
  recon::Ray ray;  // straight in
  double reach_mm = 0.0;
};

// Evenly over the surface.
std::vector<Sample> SamplesOf(const core::TriangleMesh& mesh, int count, double reach_mm) {
  std::vector<double> areas;
  const auto at = [&](std::int32_t i) { return mesh.vertices_mm[static_cast<std::size_t>(i)]; };
  for (const auto& [a, b, c] : mesh.triangles) areas.push_back((at(b) - at(a)).cross(at(c) - at(a)).norm());
  std::mt19937_64 engine(24);
  std::discrete_distribution<std::size_t> triangle(areas.begin(), areas.end());
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Sample> samples;
  while (std::ssize(samples) < count) {
    const auto& [a, b, c] = mesh.triangles[triangle(engine)];
    const Vector3d normal = (at(b) - at(a)).cross(at(c) - at(a));
    if (!(normal.norm() > 1e-9)) continue;
    double u = share(engine), v = share(engine);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    samples.push_back({{at(a) + u * (at(b) - at(a)) + v * (at(c) - at(a)), -normal.normalized()}, reach_mm});
  }
  return samples;
}

// Shortens the samples' ways to the first hull on each.
void MeasureExcess(const std::filesystem::path& path, std::vector<Sample>* samples) {
  const sessions::SessionReader session(path);
  const auto rig = std::make_shared<const core::Rig>(session.header().rig);
  const recon::UndistortedPlanes planes = recon::MakeUndistortedPlanes(*rig);
  for (const auto& frame : session.frames()) {
    const core::FrameRecord record = session.ReadFrame(frame.frame);
    if (record.LacksCamera()) continue;
    const recon::VisualHull hull = recon::MakeVisualHull(rig, planes, *record.masks);
    if (hull.IsEmpty()) continue;
    for (Sample& sample : *samples) {
      if (hull.Classify(sample.ray.origin_in_world, sample.reach_mm) == recon::BallAnswer::kOutside) continue;
      const Vector3d in = sample.ray.direction_in_world, aside = in.unitOrthogonal(),
                     across = in.cross(aside);
      for (const Vector3d& lean : {Vector3d(0, 0, 0), aside, Vector3d(-aside), across, Vector3d(-across)})
        sample.reach_mm = recon::FirstInside(hull, {sample.ray.origin_in_world, (in + lean).normalized()},
                                             {0.0, sample.reach_mm})
                              .value_or(sample.reach_mm);
    }
  }
}

void PrintRow(const std::filesystem::path& session, double edge_mm) {
  const control::KeepOutRequest request{{session}, edge_mm, {}, {}};
  std::vector<double> seconds;
  control::KeepOut found;
  for (int run = 0; run < 3; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    found = control::FindKeepOut(request, {}, {});
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::ranges::sort(seconds);
  std::vector<Sample> samples = SamplesOf(found.swept.mesh, 600, found.bound_mm);
  MeasureExcess(session, &samples);
  std::vector<double> excess_mm;
  for (const Sample& sample : samples) excess_mm.push_back(sample.reach_mm);
  const core::Spread spread = *core::SpreadOf(excess_mm);
  const double asked = static_cast<double>(found.work.bounded_cells + found.work.covered_cells);
  const double buried = static_cast<double>(found.work.buried_cells);
  fmt::print(
      "| {:g} | {:.2f} | {} | {:.3f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} | {:.1f} M | {:.0f} % | {:.0f} |\n",
      edge_mm, seconds[1], found.swept.mesh.triangles.size(), core::VolumeMm3(found.swept.mesh) / 1e6,
      spread.median, spread.p95, spread.max, found.bound_mm, static_cast<double>(found.work.balls) / 1e6,
      100.0 * buried / (buried + asked), static_cast<double>(found.bytes) / (1 << 20));
}

// A picture's pixels, each with the nearest point of a surface that is drawn into it.
struct Canvas {
  int width_px, height_px;
  std::vector<double> depth_mm;     // along the view's axis; infinite: nothing
  std::vector<Vector3d> color_rgb;  // 0..1
};

// One triangle, its dwell as a share of the longest from corner to corner.
void DrawTriangle(const recon::SceneView& view, const std::array<Vector3d, 3>& corners,
                  const Vector3d& shares, Canvas* canvas) {
  std::array<Vector3d, 3> seen;  // pixel, 1 / z
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d x_in_cam = view.cam_from_world * corners[k];
    seen[k] << view.focal_px * x_in_cam.head<2>() / x_in_cam.z() + view.PrincipalPoint(), 1.0 / x_in_cam.z();
  }
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const double light = 0.62 + 0.38 * std::max(normal.dot(Vector3d(-0.3, -0.5, 0.8).normalized()), 0.0);
  Eigen::Matrix3d plane;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3d& s = seen[static_cast<std::size_t>(k)];
    plane.col(k) << s.x(), s.y(), 1.0;
  }
  if (!(plane.determinant() < -1e-9)) return;  // turned away: y points down
  const Eigen::Matrix3d weights_of = plane.inverse();
  Eigen::AlignedBox2d box;
  for (const Vector3d& s : seen) box.extend(Eigen::Vector2d(s.head<2>()));
  for (int y = std::max(0, static_cast<int>(box.min().y()));
       y <= std::min(canvas->height_px - 1, static_cast<int>(box.max().y()) + 1); ++y) {
    for (int x = std::max(0, static_cast<int>(box.min().x()));
         x <= std::min(canvas->width_px - 1, static_cast<int>(box.max().x()) + 1); ++x) {
      const Vector3d weights = weights_of * Vector3d(x, y, 1.0);
      if (weights.minCoeff() < -1e-6) continue;
      const double z_mm =
          1.0 / (weights[0] * seen[0].z() + weights[1] * seen[1].z() + weights[2] * seen[2].z());
      const auto pixel = static_cast<std::size_t>(y * canvas->width_px + x);
      if (z_mm >= canvas->depth_mm[pixel]) continue;
      canvas->depth_mm[pixel] = z_mm;
      const double share = std::sqrt(std::clamp(weights.dot(shares), 0.0, 1.0));
      canvas->color_rgb[pixel] =
          light * Vector3d(1.0 - 0.45 * share, 0.88 - 0.85 * share, 0.74 - 0.70 * share);
    }
  }
}

// The volume in shades of its dwell, with the parts where the session ended.
void DrawPicture(const std::filesystem::path& path, double edge_mm, const std::filesystem::path& png) {
  constexpr int kWidthPx = 1200, kHeightPx = 800;
  const control::KeepOut found = control::FindKeepOut({{path}, edge_mm, {}, {}}, {}, {});
  const core::TriangleMesh& mesh = found.swept.mesh;
  const double longest_s = *std::ranges::max_element(found.swept.dwell_s);
  recon::gl::Scene scene;
  const sessions::SessionReader session(path);
  const core::Layout& layout = session.header().layout;
  const auto world_from_parts = core::PosesAt(layout, session.frames().back().spacing_mm);
  for (std::size_t i = 0; i < layout.parts.size(); ++i)
    scene.parts.push_back({layout.parts[i].mesh, world_from_parts[i], {0.55F, 0.64F, 0.76F}, false, 0.55F});
  recon::OrbitCamera camera;
  camera.elevation_rad = core::RadiansFromDegrees(24.0);
  camera.azimuth_rad = core::RadiansFromDegrees(-115.0);
  scene.view = recon::ViewFrom(recon::FittedTo(camera, core::BoundsOf(mesh), kWidthPx, kHeightPx), kWidthPx,
                               kHeightPx);
  scene.lamp = recon::gl::LampOver(core::BoundsOf(mesh));
  recon::gl::SceneRenderer renderer;
  recon::Image picture = renderer.Render(scene);
  const recon::gl::DepthImage parts = renderer.RenderDepth(scene);
  constexpr std::size_t kPixels = std::size_t{kWidthPx} * kHeightPx;
  Canvas canvas{kWidthPx, kHeightPx, std::vector<double>(kPixels, std::numeric_limits<double>::infinity()),
                std::vector<Vector3d>(kPixels)};
  for (const auto& triangle : mesh.triangles) {
    std::array<Vector3d, 3> corners;
    Vector3d shares;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(triangle[k]);
      corners[k] = mesh.vertices_mm[vertex];
      shares[static_cast<Eigen::Index>(k)] = found.swept.dwell_s[vertex] / longest_s;
    }
    DrawTriangle(scene.view, corners, shares, &canvas);
  }
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (std::isinf(canvas.depth_mm[i])) continue;
    const double part_mm = static_cast<double>(parts.depth_mm[i]);
    const double share =
        part_mm > 0.0 && part_mm < canvas.depth_mm[i] ? 0.55 : 1.0;  // behind a part it shows through
    for (std::size_t channel = 0; channel < 3; ++channel) {
      std::uint8_t& value = picture.rgb[3 * i + channel];
      value = static_cast<std::uint8_t>(std::lround(
          share * 255.0 * std::clamp(canvas.color_rgb[i][static_cast<Eigen::Index>(channel)], 0.0, 1.0) +
          (1.0 - share) * value));
    }
  }
  recon::WritePng(picture, png);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"how far a keep-out volume reaches beyond the hulls, and what it costs"};
  std::filesystem::path session, picture;
  std::vector<double> edges_mm;
  app.add_option("SESSION", session)->required();
  app.add_option("--edge", edges_mm)->required();
  app.add_option("--picture", picture);
  CLI11_PARSE(app, argc, argv);
  try {
    if (!picture.empty()) DrawPicture(session, edges_mm.front(), picture);
    if (!picture.empty()) return EXIT_SUCCESS;
    fmt::print(
        "| edge, mm | s | triangles | volume, l | excess median | 95 % | worst, mm | bound, mm | balls | "
        "skipped | "
        "MiB |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const double edge_mm : edges_mm) PrintRow(session, edge_mm);
  } catch (const core::Error& error) {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
