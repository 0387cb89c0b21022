#include "recon/calibration/rig_fit.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/progress.h"
#include "recon/calibration/flips.h"
#include "recon/calibration/lens_agreement.h"
#include "recon/calibration/lens_choice.h"
#include "recon/calibration/outliers.h"
#include "recon/calibration/rig_covariance.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;

constexpr double kRobustScale = 2.5;  // of the Cauchy loss, in noise scales

const std::string& NameOfCamera(const RigState& state, int camera) {
  return state.input->cameras[static_cast<std::size_t>(camera)].name;
}

double MedianOfValues(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void FitRobustly(bool with_lenses, int rounds, FlipsTried tried, const std::stop_token& stop,
                 RigState* state) {
  BundleOptions options;
  options.cauchy_scale = kRobustScale;
  options.most_steps = 12;
  options.settled = 1e-4;
  for (int round = 0; round < rounds; ++round) {
    Adjustment a = AdjustmentOf(state);
    std::vector<bool> was_fixed;
    for (AdjustedCamera& camera : a.cameras) {
      was_fixed.push_back(camera.is_lens_fixed);
      camera.is_lens_fixed |= !with_lenses;
    }
    options.noise_scale = RobustNoiseScale(a);
    a = AdjustBundle(std::move(a), options, stop);
    for (std::size_t i = 0; i < was_fixed.size(); ++i) a.cameras[i].is_lens_fixed = was_fixed[i];
    ExchangeFlips(tried, options, &a, state);
  }
}

// Views that are far off, measured by their cameras' medians, aren't used. Returns whether there were any.
void LeaveFarViews(double most_medians, bool is_final, RigState* state) {
  const Adjustment a = AdjustmentOf(state);
  const std::vector<double> medians = ViewMedians(a);
  std::vector<std::vector<double>> of_camera(a.cameras.size());
  for (std::size_t i = 0; i < a.views.size(); ++i)
    of_camera[static_cast<std::size_t>(a.views[i].camera)].push_back(medians[i]);
  for (RigView& view : state->views) {
    if (view.adjusted < 0) continue;
    const double usual = MedianOfValues(of_camera[static_cast<std::size_t>(view.camera)]);
    if (medians[static_cast<std::size_t>(view.adjusted)] <= most_medians * usual) continue;
    view.is_used = false;
    view.is_final = is_final;
    view.reason = fmt::format("its points are {:.0f} times as far off as those of the camera's other views",
                              medians[static_cast<std::size_t>(view.adjusted)] / std::max(usual, 1e-9));
  }
}

// Where the views of a set don't agree and one alone is left, nothing says that it isn't the wrong one.
bool LeaveUnconfirmedViews(RigState* state) {
  bool has_changed = false;
  for (const RigSet& set : state->sets) {
    int with_pose = 0;
    for (const int v : set.views) with_pose += state->views[static_cast<std::size_t>(v)].has_pose ? 1 : 0;
    const bool is_world = &set == &state->sets[static_cast<std::size_t>(std::max(0, state->world_set))] &&
                          state->world_set >= 0;
    if (with_pose < 2 || state->UsedViewsOf(set) != 1 || is_world) continue;
    for (const int v : set.views) {
      RigView& view = state->views[static_cast<std::size_t>(v)];
      if (!view.is_used) continue;
      view.is_used = false;
      view.is_final = true;
      view.reason = "no other view of its set agrees with it";
      has_changed = true;
    }
  }
  return has_changed;
}

// A view by itself whose two poses fit alike says little of the lens and may say it wrongly.
void LeaveUndecidedViews(double noise_scale, RigState* state) {
  constexpr double kLeastDifference = 9.0;  // of chi squared
  constexpr int kEnoughViews = 10;
  const Adjustment a = AdjustmentOf(state);
  const std::vector<std::vector<PosedView>> views = ViewsOfBoards(a);
  std::vector<int> used(a.cameras.size(), 0);
  for (const AdjustedView& view : a.views) ++used[static_cast<std::size_t>(view.camera)];
  for (RigView& view : state->views) {
    if (view.adjusted < 0 || view.shares_board || used[static_cast<std::size_t>(view.camera)] <= kEnoughViews)
      continue;
    const auto k = static_cast<std::size_t>(a.views[static_cast<std::size_t>(view.adjusted)].boards[0]);
    const PoseFit kept = FitBoardPose(views[k], a.boards[k].rig_from_board, 0.0);
    const PoseFit other = BestFlip(views[k], kept, a.surface->center(), 0.0);
    if (AreOnePose(other.rig_from_board, kept.rig_from_board) ||
        2.0 * (other.cost - kept.cost) >= kLeastDifference * noise_scale * noise_scale)
      continue;
    view.is_used = false;
    view.is_final = true;
    view.reason = "its two possible poses fit alike, and no other camera sees the board";
    --used[static_cast<std::size_t>(view.camera)];
  }
}

// The largest distance from the axis, in the normalised plane, of what may be in the picture, with room to
// spare. A pose farther off can still land in the picture, as lenses fold or end there in the formula.
double FarthestInPicture(const LensParameters& lens, const CalibrationCamera& camera) {
  constexpr double kRoom = 1.5, kWithoutInverse = 3.0;  // 72 degrees from the axis
  double farthest = 0.0;
  for (const double x : {0.0, camera.width_px - 1.0})
    for (const double y : {0.0, camera.height_px - 1.0}) {
      const auto corner = NormalisedPoint(lens, {x, y});
      farthest = std::max(farthest, corner ? kRoom * corner->norm() : kWithoutInverse);
    }
  return farthest;
}

bool IsBeforeLens(const Adjustment& a, const AdjustedView& view, const RigidTransform& cam_from_board,
                  double farthest) {
  return std::ranges::all_of(view.points, [&](const AdjustedPoint& point) {
    const Eigen::Vector3d x_in_cam = cam_from_board * a.surface->Flat(point.point);
    return !point.is_used || (x_in_cam.z() > 0.0 && x_in_cam.hnormalized().norm() <= farthest);
  });
}

// Poses that fit the formulas and that no camera can see.
void LeaveImpossibleViews(const Adjustment& a, RigState* state) {
  std::vector<double> farthest;
  for (std::size_t i = 0; i < a.cameras.size(); ++i)
    farthest.push_back(FarthestInPicture(a.cameras[i].lens, state->input->cameras[i]));
  for (RigView& view : state->views) {
    if (view.adjusted < 0 || !view.is_used) continue;
    const AdjustedView& adjusted = a.views[static_cast<std::size_t>(view.adjusted)];
    const RigidTransform cam_from_board = CamFromBoardAt(a, adjusted);
    const bool is_from_behind = !ShowsPrintedSide(cam_from_board, a.surface->center());
    if (!is_from_behind &&
        IsBeforeLens(a, adjusted, cam_from_board, farthest[static_cast<std::size_t>(view.camera)]))
      continue;
    view.is_used = false;
    view.is_final = true;
    view.reason = is_from_behind ? "it would see the board from behind"
                                 : "it would see the board far outside of the picture";
  }
}

bool StampsDiffer(const RigState& state) {
  return std::ranges::any_of(state.views, [&](const RigView& view) {
    return view.set >= 0 &&
           std::abs(view.time_s - state.sets[static_cast<std::size_t>(view.set)].time_s) > 1e-6;
  });
}

// Frees what the sets can show beyond poses and lenses.
void FreeOffsetsAndFlatness(RigFit* fit) {
  constexpr double kMostMove = 0.5;  // share of the sets whose motion must be known
  constexpr std::size_t kLeastViewsForFlatness = 8;
  RigState& state = fit->state;
  if (state.input->finds_offsets || StampsDiffer(state)) {
    state.has_motion = ShareOfMovingSets(state) >= kMostMove;
    if (!state.has_motion)
      fit->warnings.push_back(
          "time offsets can't be found: few instants follow each other within 3.5 frame periods; the board "
          "is taken "
          "as still at each. Record a video of the moving board, or hold it still for each picture");
  }
  if (state.has_motion && state.input->finds_offsets)
    for (std::size_t i = 1; i < state.cameras.size(); ++i) state.cameras[i].is_offset_fixed = false;
  const auto used = static_cast<std::size_t>(std::ranges::count_if(state.views, &RigView::is_used));
  state.is_flatness_fixed =
      state.input->has_flat_board || !state.surface->can_bend() || used < kLeastViewsForFlatness;
}

// An offset that isn't known to half a frame period stays 0.
void FixUnknownOffsets(const std::stop_token& stop, RigFit* fit) {
  constexpr double kMostSigma = 0.5;
  RigState& state = fit->state;
  const Adjustment a = AdjustmentOf(&state);
  const Eigen::MatrixXd covariance = CovarianceOf(a, RobustNoiseScale(a), *state.input);
  bool has_changed = false;
  for (int i = 0; i < static_cast<int>(state.cameras.size()); ++i) {
    AdjustedCamera& camera = state.cameras[static_cast<std::size_t>(i)];
    const int at = a.BlockOf(i).time_offset();
    if (camera.is_offset_fixed || std::sqrt(covariance(at, at)) <= kMostSigma * state.input->frame_period_s)
      continue;
    camera.is_offset_fixed = true;
    camera.time_offset_s = 0.0;
    has_changed = true;
    fit->warnings.push_back(
        fmt::format("camera '{}': its time offset can't be found, as the board hardly moves where "
                    "it sees it; move the board faster there",
                    NameOfCamera(state, i)));
  }
  if (has_changed) FitRobustly(true, 1, FlipsTried::kOfMisfits, stop, &state);
}

// Views that were far off while offsets weren't known get another chance.
void AskFarViewsAgain(RigState* state) {
  constexpr double kMostMedians = 4.0;
  for (RigView& view : state->views) {
    if (view.is_used || view.is_final || !view.has_pose) continue;
    view.is_used = true;
    view.reason.clear();
  }
  LeaveFarViews(kMostMedians, true, state);
}

// Returns whether there were any.
bool LeaveContradictingViews(double noise_scale, RigState* state) {
  const Adjustment a = AdjustmentOf(state);
  std::vector<bool> is_alone(a.views.size(), false);
  std::vector<RigView*> views(a.views.size(), nullptr);
  for (RigView& view : state->views) {
    if (view.adjusted < 0) continue;
    is_alone[static_cast<std::size_t>(view.adjusted)] = !view.shares_board;
    views[static_cast<std::size_t>(view.adjusted)] = &view;
  }
  const std::vector<std::size_t> contradicting =
      ContradictingViews(a, is_alone, CovarianceOf(a, noise_scale, *state->input), noise_scale);
  for (const std::size_t i : contradicting) {
    views[i]->is_used = false;
    views[i]->is_final = true;
    views[i]->reason = "it contradicts the lens that the camera's other views tell";
  }
  return !contradicting.empty();
}

void GiveReasons(RigState* state) {
  for (RigView& view : state->views)
    if (!view.is_used && view.reason.empty())
      view.reason = fmt::format(
          "more than half of its points are beyond {:.0f} standard deviations, or the others are on a line, "
          "or its error is "
          "{:.0f} standard deviations above its camera's usual one",
          kPointSigmas, kViewSigmas);
}

// Rounds of leaving out and fitting until nothing changes.
void FitWithoutOutliers(const std::stop_token& stop, RigFit* fit) {
  constexpr int kRounds = 8;
  RigState& state = fit->state;
  for (int round = 0; round < kRounds; ++round) {
    Adjustment a = AdjustmentOf(&state);
    fit->noise_scale = RobustNoiseScale(a);
    bool has_changed = LeaveOutliers(fit->noise_scale, &a);
    TakeOver(a, &state);
    has_changed |= LeaveUnconfirmedViews(&state);
    if (!has_changed && round > 0) has_changed = LeaveContradictingViews(fit->noise_scale, &state);
    if (!has_changed && round > 0) break;
    a = FitPlainly(&state, fit->noise_scale, 12, stop);
    BundleOptions plain;
    plain.noise_scale = fit->noise_scale;
    ExchangeFlips(round == 0 ? FlipsTried::kOfDoubtful : FlipsTried::kOfMisfits, plain, &a, &state);
    LeaveImpossibleViews(a, &state);
  }
  fit->adjustment = FitPlainly(&state, fit->noise_scale, 30, stop);
  fit->noise_scale = NoiseScale(fit->adjustment).value_or(fit->noise_scale);
}

// Returns whether a camera's lens has another model now.
bool ChooseLenses(const std::stop_token& stop, RigFit* fit) {
  std::vector<AdjustedCamera>& cameras = fit->state.cameras;
  std::vector<char> has_changed(cameras.size(), 0);
  tbb::parallel_for(std::size_t{0}, cameras.size(), [&](std::size_t i) {
    if (cameras[i].is_lens_fixed || fit->state.input->cameras[i].distortion_model) return;
    LensParameters lens = ChooseLens(fit->adjustment, static_cast<int>(i), fit->noise_scale, stop);
    has_changed[i] = lens.model != cameras[i].lens.model ? 1 : 0;
    cameras[i].lens = std::move(lens);
  });
  return std::ranges::count(has_changed, 1) > 0;
}

void RequireEnoughViews(const RigState& state) {
  for (int i = 0; i < static_cast<int>(state.cameras.size()); ++i) {
    int shared = 0, used = 0;
    for (const RigView& view : state.views) {
      if (view.camera != i || !view.is_used) continue;
      ++used;
      shared += view.shares_board ? 1 : 0;
    }
    const std::string next =
        "next, hold the board still, tilted by 30 degrees, where this camera and another see it, at three "
        "places";
    if (shared == 0 && state.cameras.size() > 1)
      throw core::Error(
          core::ErrorKind::kCamera,
          fmt::format("camera '{}': none of its views agrees with those of the other cameras; {}",
                      NameOfCamera(state, i), next));
    if (used < 3 && !state.cameras[static_cast<std::size_t>(i)].is_lens_fixed)
      throw core::Error(
          core::ErrorKind::kCamera,
          fmt::format("camera '{}': {} of its views agree with the rig, and its lens needs 3; {}",
                      NameOfCamera(state, i), used, next));
  }
  if (state.world_set >= 0 && state.UsedViewsOf(state.sets[static_cast<std::size_t>(state.world_set)]) == 0)
    throw core::Error(
        core::ErrorKind::kCamera,
        fmt::format("set {}, which is to be the world, doesn't agree with the rig; next, take a picture of "
                    "the board on the table with camera '{}' and another one",
                    state.sets[static_cast<std::size_t>(state.world_set)].number, NameOfCamera(state, 0)));
}

}  // namespace

Adjustment FitPlainly(RigState* state, double noise_scale, int most_steps, const std::stop_token& stop) {
  BundleOptions options;
  options.noise_scale = noise_scale;
  options.most_steps = most_steps;
  options.settled = most_steps > 20 ? 1e-10 : 1e-6;
  Adjustment a = AdjustBundle(AdjustmentOf(state), options, stop);
  TakeOver(a, state);
  return a;
}

RigFit FitRig(RigState start, const std::stop_token& stop) {
  constexpr double kFarMedians = 6.0;
  RigFit fit;
  fit.state = std::move(start);
  FitRobustly(false, 2, FlipsTried::kOfMisfits, stop, &fit.state);
  FitRobustly(true, 1, FlipsTried::kOfMisfits, stop, &fit.state);
  LeaveFarViews(kFarMedians, false, &fit.state);
  FreeOffsetsAndFlatness(&fit);
  RequireEnoughViews(fit.state);
  FitRobustly(true, 2, FlipsTried::kOfMisfits, stop, &fit.state);
  LeaveImpossibleViews(AdjustmentOf(&fit.state), &fit.state);
  FixUnknownOffsets(stop, &fit);
  AskFarViewsAgain(&fit.state);
  LeaveUnconfirmedViews(&fit.state);
  LeaveUndecidedViews(RobustNoiseScale(AdjustmentOf(&fit.state)), &fit.state);
  FitRobustly(true, 1, FlipsTried::kOfDoubtful, stop, &fit.state);
  FitWithoutOutliers(stop, &fit);
  if (ChooseLenses(stop, &fit)) {
    FitRobustly(true, 1, FlipsTried::kOfMisfits, stop, &fit.state);
    FitWithoutOutliers(stop, &fit);
  }
  RequireEnoughViews(fit.state);
  GiveReasons(&fit.state);
  return fit;
}

}  // namespace elbowroom::recon
