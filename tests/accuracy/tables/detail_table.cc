// docs/performance.md, "detail".
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cad_import/mesh_file.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/gl/scene/scene_renderer.h"
#include "tests/accuracy/bumpy_ball.h"
#include "tests/accuracy/interleaved_timing.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/places.h"

namespace elbowroom::accuracy {
namespace {

namespace fs = std::filesystem;
namespace gl = recon::gl;

struct DetailCase {
  std::string what;
  core::SharedMesh mesh;
};

std::vector<DetailCase> Cases() {
  std::vector<DetailCase> cases;
  for (const int rings : {71, 224, 708})
    cases.push_back({"bumpy ball", std::make_shared<const core::TriangleMesh>(BumpyBall(rings))});
  const fs::path cad = test_support::SharedDataFolder() / "cad";
  for (const char* name : {"nasa42/HST.obj", "trimesh_models/1002_tray_bottom.STL",
                           "trimesh_models/cycloidal.ply", "step/ap203_ap214/linkrods.step"}) {
    if (!fs::exists(cad / name)) {
      fmt::print(stderr, "detail: NOT MEASURED: {} is not on this machine\n", (cad / name).string());
      continue;
    }
    cases.push_back(
        {fmt::format("`{}`", name),
         cad_import::ImportMeshFile(cad / name, {.unit_if_file_has_none = core::LengthUnit::kMillimetre})
             .mesh});
  }
  return cases;
}

// The part in the middle of a picture of 640 x 480 pixels; `lifted_mm` moves it, as a gap does.
gl::Scene SceneOf(const core::SharedMesh& mesh, double lifted_mm) {
  const Eigen::AlignedBox3d bounds = core::BoundsOf(*mesh);
  const double size_mm = bounds.diagonal().norm();
  gl::Scene scene;
  recon::OrbitCamera camera;
  camera.target_in_world = bounds.center();
  camera.distance_mm = 1.5 * size_mm;
  scene.view = recon::ViewFrom(camera, 640, 480);
  scene.view.near_mm = 0.02 * size_mm;
  scene.view.far_mm = 20.0 * size_mm;
  scene.parts = {{mesh, {Eigen::Matrix3d::Identity(), {0.0, 0.0, lifted_mm}}}};
  scene.lamp = gl::LampOver(bounds);
  return scene;
}

// Of 255, over the channels of the pixels where a part is.
std::string DifferenceText(const recon::Image& a, const recon::Image& b, const gl::DepthImage& parts) {
  constexpr int kVisible = 8;
  double sum = 0.0;
  std::int64_t channels = 0, visible = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    if (parts.depth_mm[i / 3] <= 0.0F) continue;
    const int by = std::abs(int{a.rgb[i]} - int{b.rgb[i]});
    ++channels;
    sum += by;
    visible += by > kVisible ? 1 : 0;
  }
  const auto of_all = static_cast<double>(channels);
  return fmt::format("{:.2f}, {:.2f} %", sum / of_all, 100.0 * static_cast<double>(visible) / of_all);
}

// A part that is lifted a little from picture to picture, as by a slider, so that its shadows are drawn, too.
class MovingPart {
 public:
  MovingPart(const core::SharedMesh& mesh, gl::PartDetail detail)
      : scenes_{SceneOf(mesh, 0.0), SceneOf(mesh, 0.5)}, renderer_(detail) {
    (void)renderer_.Render(scenes_[0]);
    renderer_.AwaitLevels();
  }
  void DrawNext() { (void)renderer_.Render(scenes_[++pictures_ % 2]); }
  [[nodiscard]] recon::Image Picture() { return renderer_.Render(scenes_[0]); }
  [[nodiscard]] gl::DepthImage Depths() { return renderer_.RenderDepth(scenes_[0]); }
  [[nodiscard]] std::int64_t TrianglesAPicture() {
    const std::int64_t before = renderer_.triangle_count().drawn;
    DrawNext();
    return (renderer_.triangle_count().drawn - before) / 2;  // once from the lamp
  }

 private:
  std::array<gl::Scene, 2> scenes_;
  gl::SceneRenderer renderer_;
  std::size_t pictures_ = 0;
};

}  // namespace

void MeasureDetail(const fs::path& docs) {
  reporting::Table table{{"part", "triangles", "of them drawn", "whole, ms", "by levels, ms", "ratio",
                          "difference of 255: mean, share above 8"},
                         {}};
  for (const DetailCase& detail_case : Cases()) {
    fmt::print(stderr, "detail: {}, {} triangles\n", detail_case.what, detail_case.mesh->triangles.size());
    MovingPart whole(detail_case.mesh, gl::PartDetail::kWhole);
    MovingPart levels(detail_case.mesh, gl::PartDetail::kOnDemand);
    const std::array<std::function<void()>, 2> jobs = {[&] { whole.DrawNext(); }, [&] { levels.DrawNext(); }};
    const std::vector<Timing> timings = TimeInTurns(jobs, 2);
    table.rows.push_back({detail_case.what, fmt::format("{}", detail_case.mesh->triangles.size()),
                          fmt::format("{}", levels.TrianglesAPicture()),
                          fmt::format("{:.1f}", timings[0].median_ms),
                          fmt::format("{:.1f}", timings[1].median_ms),
                          fmt::format("{:.1f}", timings[0].median_ms / timings[1].median_ms),
                          DifferenceText(levels.Picture(), whole.Picture(), whole.Depths())});
  }
  reporting::WriteSection(docs / "performance.md", "detail",
                          fmt::format("{}\n{}", reporting::ToMarkdown(table),
                                      reporting::ToLine(reporting::ThisMachine(docs / ".."))));
}

}  // namespace elbowroom::accuracy
