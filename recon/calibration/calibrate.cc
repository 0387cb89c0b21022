#include "recon/calibration/calibrate.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "recon/calibration/board_certainty.h"
#include "recon/calibration/held_out.h"
#include "recon/calibration/lens_fit.h"
#include "recon/calibration/rig_covariance.h"
#include "recon/calibration/rig_fit.h"
#include "recon/calibration/rig_start.h"
#include "recon/calibration/uncertainty_scale.h"

namespace elbowroom::recon {
namespace {

// In hundredths of the usual time.
enum class Stage { kLenses = 0, kJoining = 35, kAdjusting = 45, kHeldOut = 80, kDone = 100 };

void Report(const core::Progress& progress, Stage stage, const std::string& what) {
  progress.Report(static_cast<std::int64_t>(stage), static_cast<std::int64_t>(Stage::kDone), what);
}

// Known ones as they are, the others from each camera's own views.
std::vector<LensParameters> FindLenses(const CalibrationInput& input, const BoardSurface& surface,
                                       const std::stop_token& stop) {
  std::vector<LensParameters> lenses(input.cameras.size());
  std::vector<std::exception_ptr> failures(lenses.size());
  tbb::parallel_for(std::size_t{0}, lenses.size(), [&](std::size_t i) {
    const CalibrationCamera& camera = input.cameras[i];
    try {
      if (camera.known) {
        lenses[i] = LensParametersOf(*camera.known);
        return;
      }
      std::vector<const CalibrationView*> views;  // those for the lens alone first
      for (const bool is_for_lens : {true, false})
        for (const CalibrationView& view : input.views)
          if (view.camera == static_cast<int>(i) && view.set.has_value() != is_for_lens)
            views.push_back(&view);
      lenses[i] = FitLens(camera, surface, views, stop).lens;
    } catch (...) {
      failures[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return lenses;
}

double Rms(double sum, int count) { return count > 0 ? std::sqrt(sum / count) : 0.0; }

// Residuals of all views by the poses that the fit gave them.
struct ResidualSums {
  std::vector<double> camera_sums;
  std::vector<int> camera_points;
  double sum = 0.0;
  double sigma_sum_px = 0.0;
};

ViewOutcome OutcomeOf(const RigFit& fit, const RigView& view) {
  ViewOutcome outcome;
  outcome.is_used = view.is_used;
  outcome.reason = view.reason;
  outcome.is_half_turned = view.is_half_turned;
  if (!view.has_pose) return outcome;
  AdjustedView at;
  at.camera = view.camera;
  double sum = 0.0;
  int points = 0;
  for (const AdjustedPoint& point : view.points) {
    const auto residual = ResidualOf(fit.adjustment, at, view.cam_from_board, point);
    if (!residual) continue;
    const int as_seen = view.is_half_turned
                            ? fit.state.surface->half_turn()[static_cast<std::size_t>(point.point)]
                            : point.point;
    const bool is_used = view.is_used && point.is_used;
    outcome.residuals.push_back({as_seen, point.pixel, *residual, is_used});
    if (view.is_used && !is_used) continue;
    sum += residual->squaredNorm();
    ++points;
  }
  outcome.rms_px = Rms(sum, points);
  return outcome;
}

void PutViews(const RigFit& fit, CalibrationResult* result) {
  ResidualSums sums;
  sums.camera_sums.assign(fit.state.cameras.size(), 0.0);
  sums.camera_points.assign(fit.state.cameras.size(), 0);
  for (const RigView& view : fit.state.views) {
    const auto camera = static_cast<std::size_t>(view.camera);
    ViewOutcome outcome = OutcomeOf(fit, view);
    ++(view.is_used ? result->cameras[camera].views_used : result->cameras[camera].views_rejected);
    int used = 0;
    for (const PointResidual& point : outcome.residuals) {
      if (!point.is_used) continue;
      sums.camera_sums[camera] += point.residual_px.squaredNorm();
      ++used;
    }
    for (const AdjustedPoint& point : view.points)
      if (view.is_used && point.is_used) sums.sigma_sum_px += 1.0 / point.inverse_sigma;
    sums.camera_points[camera] += used;
    result->points += used;
    result->rejected_points += static_cast<int>(view.points.size()) - used;
    result->views.push_back(std::move(outcome));
  }
  for (std::size_t i = 0; i < sums.camera_sums.size(); ++i) {
    result->cameras[i].rms_px = Rms(sums.camera_sums[i], sums.camera_points[i]);
    sums.sum += sums.camera_sums[i];
  }
  result->rms_px = Rms(sums.sum, result->points);
  if (result->points > 0) result->noise_px = fit.noise_scale * sums.sigma_sum_px / result->points;
}

void PutCameras(const RigFit& fit, const Eigen::MatrixXd& covariance, CalibrationResult* result) {
  for (int i = 0; i < static_cast<int>(fit.state.cameras.size()); ++i) {
    const AdjustedCamera& adjusted = fit.state.cameras[static_cast<std::size_t>(i)];
    const CalibrationCamera& given = fit.state.input->cameras[static_cast<std::size_t>(i)];
    CalibratedCamera camera;
    camera.parameters = fit.adjustment.BlockOf(i);
    if (given.known) camera.calibration = *given.known;
    camera.calibration.name = given.name;
    camera.calibration.image_width_px = given.width_px;
    camera.calibration.image_height_px = given.height_px;
    if (!given.known) PutLens(adjusted.lens, &camera.calibration);
    camera.calibration.cam_from_world = adjusted.cam_from_rig;
    camera.time_offset_s = adjusted.time_offset_s;
    const int at = camera.parameters.time_offset();
    if (!adjusted.is_offset_fixed) camera.time_offset_sigma_s = std::sqrt(covariance(at, at));
    result->cameras.push_back(std::move(camera));
  }
}

void PutFlatness(const RigFit& fit, const Eigen::MatrixXd& covariance, CalibrationResult* result) {
  BoardFlatness& flatness = result->flatness;
  flatness.is_found = !fit.state.is_flatness_fixed;
  const auto first = covariance.rows() - kFlatnessTerms;
  for (int i = 0; i < kFlatnessTerms; ++i) {
    flatness.terms_mm[static_cast<std::size_t>(i)] = fit.state.flatness_mm[i];
    flatness.sigma_mm[static_cast<std::size_t>(i)] = std::sqrt(covariance(first + i, first + i));
  }
  for (int i = 0; i < fit.state.surface->points(); ++i)
    flatness.largest_mm =
        std::max(flatness.largest_mm, std::abs(fit.state.surface->Bending(i).dot(fit.state.flatness_mm)));
}

// Those whose turn would be known without any one view of their sets.
void PutBoards(const RigFit& fit, CalibrationResult* result) {
  constexpr double kMostTurnSigma = 0.01;
  const RigState& state = fit.state;
  const std::vector<double> sigmas = ConfirmedTurnSigmas(fit.adjustment, fit.noise_scale);
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    const RigSet& set = state.sets[k];
    int shared = 0;
    for (const int v : set.views) {
      const RigView& view = state.views[static_cast<std::size_t>(v)];
      shared += view.is_used && view.shares_board ? 1 : 0;
    }
    const bool is_world = static_cast<int>(k) == state.world_set;
    if (set.adjusted < 0 || shared < (is_world ? 1 : 2)) continue;
    if (!is_world && !(sigmas[static_cast<std::size_t>(set.adjusted)] <= kMostTurnSigma)) continue;
    result->boards.push_back({set.number, set.time_s, set.rig_from_board, shared});
  }
}

void PutHeldOut(const HeldOutFigures& held_out, CalibrationResult* result) {
  result->held_out_rms_px = held_out.rms_px;
  result->cross_camera_rms_px = held_out.cross_camera_rms_px;
  result->rigidity_rms_mm = held_out.rigidity_rms_mm;
}

void PutUncertaintyScale(double scale, CalibrationResult* result) {
  result->uncertainty_scale = scale;
  if (scale > 1.0)
    result->warnings.push_back(fmt::format(
        "the points of a picture are off together, not each by itself, so all uncertainties are "
        "enlarged by {:.1f}; a rolling shutter, a jerk of the board, a board that isn't flat or a "
        "lens unlike its model does that: hold the board still, or move it slowly",
        scale));
}

void PutWarnings(CalibrationResult* result) {
  constexpr int kGoodViews = 10;
  constexpr double kLargeRmsPx = 1.5;
  for (const CalibratedCamera& camera : result->cameras) {
    const std::string& name = camera.calibration.name;
    if (camera.views_used < kGoodViews)
      result->warnings.push_back(
          fmt::format("camera '{}': only {} of its views are used; {} or more make its lens and "
                      "pose reliable",
                      name, camera.views_used, kGoodViews));
    if (camera.views_rejected > camera.views_used)
      result->warnings.push_back(
          fmt::format("camera '{}': more of its views are left out ({}) than used ({})", name,
                      camera.views_rejected, camera.views_used));
    if (camera.rms_px > kLargeRmsPx)
      result->warnings.push_back(
          fmt::format("camera '{}': its points are {:.1f} px off (RMS); a sharp, still board is "
                      "within half a pixel",
                      name, camera.rms_px));
    try {
      (void)core::CameraModel(camera.calibration);
    } catch (const core::Error& error) {
      result->warnings.push_back(error.what());
    }
  }
}

}  // namespace

CalibrationResult Calibrate(const CalibrationInput& input, const core::Progress& progress,
                            const std::stop_token& stop) {
  input.Validate();
  const BoardSurface surface(input.board);
  Report(progress, Stage::kLenses, "lenses");
  RigState start = StateOf(input, surface, FindLenses(input, surface, stop));
  core::ThrowIfStopped(stop, "calibration");
  Report(progress, Stage::kJoining, "joining the cameras");
  StartRig(stop, &start);
  Report(progress, Stage::kAdjusting, "bundle adjustment");
  const RigFit fit = FitRig(std::move(start), stop);
  Eigen::MatrixXd covariance = CovarianceOf(fit.adjustment, fit.noise_scale, input);
  Report(progress, Stage::kHeldOut, "views kept out");

  CalibrationResult result;
  result.noise_scale = fit.noise_scale;
  result.warnings = fit.state.warnings;
  result.warnings.insert(result.warnings.end(), fit.warnings.begin(), fit.warnings.end());
  PutHeldOut(MeasureHeldOut(fit, stop), &result);
  PutUncertaintyScale(UncertaintyScale(fit, stop), &result);
  covariance *= result.uncertainty_scale * result.uncertainty_scale;
  PutCameras(fit, covariance, &result);
  const auto parameters = covariance.rows() - kFlatnessTerms;
  result.covariance = covariance.topLeftCorner(parameters, parameters);
  PutViews(fit, &result);
  PutFlatness(fit, covariance, &result);
  PutBoards(fit, &result);
  PutWarnings(&result);
  Report(progress, Stage::kDone, "done");
  return result;
}

}  // namespace elbowroom::recon
