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

int DistortionCount(DistortionModel model) {
  switch (model) {
    case DistortionModel::kPlumbBob:
      return 5;
    case DistortionModel::kRationalPolynomial:
      return 8;
    case DistortionModel::kFisheye:
      return 4;
  }
  return 0;
}

LensParameters PlainLens(const CalibrationCamera& camera, DistortionModel model, double focal_px) {
  LensParameters lens;
  lens.model = model;
  lens.values = Eigen::VectorXd::Zero(4 + DistortionCount(model));
  lens.values.head<4>() << focal_px, focal_px, 0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1);
  return lens;
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
  lens.model = DistortionModel::kRationalPolynomial;
  const Eigen::VectorXd polynomial = lens.values;
  lens.values = Eigen::VectorXd::Zero(4 + DistortionCount(lens.model));
  lens.values.head(polynomial.size()) = polynomial;
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
  std::vector<double> held_out;  // squared residuals of each view, with a lens that doesn't know it
};

// Squared residuals over variances of each used view, whose pose is found with the lens of the other folds.
std::vector<double> HeldOutErrors(const Adjustment& all, int folds, const std::stop_token& stop) {
  std::vector<double> errors(all.views.size(), 0.0);
  BundleOptions options;
  options.noise_scale = RobustNoiseScale(all);
  options.most_steps = 8;
  options.settled = 1e-5;
  for (int fold = 0; fold < folds; ++fold) {
    Adjustment others = all;
    int number = 0;
    std::vector<std::size_t> left_out;
    for (std::size_t i = 0; i < all.views.size(); ++i) {
      if (!all.views[i].is_used || number++ % folds != fold) continue;
      others.views[i].is_used = false;
      left_out.push_back(i);
    }
    others = AdjustBundle(std::move(others), options, stop);
    for (const std::size_t i : left_out) {
      const PosedView posed = PosedViewOf(others, others.views[i]);
      errors[i] = 2.0 * FitBoardPose({&posed, 1}, all.boards[i].rig_from_board, 0.0).cost;
    }
  }
  return errors;
}

// How much larger the errors of one model on views left out are than those of another.
struct ModelExcess {
  double share = 0.0;            // of the RMS
  double standard_errors = 0.0;  // of the difference between the models, view by view
};

ModelExcess ExcessOf(const std::vector<double>& errors, const std::vector<double>& others) {
  double sum = 0.0, other_sum = 0.0, squares = 0.0;
  const auto count = static_cast<double>(errors.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sum += errors[i];
    other_sum += others[i];
  }
  const double mean = (sum - other_sum) / count;
  for (std::size_t i = 0; i < errors.size(); ++i) squares += std::pow(errors[i] - others[i] - mean, 2);
  const double standard_error = std::sqrt(squares / (count * std::max(1.0, count - 1.0)));
  return {std::sqrt(sum / std::max(other_sum, 1e-300)) - 1.0, mean / std::max(standard_error, 1e-300)};
}

// Whether a simpler model must give way to another. By 2 % always. By less, if the difference is beyond two
// standard errors: an error of the model of a fifth of the noise is 2 %, and can be many standard deviations
// of the parameters. To a fisheye by a thousandth at least: it has no tangential terms, and would put small
// ones of a lens that has them into the principal point.
bool MustGiveWay(const std::vector<double>& errors, const Candidate& other) {
  constexpr double kShare = 0.02, kShareToFisheye = 0.001, kStandardErrors = 2.0;
  const ModelExcess excess = ExcessOf(errors, other.held_out);
  if (excess.share > kShare) return true;
  const double least = other.model == DistortionModel::kFisheye ? kShareToFisheye : 0.0;
  return excess.share > least && excess.standard_errors > kStandardErrors;
}

// Of the candidates whose noise is about the least, the one that most points agree with. A model that doesn't
// fit far from the middle calls the points there wrong, and fits the others as well.
const Candidate& FinestOf(const std::vector<Candidate>& candidates) {
  constexpr double kAboutTheLeast = 1.05;
  const double least = std::ranges::min_element(candidates, {}, &Candidate::noise)->noise;
  const auto points_of = [&](const Candidate& candidate) {
    std::ptrdiff_t points = 0;
    for (const AdjustedView& view : candidate.fit.views)
      if (view.is_used) points += std::ranges::count_if(view.points, &AdjustedPoint::is_used);
    return candidate.noise <= kAboutTheLeast * least ? points : 0;
  };
  return *std::ranges::max_element(candidates, {}, points_of);
}

// All candidates are judged by the views and points that agree with the finest.
const Candidate& ChooseModel(std::vector<Candidate>* candidates, const std::stop_token& stop) {
  constexpr int kFolds = 5;
  const Candidate& finest = FinestOf(*candidates);
  const int folds = std::min(kFolds, UsedViews(finest.fit));
  for (Candidate& candidate : *candidates) {
    for (std::size_t i = 0; i < finest.fit.views.size(); ++i) {
      const AdjustedView& shared = finest.fit.views[i];
      if (shared.is_used && !candidate.fit.views[i].is_used && candidate.model != finest.model)
        candidate.fit.boards[i] = finest.fit.boards[i];  // it had no pose of use
      candidate.fit.views[i] = shared;
    }
    BundleOptions options;
    options.noise_scale = RobustNoiseScale(candidate.fit);
    options.settled = 1e-5;
    candidate.fit = AdjustBundle(std::move(candidate.fit), options, stop);
    candidate.held_out = HeldOutErrors(candidate.fit, folds, stop);
  }
  const Candidate* chosen = &candidates->front();
  for (const Candidate& candidate : *candidates)
    if (MustGiveWay(chosen->held_out, candidate)) chosen = &candidate;
  return *chosen;
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

LensFit FitOf(const Candidate& candidate, bool is_chosen) {
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
          UsedViews(candidate.fit), is_chosen};
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
    Candidate candidate{model, FitSingle(std::move(start), stop), 0.0, {}};
    candidate.noise = RobustNoiseScale(candidate.fit);
    most_views = std::max(most_views, UsedViews(candidate.fit));
    if (UsedViews(candidate.fit) >= kLeastLensViews) candidates.push_back(std::move(candidate));
  }
  if (candidates.empty()) FailForViews(camera, most_views);
  if (candidates.size() == 1) return FitOf(candidates.front(), false);
  return FitOf(ChooseModel(&candidates, stop), true);
}

}  // namespace elbowroom::recon
