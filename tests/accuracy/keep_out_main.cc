// keep_out_table SESSION.db [--picture OUT.png] --edge MM...: how far a keep-out volume reaches beyond the
// hulls that it holds, and what it costs (docs/keep_out.md). From random points of its surface, evenly by
// area, rays are cast straight in to the first point of any hull, exactly: an upper bound of the point's
// distance to the hulls.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
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
      const Vector3d middle =
          sample.ray.origin_in_world + 0.5 * sample.reach_mm * sample.ray.direction_in_world;
      if (hull.Classify(middle, 0.5 * sample.reach_mm) == recon::BallAnswer::kOutside) continue;
      sample.reach_mm =
          recon::FirstInside(hull, sample.ray, {0.0, sample.reach_mm}).value_or(sample.reach_mm);
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
  std::vector<Sample> samples = SamplesOf(found.swept.mesh, 2000, 2.0 * found.bound_mm);
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

// The volume in shades of its dwell, in a few steps, with the parts where the session ended.
void DrawPicture(const std::filesystem::path& path, double edge_mm, const std::filesystem::path& png) {
  constexpr int kShades = 24, kWidthPx = 1200, kHeightPx = 800;
  const control::KeepOut found = control::FindKeepOut({{path}, edge_mm, {}, {}}, {}, {});
  const core::TriangleMesh& mesh = found.swept.mesh;
  const double longest_s = *std::ranges::max_element(found.swept.dwell_s);
  recon::gl::Scene scene;
  std::vector<core::TriangleMesh> shades(kShades);
  for (const auto& triangle : mesh.triangles) {
    double dwell_s = 0.0;
    for (const std::int32_t i : triangle) dwell_s += found.swept.dwell_s[static_cast<std::size_t>(i)] / 3.0;
    const double share = std::sqrt(std::min(dwell_s / longest_s, 1.0));
    core::TriangleMesh& shade = shades[static_cast<std::size_t>(share * (kShades - 1))];
    auto& corners = shade.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<std::int32_t>(shade.vertices_mm.size());
      shade.vertices_mm.push_back(mesh.vertices_mm[static_cast<std::size_t>(triangle[k])]);
    }
  }
  for (int i = 0; i < kShades; ++i) {
    core::TriangleMesh& shade = shades[static_cast<std::size_t>(i)];
    if (shade.triangles.empty()) continue;
    const float share = static_cast<float>(i) / (kShades - 1);
    scene.parts.push_back(
        {std::make_shared<const core::TriangleMesh>(std::move(shade)),
         {},
         Eigen::Vector3f(1.0F - 0.45F * share, 0.88F - 0.85F * share, 0.74F - 0.70F * share),
         false,
         1.0F});
  }
  const sessions::SessionReader session(path);
  const core::Layout& layout = session.header().layout;
  const auto world_from_parts = core::PosesAt(layout, session.frames().back().spacing_mm);
  for (std::size_t i = 0; i < layout.parts.size(); ++i)
    scene.parts.push_back({layout.parts[i].mesh, world_from_parts[i], {0.55F, 0.64F, 0.76F}, false, 0.45F});
  recon::OrbitCamera camera;
  camera.elevation_rad = core::RadiansFromDegrees(24.0);
  camera.azimuth_rad = core::RadiansFromDegrees(-115.0);
  scene.view = recon::ViewFrom(recon::FittedTo(camera, core::BoundsOf(mesh), kWidthPx, kHeightPx), kWidthPx,
                               kHeightPx);
  scene.lamp = recon::gl::LampOver(core::BoundsOf(mesh));
  recon::gl::SceneRenderer renderer;
  recon::WritePng(renderer.Render(scene), png);
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
