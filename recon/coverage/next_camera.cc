#include "recon/coverage/next_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "recon/coverage/added_camera.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

struct Place {
  Vector3d center_mm;
  Vector3d look_at_mm;
  double gain = 0.0;
};

// Every so manyth point, about `most` of them.
std::vector<Vector3d> Thinned(const std::vector<Vector3d>& points, std::size_t most) {
  if (points.size() <= most) return points;
  std::vector<Vector3d> some;
  // A step that shares no factor with the grid's rows keeps the points from lying in planes.
  const double step = static_cast<double>(points.size()) / static_cast<double>(most);
  for (std::size_t i = 0; i < most; ++i)
    some.push_back(points[static_cast<std::size_t>((static_cast<double>(i) + 0.5) * step)]);
  return some;
}

// Both lists, thinned, and what the rig gives there today.
struct Sample {
  std::vector<Vector3d> points_mm;
  std::vector<Vector3d> near_mm;
  std::vector<CoverageNode> before;
  std::vector<CoverageNode> near_before;
};

Sample SampleOf(const RigCoverage& coverage, const ServedSpace& space, std::size_t most,
                const std::stop_token& stop) {
  Sample sample{Thinned(space.points_mm, most), Thinned(space.near_points_mm, most), {}, {}};
  sample.before = coverage.At(sample.points_mm, {}, stop);
  sample.near_before = coverage.At(sample.near_mm, {}, stop);
  return sample;
}

struct Trial {
  std::vector<CoverageNode> after;
  std::vector<CoverageNode> near_after;
  double gain = 0.0;
};

Trial Try(const CalibratedRig& rig, const CoverageOptions& options, std::size_t lens_of, const Place& place,
          const Sample& sample, const std::stop_token& stop) {
  const RigCoverage coverage(
      WithCamera(rig, lens_of, core::CamFromWorldLookingAt(place.center_mm, place.look_at_mm)), options);
  Trial trial{coverage.At(sample.points_mm, {}, stop), coverage.At(sample.near_mm, {}, stop)};
  trial.gain = GainOf(sample.before, trial.after);
  if (!sample.near_mm.empty()) trial.gain = 0.5 * (trial.gain + GainOf(sample.near_before, trial.near_after));
  return trial;
}

std::size_t SeesMost(const core::Rig& rig, const std::vector<Vector3d>& points_mm) {
  std::vector<std::ptrdiff_t> seen;
  for (const core::CameraModel& camera : rig.cameras)
    seen.push_back(
        std::ranges::count_if(points_mm, [&](const Vector3d& x) { return IsInPicture(camera, x); }));
  return static_cast<std::size_t>(std::ranges::max_element(seen) - seen.begin());
}

// The cameras' distances from the middle: the least, the median and the largest; those within a tenth of
// another are left out.
std::vector<double> ShellsOf(const core::Rig& rig, const Vector3d& middle_mm) {
  std::vector<double> all_mm, shells_mm;
  for (const core::CameraModel& camera : rig.cameras)
    all_mm.push_back((camera.center_in_world() - middle_mm).norm());
  std::ranges::sort(all_mm);
  for (const double mm : {all_mm[all_mm.size() / 2], all_mm.front(), all_mm.back()}) {
    const bool is_new = std::ranges::all_of(
        shells_mm, [&](double other_mm) { return std::abs(mm - other_mm) > 0.1 * other_mm; });
    if (is_new && mm > 0.0) shells_mm.push_back(mm);
  }
  return shells_mm;
}

// The middle of the tenth of the points that are the worst off; nothing where it is the middle anyway.
Vector3d WorstRegion(const Sample& sample) {
  const bool near = !sample.near_mm.empty();
  const std::vector<Vector3d>& points = near ? sample.near_mm : sample.points_mm;
  const std::vector<CoverageNode>& nodes = near ? sample.near_before : sample.before;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto badness = [&](std::size_t i) {
    return std::pair(
        nodes[i].has_sigma ? static_cast<double>(nodes[i].sigma_mm) : std::numeric_limits<double>::infinity(),
        -static_cast<int>(nodes[i].cameras));
  };
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return badness(a) > badness(b); });
  const std::size_t count = std::max<std::size_t>(points.size() / 10, 1);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) sum += points[order[i]];
  return sum / static_cast<double>(count);
}

// Directions spread evenly over a sphere (a Fibonacci spiral).
std::vector<Vector3d> Directions(int count) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / count, across = std::sqrt(1.0 - z * z);
    const double turn = 2.0 * std::numbers::pi * i / std::numbers::phi;
    directions.emplace_back(across * std::cos(turn), across * std::sin(turn), z);
  }
  return directions;
}

std::vector<Place> PlacesFor(const core::Rig& rig, const ServedSpace& space, const Vector3d& worst_mm,
                             const NextCameraOptions& search) {
  double floor_mm = rig.workspace_mm.min().z();
  bool may_be_inside = false;
  for (const core::CameraModel& camera : rig.cameras) {
    floor_mm = std::min(floor_mm, camera.center_in_world().z());
    may_be_inside = may_be_inside || rig.workspace_mm.contains(camera.center_in_world());
  }
  const double apart_mm = 0.1 * rig.workspace_mm.diagonal().norm();  // targets nearer than that are one
  std::vector<Place> places;
  for (const double shell_mm : ShellsOf(rig, space.middle_mm)) {
    for (const Vector3d& direction : Directions(search.directions)) {
      const Vector3d center_mm = space.middle_mm + shell_mm * direction;
      if (center_mm.z() < floor_mm || center_mm.z() > search.ceiling_mm) continue;
      if (!may_be_inside && rig.workspace_mm.contains(center_mm)) continue;
      places.push_back({center_mm, space.middle_mm});
      if ((worst_mm - space.middle_mm).norm() > apart_mm && (worst_mm - center_mm).norm() > apart_mm)
        places.push_back({center_mm, worst_mm});
    }
  }
  return places;
}

// The best places by falling gain, none of which stands beside a better one, as seen from the middle.
std::vector<Place> BestApart(std::vector<Place> places, const Vector3d& middle_mm, int most) {
  constexpr double kCosApart = 0.9;  // 26 degrees
  std::ranges::stable_sort(places, [](const Place& a, const Place& b) { return a.gain > b.gain; });
  std::vector<Place> best;
  for (const Place& place : places) {
    const Vector3d way = (place.center_mm - middle_mm).normalized();
    const bool is_apart = std::ranges::all_of(best, [&](const Place& other) {
      return way.dot((other.center_mm - middle_mm).normalized()) < kCosApart;
    });
    if (is_apart && place.gain > 0.0) best.push_back(place);
    if (static_cast<int>(best.size()) == most) break;
  }
  return best;
}

double SigmaForUnseen(std::span<const CoverageNode> before) {
  const CoverageFigures figures = FiguresOf(before);
  return figures.uncertainty_mm ? 3.0 * figures.uncertainty_mm->p95 : 1.0;
}

}  // namespace

double GainOf(std::span<const CoverageNode> before, std::span<const CoverageNode> after) {
  core::Require(before.size() == after.size(), "a gain is of the same nodes");
  if (before.empty()) return 0.0;
  constexpr double kLeastPhantom = 0.02;
  const double unseen_mm = SigmaForUnseen(before);
  const auto cost = [&](const CoverageNode& node) {
    const double sigma_mm = node.has_sigma ? std::min<double>(node.sigma_mm, unseen_mm) : unseen_mm;
    const double phantom = node.has_phantom ? std::max<double>(node.phantom, kLeastPhantom) : 1.0;
    return std::log(std::max(sigma_mm, 1e-9)) + std::log(phantom);
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) sum += cost(before[i]) - cost(after[i]);
  return sum / static_cast<double>(before.size());
}

NextCamera FindNextCamera(const CalibratedRig& rig, const CoverageOptions& options, const ServedSpace& space,
                          const NextCameraOptions& search, const core::Progress& progress,
                          const std::stop_token& stop) {
  core::Require(!space.points_mm.empty(), "a new camera serves a space");
  NextCamera next;
  const RigCoverage today(rig, options);
  const Sample few = SampleOf(today, space, search.tried_points, stop);
  next.lens_of = SeesMost(rig.rig, Thinned(space.points_mm, search.final_points));
  std::vector<Place> places = PlacesFor(rig.rig, space, WorstRegion(few), search);
  next.tried = places.size();
  for (std::size_t i = 0; i < places.size(); ++i) {
    core::ThrowIfStopped(stop, "next camera");
    progress.Report(static_cast<std::int64_t>(i), static_cast<std::int64_t>(places.size()), "next camera");
    places[i].gain = Try(rig, options, next.lens_of, places[i], few, stop).gain;
  }
  const Sample many = SampleOf(today, space, search.final_points, stop);
  next.points = many.points_mm.size();
  next.before = FiguresOf(many.before);
  if (!many.near_mm.empty()) next.near_before = FiguresOf(many.near_before);
  for (const Place& place : BestApart(std::move(places), space.middle_mm, search.proposals)) {
    const Trial trial = Try(rig, options, next.lens_of, place, many, stop);
    if (!(trial.gain > 0.0)) continue;
    ProposedCamera& proposed = next.best.emplace_back();
    proposed.cam_from_world = core::CamFromWorldLookingAt(place.center_mm, place.look_at_mm);
    proposed.center_mm = place.center_mm;
    proposed.look_at_mm = place.look_at_mm;
    proposed.after = FiguresOf(trial.after);
    if (!many.near_mm.empty()) proposed.near_after = FiguresOf(trial.near_after);
    proposed.gain = trial.gain;
  }
  std::ranges::stable_sort(next.best, [](const auto& a, const auto& b) { return a.gain > b.gain; });
  progress.Report(static_cast<std::int64_t>(next.tried), static_cast<std::int64_t>(next.tried),
                  "next camera");
  return next;
}

}  // namespace elbowroom::recon
