// What parts in the cameras' pictures cost: the figures of docs/camera_overlay.md.
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "app/control/demo_parts.h"
#include "app/control/overlay/camera_overlay.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/app/overlay/overlay_samples.h"
#include "tests/support/processor_time.h"

namespace elbowroom::control {
namespace {

constexpr int kFrames = 40;

std::vector<OverlayPart> PartsAt(double gap_mm, OutlinedMeshes* meshes) {
  static const core::Layout kLayout = DemoLayout();
  const std::array spacing{gap_mm};
  const std::vector<core::RigidTransform> places = core::PosesAt(kLayout, spacing);
  std::vector<OverlayPart> parts;
  for (std::size_t i = 0; i < kLayout.parts.size(); ++i)
    parts.push_back({meshes->Of(kLayout.parts[i].mesh), places[i]});
  return parts;
}

double MedianMs(std::vector<double> times_ms) {
  std::ranges::sort(times_ms);
  return times_ms[times_ms.size() / 2];
}

// All cameras' pictures, one after the other, as the tile maker makes them.
void Measure(const core::Rig& rig, int width_px, int height_px, bool gap_moves) {
  recon::SyntheticRig synthetic(rig, [](double) { return std::vector<recon::SyntheticObject>(); });
  const auto shared = std::make_shared<const core::Rig>(rig);
  OutlinedMeshes meshes;
  std::vector<std::unique_ptr<CameraOverlay>> overlays;
  for (const core::CameraModel& camera : rig.cameras)
    overlays.push_back(std::make_unique<CameraOverlay>(camera, width_px, height_px));
  recon::Image picture{width_px, height_px,
                       std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width_px * height_px), 60)};
  std::vector<double> place_ms, paint_ms;
  for (int i = 0; i < kFrames; ++i) {
    const auto hull = std::make_shared<const recon::VisualHull>(
        recon::MakeVisualHull(shared, synthetic.TrueMasks(recon::DemoSceneAt(4.0 + 0.03 * i).objects)));
    hull->Prepare();
    const std::vector<OverlayPart> parts = PartsAt(gap_moves ? 140.0 + i : 140.0, &meshes);
    const double begin_ms = test_support::ProcessorMs();
    for (const auto& overlay : overlays) overlay->Place(parts);
    const double placed_ms = test_support::ProcessorMs();
    for (const auto& overlay : overlays) overlay->PaintOn(&picture, hull);
    place_ms.push_back(placed_ms - begin_ms);
    paint_ms.push_back(test_support::ProcessorMs() - placed_ms);
  }
  OverlayCount count;
  for (const auto& overlay : overlays) count += overlay->count();
  std::printf("%-12s %zu x %4d x %3d, gap %s: place %.2f ms, paint %.2f ms; parts drawn %lld, kept %lld\n",
              rig.name.c_str(), rig.cameras.size(), width_px, height_px, gap_moves ? "moves" : "stays",
              MedianMs(place_ms), MedianMs(paint_ms), static_cast<long long>(count.parts_drawn),
              static_cast<long long>(count.parts_kept));
}

// A part of many triangles in the four cameras' small pictures.
void MeasureLarge() {
  const core::Rig rig = recon::FourCameraRig();
  auto ball = std::make_shared<const core::TriangleMesh>(BallMesh(90.0, 480));
  const double begin_ms = test_support::ProcessorMs();
  const auto outlined = std::make_shared<const OutlinedMesh>(ball);
  std::printf("outline of %zu triangles: %.0f ms, once\n", ball->triangles.size(),
              test_support::ProcessorMs() - begin_ms);
  std::vector<double> place_ms;
  std::vector<std::unique_ptr<CameraOverlay>> overlays;
  for (const core::CameraModel& camera : rig.cameras)
    overlays.push_back(std::make_unique<CameraOverlay>(camera, 192, 144));
  for (int i = 0; i < 9; ++i) {
    const std::array parts{OverlayPart{outlined, {Eigen::Matrix3d::Identity(), {60.0, 0.0, 150.0 + i}}}};
    const double start_ms = test_support::ProcessorMs();
    for (const auto& overlay : overlays) overlay->Place(parts);
    place_ms.push_back(test_support::ProcessorMs() - start_ms);
  }
  std::printf("four_modern 4 x 192 x 144, it moves: place %.0f ms\n", MedianMs(place_ms));
}

}  // namespace
}  // namespace elbowroom::control

int main() {
  using namespace elbowroom;
  for (const bool gap_moves : {false, true}) {
    control::Measure(recon::FourCameraRig(), 192, 144, gap_moves);
    control::Measure(recon::FourCameraRig(), 640, 480, gap_moves);
    control::Measure(recon::EightCameraRig(), 192, 108, gap_moves);
  }
  control::MeasureLarge();
}
