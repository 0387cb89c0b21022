#include "recon/calibration/lens_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"
#include "core/progress.h"
#include "recon/calibration/bundle.h"
#include "recon/calibration/outliers.h"
#include "recon/calibration/planar_pose.h"

namespace elbowroom::recon {
namespace {

using core::DistortionModel;
using Eigen::Vector2d;

constexpr int kMostLensViews = 40;  // more add time and little accuracy; the joint fit uses all
constexpr int kMostStartViews = 15;
constexpr std::size_t kLeastPoints = 6;

LensParameters PlainLens(const CalibrationCamera& camera, DistortionModel model, double focal_px) {
  LensParameters lens;
  lens.values =
      Eigen::Vector4d(focal_px, focal_px, 0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1));
  return WithModel(lens, model);
}

std::vector<PlanarPose> PosesOfView(const LensParameters& lens, const BoardSurface& surface,
                                    std::span<const AdjustedPoint> points, int most_steps = kPoseSteps) {
  std::vector<PosePoint> posed;
  std::vector<Vector2d> normalised;
  for (const AdjustedPoint& point : points) {
    const std::optional<Vector2d> at = NormalisedPoint(lens, point.pixel);
    if (!at) continue;
    normalised.push_back(*at);
    posed.push_back({surface.Flat(point.point), point.pixel, point.inverse_sigma});
  }
  return PlanarPosesOf(lens, posed, normalised, most_steps);
}

// `most` of the values at even steps.
template <class T>
std::vector<T> Spread(const std::vector<T>& all, int most) {
  const int count = static_cast<int>(all.size());
  if (count <= most) return all;
  std::vector<T> some;
  for (int i = 0; i < most; ++i) some.push_back(all[static_cast<std::size_t>(i * count / most)]);
  return some;
}

// The focal length, of a row of them, whose lens without distortion fits the middle view best.
LensParameters StartLens(const CalibrationCamera& camera, const BoardSurface& surface, DistortionModel model,
                         const std::vector<std::vector<AdjustedPoint>>& views) {
  constexpr int kFocalLengths = 13, kPoseStepsAtStart = 6;
  constexpr double kShortest = 0.3, kStep = 1.25;  // of the longer side; the longest is 4.4
  const double side_px = std::max(camera.width_px, camera.height_px);
  LensParameters best;
  double least_px = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kFocalLengths; ++i) {
    const LensParameters lens = PlainLens(camera, model, kShortest * std::pow(kStep, i) * side_px);
    std::vector<double> errors;
    for (const auto& points : Spread(views, kMostStartViews)) {
      const std::vector<PlanarPose> poses = PosesOfView(lens, surface, points, kPoseStepsAtStart);
      errors.push_back(poses.empty() ? std::numeric_limits<double>::max() : poses.front().error.rms_px);
    }
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    if (*middle < least_px) {
      least_px = *middle;
      best = lens;
    }
  }
  return best;
}

// One camera, which is the rig, and a board for each view.
Adjustment SingleCamera(const BoardSurface& surface, const LensParameters& lens,
                        const std::vector<std::vector<AdjustedPoint>>& views) {
  Adjustment a;
  a.surface = &surface;
  AdjustedCamera camera;
  camera.lens = lens;
  camera.is_pose_fixed = true;
  a.cameras = {camera};
  for (const auto& points : views) {
    const std::vector<PlanarPose> poses = PosesOfView(lens, surface, points);
    AdjustedView view;
    view.boards[0] = static_cast<int>(a.boards.size());
    view.points = points;
    view.is_used = !poses.empty();
    AdjustedBoard board;
    if (view.is_used) board.rig_from_board = poses.front().cam_from_board;
    a.boards.push_back(board);
    a.views.push_back(std::move(view));
  }
  return a;
}

// A fit of plumb_bob as the start of a rational lens: its polynomial over 1. All points have another chance.
Adjustment WithDenominator(Adjustment a) {
  LensParameters& lens = a.cameras.front().lens;
  lens = WithModel(lens, DistortionModel::kRationalPolynomial);
  for (AdjustedView& view : a.views) {
    view.is_used =
        !a.boards[static_cast<std::size_t>(view.boards[0])].rig_from_board.translation_mm.isZero(0.0);
    for (AdjustedPoint& point : view.points) point.is_used = true;
  }
  return a;
}

PosedView PosedViewOf(const Adjustment& a, const AdjustedView& view) {
  PosedView posed;
  posed.lens = &a.cameras[static_cast<std::size_t>(view.camera)].lens;
  for (const AdjustedPoint& point : view.points)
    if (point.is_used)
      posed.points.push_back({a.surface->Flat(point.point), point.pixel, point.inverse_sigma});
  return posed;
}

// Each view takes the other of its two poses where that fits better.
void TakeBetterPoses(double cauchy_scale, Adjustment* a) {
  for (const AdjustedView& view : a->views) {
    if (!view.is_used) continue;
    const PosedView posed = PosedViewOf(*a, view);
    AdjustedBoard& board = a->boards[static_cast<std::size_t>(view.boards[0])];
    const PoseFit kept = FitBoardPose({&posed, 1}, board.rig_from_board, cauchy_scale);
    const PoseFit other =
        FitBoardPose({&posed, 1}, Flipped(kept.rig_from_board, a->surface->center()), cauchy_scale);
    board.rig_from_board = (other.cost < kept.cost ? other : kept).rig_from_board;
  }
}

// Robust fits whose scale shrinks with the residuals, then plain ones without what doesn't agree.
Adjustment FitSingle(Adjustment a, const std::stop_token& stop) {
  constexpr double kCauchyScale = 2.0;
  constexpr int kRobustRounds = 3, kPlainRounds = 2;
  BundleOptions options;
  options.settled = 1e-5;
  for (int round = 0; round < kRobustRounds; ++round) {
    options.cauchy_scale = kCauchyScale;
    options.noise_scale = RobustNoiseScale(a);
    options.most_steps = 15;
    a = AdjustBundle(std::move(a), options, stop);
    TakeBetterPoses(kCauchyScale * options.noise_scale, &a);
  }
  for (int round = 0; round < kPlainRounds; ++round) {
    options.noise_scale = RobustNoiseScale(a);
    LeaveOutliers(options.noise_scale, &a);
    options.cauchy_scale = 0.0;
    a = AdjustBundle(std::move(a), options, stop);
  }
  return a;
}

int UsedViews(const Adjustment& a) {
  return static_cast<int>(std::ranges::count_if(a.views, &AdjustedView::is_used));
}

struct Candidate {
  DistortionModel model;
  Adjustment fit;
  double noise = 0.0;
  std::ptrdiff_t points = 0;  // that agree with it
};

// The simplest whose noise is about the least and with which about the most points agree. A model that
// doesn't fit far from the middle calls the points there wrong, and fits the others as well.
const Candidate& RoughChoice(const std::vector<Candidate>& candidates) {
  constexpr double kAboutTheLeast = 1.05, kAboutTheMost = 0.98;
  const double least = std::ranges::min_element(candidates, {}, &Candidate::noise)->noise;
  const auto points_of = [&](const Candidate& candidate) {
    return candidate.noise <= kAboutTheLeast * least ? candidate.points : 0;
  };
  const auto most = static_cast<double>(points_of(*std::ranges::max_element(candidates, {}, points_of)));
  return *std::ranges::find_if(candidates, [&](const Candidate& candidate) {
    return static_cast<double>(points_of(candidate)) >= kAboutTheMost * most;
  });
}

[[noreturn]] void FailForViews(const CalibrationCamera& camera, int usable) {
  throw core::Error(
      core::ErrorKind::kCamera,
      fmt::format(
          "camera '{}': {} of its views show{} the board well enough to find its lens, and {} are needed; "
          "next, take a picture with this camera of the whole board, tilted by 30 degrees, that fills "
          "another part of the picture",
          camera.name, usable, usable == 1 ? "s" : "", kLeastLensViews));
}

LensFit FitOf(const Candidate& candidate) {
  double sum = 0.0;
  int points = 0;
  for (const AdjustedView& view : candidate.fit.views) {
    if (!view.is_used) continue;
    const core::RigidTransform cam_from_board = CamFromBoardAt(candidate.fit, view);
    for (const AdjustedPoint& point : view.points) {
      const auto residual =
          point.is_used ? ResidualOf(candidate.fit, view, cam_from_board, point) : std::nullopt;
      if (!residual) continue;
      sum += residual->squaredNorm();
      ++points;
    }
  }
  return {candidate.fit.cameras.front().lens, points > 0 ? std::sqrt(sum / points) : 0.0,
          UsedViews(candidate.fit)};
}

}  // namespace

std::vector<AdjustedPoint> AdjustedPointsOf(const BoardSighting& sighting) {
  std::vector<AdjustedPoint> points;
  for (const SightedPoint& point : sighting.points)
    points.push_back({point.point, point.pixel, 1.0 / point.sigma_px, true});
  return points;
}

LensFit FitLens(const CalibrationCamera& camera, const BoardSurface& surface,
                std::span<const CalibrationView* const> views, const std::stop_token& stop) {
  std::vector<std::vector<AdjustedPoint>> usable;
  for (const CalibrationView* view : views)
    if (view->sighting.points.size() >= kLeastPoints) usable.push_back(AdjustedPointsOf(view->sighting));
  if (usable.size() < kLeastLensViews) FailForViews(camera, static_cast<int>(usable.size()));
  usable = Spread(usable, kMostLensViews);

  std::vector<DistortionModel> models = {DistortionModel::kPlumbBob, DistortionModel::kRationalPolynomial,
                                         DistortionModel::kFisheye};
  if (camera.distortion_model) models = {*camera.distortion_model};
  std::vector<Candidate> candidates;
  int most_views = 0;
  for (const DistortionModel model : models) {
    core::ThrowIfStopped(stop, "calibration");
    Adjustment start = model == DistortionModel::kRationalPolynomial && !candidates.empty()
                           ? WithDenominator(candidates.front().fit)
                           : SingleCamera(surface, StartLens(camera, surface, model, usable), usable);
    if (UsedViews(start) < kLeastLensViews) continue;
    Candidate candidate{model, FitSingle(std::move(start), stop)};
    candidate.noise = RobustNoiseScale(candidate.fit);
    for (const AdjustedView& view : candidate.fit.views)
      if (view.is_used) candidate.points += std::ranges::count_if(view.points, &AdjustedPoint::is_used);
    most_views = std::max(most_views, UsedViews(candidate.fit));
    if (UsedViews(candidate.fit) >= kLeastLensViews) candidates.push_back(std::move(candidate));
  }
  if (candidates.empty()) FailForViews(camera, most_views);
  return FitOf(RoughChoice(candidates));
}

}  // namespace elbowroom::recon
