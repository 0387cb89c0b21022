#include "app/control/coverage/coverage_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/control/coverage/coverage_advice.h"
#include "app/control/coverage/coverage_text.h"
#include "cad_import/layout/layout_file.h"
#include "core/bvh.h"
#include "core/error.h"
#include "core/part_distance.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

constexpr double kNoisePx = 0.3;              // of a point in a picture, where the rig's file doesn't say it
constexpr double kMostNodesByItself = 2.5e5;  // of the grid that isn't asked for
constexpr double kBallMm = 50.0;              // about a fist's half width, a handle's diameter

double SinceMs(const Clock::time_point& start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void TakeRig(const recon::RigFile& file, CoverageOutcome* outcome) {
  outcome->rig.rig = file.rig;
  outcome->rig.noise_px = kNoisePx;
  if (file.gauge && !file.gauge->passed)
    outcome->warnings.push_back(fmt::format(
        "the gauge of the rig failed ({:.2f} mm off, {:.2f} mm is the bound), so the true errors are "
        "larger than these; calibrate the rig again, and gauge it",
        file.gauge->error_mm, file.gauge->bound_mm));
  outcome->has_covariance = file.calibration && file.calibration->covariance.size() > 0;
  if (file.calibration && file.calibration->noise_px > 0.0)
    outcome->rig.noise_px = file.calibration->noise_px;
  if (outcome->has_covariance) {
    outcome->rig.covariance = file.calibration->covariance;
    return;
  }
  outcome->warnings.push_back(fmt::format(
      "the rig's file says nothing of its calibration's errors: cameras are taken as exact and a point in "
      "a picture as known to {} px, so the true errors are larger; `elbowroom calibrate` writes a file "
      "that says it",
      outcome->rig.noise_px));
}

double GridFor(const CoverageRequest& request, CoverageOutcome* outcome) {
  const Eigen::AlignedBox3d& box = outcome->rig.rig.workspace_mm;
  if (request.grid_mm) {
    const double nodes = ((box.sizes() / *request.grid_mm).array().floor() + 1.0).prod();
    if (nodes <= kMostCoverageNodes) return *request.grid_mm;
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("{}: a grid of {} mm has {:.3g} nodes in its workspace, more than {:.0f}; "
                                  "choose --grid {:.3g} or "
                                  "more",
                                  request.rig_file.string(), *request.grid_mm, nodes, kMostCoverageNodes,
                                  recon::MapEdgeMm(box, *request.grid_mm, kMostCoverageNodes)));
  }
  double grid_mm = recon::MapEdgeMm(box, recon::kMapEdgeMm, kMostNodesByItself);
  constexpr double kFewestCells = 10.0;  // along the longest side
  while (box.sizes().maxCoeff() < kFewestCells * grid_mm) grid_mm *= 0.5;
  if (grid_mm != recon::kMapEdgeMm) {
    outcome->warnings.push_back(
        fmt::format("the grid is {} mm instead of {} mm, because of the workspace's size; --grid "
                    "sets it",
                    MmText(grid_mm), recon::kMapEdgeMm));
  }
  return grid_mm;
}

double BallFor(const CoverageRequest& request, CoverageOutcome* outcome) {
  if (request.ball_mm) return *request.ball_mm;
  const double largest_mm = 0.5 * outcome->rig.rig.workspace_mm.sizes().minCoeff();
  if (largest_mm >= kBallMm) return kBallMm;
  outcome->warnings.push_back(
      fmt::format("the ball for the phantom volume is {} mm instead of {} mm, half of the "
                  "workspace's shortest side; --ball sets it",
                  MmText(largest_mm), kBallMm));
  return largest_mm;
}

// Places within the distance of the part's surface, in the workspace.
std::vector<Vector3d> PointsNear(const core::Part& part, const core::RigidTransform& world_from_part,
                                 const Eigen::AlignedBox3d& workspace_mm, double near_mm, double most_nodes,
                                 double* grid_mm) {
  Eigen::AlignedBox3d box = core::BoundsOf(*part.mesh, world_from_part);
  box = Eigen::AlignedBox3d(box.min() - Vector3d::Constant(near_mm), box.max() + Vector3d::Constant(near_mm))
            .intersection(workspace_mm);
  std::vector<Vector3d> points;
  if (box.isEmpty()) return points;
  *grid_mm = recon::MapEdgeMm(box, std::min(*grid_mm, 0.2 * near_mm), most_nodes);
  const core::TriangleTree tree(part.mesh);
  const core::RigidTransform part_from_world = world_from_part.Inverse();
  std::uint32_t likely = 0;
  for (const Vector3d& x : recon::GridOver(box, *grid_mm).Points()) {
    core::BoxInPart at;
    at.center = part_from_world * x;
    const core::NearestOnPart nearest = core::FindNearest(tree, at, likely);
    likely = nearest.triangle;
    if (nearest.distance_mm <= near_mm) points.push_back(x);
  }
  return points;
}

// Returns the places near all parts.
std::vector<Vector3d> CoverParts(const recon::RigCoverage& coverage, const core::Progress& progress,
                                 const std::stop_token& stop, CoverageOutcome* outcome) {
  constexpr double kMostNearNodes = 2e5, kFewestPartNodes = 500.0;
  std::vector<Vector3d> all;
  const double most_nodes =
      std::max(kMostNearNodes / static_cast<double>(std::max<std::size_t>(outcome->layout.parts.size(), 10)),
               kFewestPartNodes);
  for (std::size_t i = 0; i < outcome->layout.parts.size(); ++i) {
    core::ThrowIfStopped(stop, "coverage near parts");
    progress.Report(static_cast<std::int64_t>(i), static_cast<std::int64_t>(outcome->layout.parts.size()),
                    "coverage near parts");
    const core::Part& part = outcome->layout.parts[i];
    PartCoverage& near = outcome->parts.emplace_back();
    near.name = part.name;
    near.grid_mm = outcome->grid.edge_mm;
    const std::vector<Vector3d> points =
        PointsNear(part, outcome->world_from_parts[i], outcome->rig.rig.workspace_mm, outcome->near_mm,
                   most_nodes, &near.grid_mm);
    near.figures = recon::FiguresOf(coverage.At(points, {}, stop));
    if (points.empty())
      outcome->warnings.push_back(
          fmt::format("the space near part '{}' isn't in the workspace; check workspace_mm", part.name));
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

// What is left of the uncertainty if the calibration had no error, over some of the nodes.
void CompareWithExact(const CoverageOutcome& outcome, const std::vector<Vector3d>& points,
                      std::optional<double>* median_mm) {
  if (!outcome.has_covariance) return;
  constexpr std::size_t kMostPoints = 4000;
  std::vector<Vector3d> some;
  const std::size_t step = points.size() / kMostPoints + 1;
  for (std::size_t i = step / 2; i < points.size(); i += step) some.push_back(points[i]);
  recon::CalibratedRig exact = outcome.rig;
  exact.covariance.resize(0, 0);
  const recon::CoverageFigures figures =
      recon::FiguresOf(recon::RigCoverage(exact, outcome.options).At(some));
  if (figures.uncertainty_mm) *median_mm = figures.uncertainty_mm->median;
}

Vector3d MiddleOf(const CoverageOutcome& outcome, const std::vector<Vector3d>& near_points) {
  if (near_points.empty()) return outcome.rig.rig.workspace_mm.center();
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : near_points) box.extend(x);
  return box.center();
}

}  // namespace

CoverageOutcome CoverRig(const CoverageRequest& request, const core::Progress& progress,
                         const std::stop_token& stop) {
  CoverageOutcome outcome;
  TakeRig(recon::ReadRigFile(request.rig_file), &outcome);
  outcome.near_mm = request.near_mm;
  const double grid_mm = GridFor(request, &outcome);
  outcome.options.ball_mm = BallFor(request, &outcome);
  if (!request.layout.empty()) {
    outcome.layout = cad_import::ImportLayoutFile(request.layout, progress, stop).layout;
    outcome.world_from_parts = core::PosesAt(outcome.layout, outcome.layout.InitialSpacings());
  }
  const auto start = Clock::now();
  outcome.grid = recon::GridOver(outcome.rig.rig.workspace_mm, grid_mm);
  const std::vector<Vector3d> points = outcome.grid.Points();
  const recon::RigCoverage coverage(outcome.rig, outcome.options);
  outcome.nodes = coverage.At(points, progress, stop);
  outcome.figures = recon::FiguresOf(outcome.nodes);
  outcome.map_ms = SinceMs(start);

  const auto after_map = Clock::now();
  const std::vector<Vector3d> near_points = CoverParts(coverage, progress, stop, &outcome);
  CompareWithExact(outcome, points, &outcome.exact_uncertainty_mm);
  if (request.tries_cameras) {
    recon::NextCameraOptions search;
    if (request.ceiling_mm) search.ceiling_mm = *request.ceiling_mm;
    outcome.next =
        recon::FindNextCamera(outcome.rig, outcome.options,
                              {points, near_points, MiddleOf(outcome, near_points)}, search, progress, stop);
  }
  outcome.advice = CoverageAdvice(outcome);
  outcome.advice_ms = SinceMs(after_map);
  return outcome;
}

}  // namespace elbowroom::control
