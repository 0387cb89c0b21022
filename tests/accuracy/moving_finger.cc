#include "tests/accuracy/moving_finger.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/units.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/actors.h"
#include "tests/accuracy/disturbed_rig.h"
#include "tests/accuracy/quantile.h"
#include "tests/accuracy/synthetic_segmentation.h"
#include "tests/oracles/coverage_mask.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

// Wrist frame of recon::Hand: the index finger's knuckle and how far a curled finger stands out beyond it.
const Vector3d kKnuckleInWrist(95.0, 27.0, 0.0);
constexpr double kFistMm = 9.0;
constexpr double kForearmMm = 260.0;

// All fingers curled.
recon::HandShape Fist() {
  const auto bend = [](double base_deg, double middle_deg, double tip_deg) {
    return recon::FingerBend{core::RadiansFromDegrees(base_deg), core::RadiansFromDegrees(middle_deg),
                             core::RadiansFromDegrees(tip_deg)};
  };
  recon::HandShape shape = recon::TongsPinch();
  shape.fingers.fill(bend(80.0, 85.0, 40.0));
  return shape;
}

// Wrist axes in the world: x along the finger, z (the back of the hand) as far up, or else away from the
// participant, as that allows.
Eigen::Matrix3d WristAxes(const Vector3d& axis_in_world) {
  const bool is_upright = std::abs(axis_in_world.z()) > 0.9;
  const Vector3d up = is_upright ? Vector3d::UnitY() : Vector3d::UnitZ();
  const Vector3d back = (up - up.dot(axis_in_world) * axis_in_world).normalized();
  Eigen::Matrix3d world_from_wrist;
  world_from_wrist << axis_in_world, back.cross(axis_in_world), back;
  return world_from_wrist;
}

std::vector<recon::Solid> FistBehind(const FingerPlace& place) {
  const Eigen::Matrix3d axes = WristAxes(place.axis_in_world);
  const Vector3d middle_in_wrist = kKnuckleInWrist + Vector3d(kFistMm + 0.5 * kFingerLengthMm, 0.0, 0.0);
  const core::RigidTransform world_from_wrist{axes, place.middle_in_world - axes * middle_in_wrist};
  // The arm is level unless the hand points down: it never goes through the table.
  Vector3d to_elbow = -place.axis_in_world;
  if (place.axis_in_world.z() > -0.9) to_elbow.z() = 0.0;
  return recon::Hand(world_from_wrist, Fist(),
                     world_from_wrist.translation_mm + kForearmMm * to_elbow.normalized())
      .solids;
}

bool Sees(const core::CameraModel& camera, const Vector3d& center_in_world, double radius_mm) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto pixel = camera.Project(center_in_world + side * radius_mm * Vector3d::Unit(axis));
      if (!pixel || pixel->x() < 0.0 || pixel->y() < 0.0 || pixel->x() > camera.width_px() - 1 ||
          pixel->y() > camera.height_px() - 1)
        return false;
    }
  }
  return true;
}

FingerWidths WidthsIn(const recon::VisualHull& hull, const FingerPlace& place) {
  const SectionPlane plane = SectionAt(place);
  FingerWidths widths{MeasureSection(QueriesOf(hull), plane), std::nullopt};
  if (widths.in_hull)
    widths.on_planes_mm = WidthOnPlanes(hull, plane, *widths.in_hull, kEyeInWorld, kPaperSpacingMm);
  return widths;
}

// One calibration of the disturbed rig.
struct DisturbedDraw {
  std::uint64_t seed = 0;
  SightSegmenter segmenter;
  std::shared_ptr<const core::Rig> believed;
  recon::UndistortedPlanes planes;
};

DisturbedDraw MakeDraw(const core::Rig& rig, std::uint64_t seed) {
  auto believed = BelievedRig(rig, DisturbedSights(rig, {}, kPaperDisturbance, seed));
  recon::UndistortedPlanes planes = recon::MakeUndistortedPlanes(*believed);
  return {seed, SightSegmenter(rig, kPaperNoiseLevels, seed), std::move(believed), std::move(planes)};
}

}  // namespace

std::vector<FingerPlace> FingerPlaces(const core::Rig& rig, const Eigen::Vector3i& cells) {
  const double up_rad = core::RadiansFromDegrees(30.0);
  const std::array<Vector3d, 3> axes = {-Vector3d::UnitX(), -Vector3d::UnitZ(),
                                        Vector3d(0.0, std::cos(up_rad), std::sin(up_rad))};
  const Vector3d cell_mm = rig.workspace_mm.sizes().cwiseQuotient(cells.cast<double>());
  std::vector<FingerPlace> places;
  for (int z = 0; z < cells.z(); ++z) {
    for (int y = 0; y < cells.y(); ++y) {
      for (int x = 0; x < cells.x(); ++x) {
        const Vector3d middle =
            rig.workspace_mm.min() + cell_mm.cwiseProduct(Vector3d(x + 0.5, y + 0.5, z + 0.5));
        const auto cameras = std::ranges::count_if(
            rig.cameras, [&](const core::CameraModel& camera) { return Sees(camera, middle, kFingerMm); });
        for (std::size_t i = 0; i < axes.size(); ++i)
          places.push_back({static_cast<int>(places.size()), middle, axes[i], kFingerDirections[i],
                            static_cast<int>(cameras)});
      }
    }
  }
  return places;
}

std::vector<recon::Solid> FingerSolids(const FingerPlace& place, FingerHolder holder) {
  // Round ends: the tip stands a radius beyond the capsule's segment; the other end is in the fist.
  const double half_mm = 0.5 * kFingerLengthMm, radius_mm = 0.5 * kFingerMm;
  const Vector3d color_bgr(135.0, 165.0, 225.0);
  std::vector<recon::Solid> solids = {recon::CapsuleBetween(
      place.middle_in_world - (half_mm - radius_mm) * place.axis_in_world,
      place.middle_in_world + (half_mm - radius_mm) * place.axis_in_world, radius_mm, color_bgr)};
  if (holder == FingerHolder::kNothing) return solids;
  const std::vector<recon::Solid> fist = FistBehind(place);
  solids.insert(solids.end(), fist.begin(), fist.end());
  return solids;
}

SectionPlane SectionAt(const FingerPlace& place) {
  return SectionSeenFrom(kEyeInWorld, place.middle_in_world, place.axis_in_world);
}

FingerReconstruction PerfectCameras(const core::Rig& rig, FingerHolder holder) {
  return {holder == FingerHolder::kFist ? "perfect cameras" : "perfect cameras, the finger without a hand", 1,
          false, [=](const FingerPlace& place, int) -> FingerWidths {
            const oracles::AnalyticHull hull(rig, FingerSolids(place, holder));
            return {MeasureSection(QueriesOf(hull), SectionAt(place)), std::nullopt};
          }};
}

FingerMasks PerfectMasksOf(const core::Rig& rig, std::span<const FingerPlace> places) {
  std::vector<std::vector<core::SoftMask>> masks(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    const std::vector<recon::Solid> solids = FingerSolids(places[i], FingerHolder::kFist);
    for (const core::CameraModel& camera : rig.cameras)
      masks[i].push_back(oracles::CoverageMask(camera, solids));
  });
  FingerMasks by_number;
  for (std::size_t i = 0; i < places.size(); ++i) by_number[places[i].number] = std::move(masks[i]);
  return by_number;
}

FingerReconstruction PerfectMasks(const core::Rig& rig, FingerMasks masks) {
  const auto shared = std::make_shared<const core::Rig>(rig);
  return {"perfect masks, boundary between pixels", 1, true,
          [=, planes = recon::MakeUndistortedPlanes(*shared), by_number = std::move(masks)](
              const FingerPlace& place, int) {
            return WidthsIn(recon::MakeVisualHull(shared, planes, by_number.at(place.number)), place);
          }};
}

FingerReconstruction DisturbedRig(const core::Rig& rig, int draws) {
  auto made = std::make_shared<std::vector<DisturbedDraw>>();
  for (int i = 0; i < draws; ++i) made->push_back(MakeDraw(rig, static_cast<std::uint64_t>(i) + 1));
  return {"the paper's errors all together", draws, true, [=](const FingerPlace& place, int draw) {
            const DisturbedDraw& of = (*made)[static_cast<std::size_t>(draw)];
            const std::vector<recon::Solid> solids = FingerSolids(place, FingerHolder::kFist);
            const std::vector<core::SoftMask> masks =
                of.segmenter.Segment(DisturbedSights(rig, solids, kPaperDisturbance, of.seed), place.number);
            return WidthsIn(recon::MakeVisualHull(of.believed, of.planes, masks), place);
          }};
}

std::vector<FingerWidths> MeasureWidths(const FingerReconstruction& reconstruction,
                                        std::span<const FingerPlace> places) {
  const auto draws = static_cast<std::size_t>(reconstruction.draws);
  std::vector<FingerWidths> widths(places.size() * draws);
  tbb::parallel_for(std::size_t{0}, widths.size(), [&](std::size_t i) {
    widths[i] = reconstruction.widths(places[i / draws], static_cast<int>(i % draws));
  });
  return widths;
}

WidthSummary Summarise(std::span<const std::optional<double>> widths_mm, double tolerance_mm) {
  WidthSummary summary{.measured = static_cast<int>(widths_mm.size())};
  std::vector<double> found_mm;
  int within = 0;
  for (const std::optional<double>& width_mm : widths_mm) {
    if (!width_mm) continue;
    found_mm.push_back(*width_mm);
    within += std::abs(*width_mm - kFingerMm) <= tolerance_mm ? 1 : 0;
  }
  summary.lost = summary.measured - static_cast<int>(found_mm.size());
  if (found_mm.empty()) return summary;
  summary.median_mm = Quantile(found_mm, 0.5);
  summary.low_mm = Quantile(found_mm, 0.05);
  summary.high_mm = Quantile(found_mm, 0.95);
  summary.worst_mm =
      *std::ranges::max_element(found_mm, {}, [](double width_mm) { return std::abs(width_mm - kFingerMm); });
  summary.within_share = static_cast<double>(within) / summary.measured;
  return summary;
}

}  // namespace elbowroom::accuracy
