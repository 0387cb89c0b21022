#include "recon/calibration/rig_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "core/error.h"
#include "recon/calibration/board_surface.h"
#include "recon/calibration/lens_projection.h"
#include "recon/calibration/planar_pose.h"
#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;

constexpr double kCheckCauchyScale = 10.0;  // of the sightings' sigmas: other programs' rigs aren't as exact

// One camera's view, numbered from either end where the board allows that.
struct CheckedView {
  int camera = 0;
  std::vector<PosePoint> points;
  std::vector<PosePoint> turned;  // the same from the other end; empty: there is none
};

struct CheckedSet {
  int number = 0;
  double movement_px = 0.0;  // of the board, from its pictures before and after
  std::vector<CheckedView> views;
};

std::vector<PosePoint> PointsOfView(const BoardSurface& surface, const BoardSighting& sighting,
                                    bool is_turned) {
  std::vector<PosePoint> points;
  for (const SightedPoint& point : sighting.points) {
    const int number = is_turned ? surface.half_turn()[static_cast<std::size_t>(point.point)] : point.point;
    points.push_back({surface.Flat(number), point.pixel, 1.0 / point.sigma_px});
  }
  return points;
}

double MeanDistance(const BoardSighting& a, const BoardSighting& b) {
  double sum_px = 0.0;
  int shared = 0;
  for (const SightedPoint& point : a.points) {
    const auto other = std::ranges::find(b.points, point.point, &SightedPoint::point);
    if (other == b.points.end()) continue;
    sum_px += (point.pixel - other->pixel).norm();
    ++shared;
  }
  return shared > 0 ? sum_px / shared : std::numeric_limits<double>::infinity();
}

using ViewsBySet = std::map<int, std::vector<const CalibrationView*>>;

ViewsBySet BySet(const CalibrationInput& input) {
  ViewsBySet sets;
  for (const CalibrationView& view : input.views)
    if (view.set) sets[*view.set].push_back(&view);
  for (auto& [number, views] : sets) std::ranges::sort(views, {}, &CalibrationView::camera);
  return sets;
}

// How far the board moves, in the mean, from one of a camera's pictures to the next. Infinite where there is
// none next to it.
double MovementIn(const ViewsBySet& sets, int number) {
  double most_px = 0.0;
  for (const CalibrationView* view : sets.at(number)) {
    double least_px = std::numeric_limits<double>::infinity();
    for (const int next : {number - 1, number + 1}) {
      if (!sets.contains(next)) continue;
      for (const CalibrationView* other : sets.at(next))
        if (other->camera == view->camera)
          least_px = std::min(least_px, MeanDistance(view->sighting, other->sighting));
    }
    most_px = std::max(most_px, least_px);
  }
  return most_px;
}

CheckedSet SetOf(const BoardSurface& surface, int number, const std::vector<const CalibrationView*>& views) {
  CheckedSet set{number, 0.0, {}};
  for (const CalibrationView* view : views) {
    CheckedView checked{view->camera, PointsOfView(surface, view->sighting, false), {}};
    if (!surface.half_turn().empty()) checked.turned = PointsOfView(surface, view->sighting, true);
    set.views.push_back(std::move(checked));
  }
  return set;
}

// The sets that several cameras see; of a moving board those in which it moves the least; not too many.
std::vector<CheckedSet> SetsToCheck(const CalibrationInput& input, const BoardSurface& surface) {
  constexpr std::size_t kFewest = 3, kMost = 40;
  const ViewsBySet by_set = BySet(input);
  std::vector<CheckedSet> sets;
  for (const auto& [number, views] : by_set) {
    if (views.size() < 2) continue;
    sets.push_back(SetOf(surface, number, views));
    sets.back().movement_px = input.finds_offsets ? MovementIn(by_set, number) : 0.0;
  }
  if (input.finds_offsets) {
    std::ranges::stable_sort(sets, {}, &CheckedSet::movement_px);
    sets.resize(std::min(sets.size(), std::max(kFewest, sets.size() / 2)));
  }
  std::vector<CheckedSet> chosen;
  const std::size_t count = std::min(sets.size(), kMost);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(std::move(sets[i * sets.size() / count]));
  return chosen;
}

// A rig under test: its lenses as numbers, its poses with a scale.
class ScaledRig {
 public:
  explicit ScaledRig(std::span<const core::CameraCalibration> cameras) {
    for (const core::CameraCalibration& camera : cameras) {
      const core::CameraModel model(camera);
      lenses_.push_back(LensParametersOf(model.calibration()));
      cam_from_world_.push_back(model.cam_from_world());
    }
  }
  [[nodiscard]] const LensParameters& lens(int camera) const {
    return lenses_[static_cast<std::size_t>(camera)];
  }
  [[nodiscard]] RigidTransform CamFromWorld(int camera, double scale) const {
    const RigidTransform& unscaled = cam_from_world_[static_cast<std::size_t>(camera)];
    return {unscaled.rotation, scale * unscaled.translation_mm};
  }

 private:
  std::vector<LensParameters> lenses_;
  std::vector<RigidTransform> cam_from_world_;
};

std::vector<PlanarPose> PosesOf(const ScaledRig& rig, const CheckedView& view,
                                const std::vector<PosePoint>& points) {
  std::vector<PosePoint> posed;
  std::vector<Eigen::Vector2d> normalised;
  for (const PosePoint& point : points) {
    const auto at = NormalisedPoint(rig.lens(view.camera), point.pixel);
    if (!at) continue;
    posed.push_back(point);
    normalised.push_back(*at);
  }
  return PlanarPosesOf(rig.lens(view.camera), posed, normalised);
}

// All poses that a view by itself allows: the flip, and from either end.
struct ViewPoses {
  std::vector<RigidTransform> cam_from_board;
};
using SetPoses = std::vector<ViewPoses>;  // by view of the set

SetPoses PosesOfSet(const ScaledRig& rig, const CheckedSet& set) {
  SetPoses poses;
  for (const CheckedView& view : set.views) {
    ViewPoses& of_view = poses.emplace_back();
    for (const auto* points : {&view.points, &view.turned}) {
      if (points->empty()) continue;
      for (const PlanarPose& pose : PosesOf(rig, view, *points))
        of_view.cam_from_board.push_back(pose.cam_from_board);
    }
  }
  return poses;
}

// The scale that two views of a set tell, by the pair of their poses whose relative rotation is nearest to
// the rig's. Nothing: there is no pose, or the two cameras stand in one place.
std::optional<double> ScaleOfPair(const ScaledRig& rig, const CheckedSet& set, const SetPoses& poses,
                                  std::size_t i, std::size_t j) {
  const RigidTransform i_from_j =
      rig.CamFromWorld(set.views[i].camera, 1.0) * rig.CamFromWorld(set.views[j].camera, 1.0).Inverse();
  const double length2 = i_from_j.translation_mm.squaredNorm();
  if (!(length2 > 0.0)) return std::nullopt;
  double least_rad = std::numeric_limits<double>::infinity();
  std::optional<double> scale;
  for (const RigidTransform& in_i : poses[i].cam_from_board) {
    for (const RigidTransform& in_j : poses[j].cam_from_board) {
      const RigidTransform seen = in_i * in_j.Inverse();
      const double turn_rad = VectorFromRotation(seen.rotation.transpose() * i_from_j.rotation).norm();
      if (turn_rad >= least_rad) continue;
      least_rad = turn_rad;
      scale = seen.translation_mm.dot(i_from_j.translation_mm) / length2;
    }
  }
  return scale;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Where the board is in a set, each view numbered from the end that fits.
struct PlacedBoard {
  RigidTransform world_from_board;
  std::vector<PosedView> views;
  double cost = std::numeric_limits<double>::infinity();
};

// Every view numbered from the end that fits the pose better.
PlacedBoard NumberedFor(const ScaledRig& rig, const CheckedSet& set, double scale,
                        const RigidTransform& world_from_board) {
  PlacedBoard placed{world_from_board, {}, 0.0};
  for (const CheckedView& view : set.views) {
    PosedView one{&rig.lens(view.camera), rig.CamFromWorld(view.camera, scale), view.points};
    ViewError error = ErrorOf(one, world_from_board);
    if (!view.turned.empty()) {
      PosedView other = one;
      other.points = view.turned;
      const ViewError turned = ErrorOf(other, world_from_board);
      if (turned.rms_px < error.rms_px) {
        one = std::move(other);
        error = turned;
      }
    }
    placed.cost += std::min(error.median_px, 1e3);
    placed.views.push_back(std::move(one));
  }
  return placed;
}

// Fitted from the best pose that one of the set's views tells.
std::optional<PlacedBoard> Place(const ScaledRig& rig, const CheckedSet& set, const SetPoses& poses,
                                 double scale) {
  PlacedBoard best;
  for (std::size_t i = 0; i < set.views.size(); ++i) {
    const RigidTransform world_from_cam = rig.CamFromWorld(set.views[i].camera, scale).Inverse();
    for (const RigidTransform& cam_from_board : poses[i].cam_from_board) {
      PlacedBoard placed = NumberedFor(rig, set, scale, world_from_cam * cam_from_board);
      if (placed.cost < best.cost) best = std::move(placed);
    }
  }
  if (best.views.empty()) return std::nullopt;
  const PoseFit fit = FitBoardPose(best.views, best.world_from_board, kCheckCauchyScale);
  best.world_from_board = fit.rig_from_board;
  best.cost = fit.cost;
  return best;
}

// The fits of all sets at one scale.
struct ScaleFit {
  double cost = 0.0;
  std::vector<std::optional<PlacedBoard>> boards;
};

class ScaleSearch {
 public:
  ScaleSearch(const ScaledRig& rig, const std::vector<CheckedSet>& sets) : rig_(rig), sets_(sets) {
    for (const CheckedSet& set : sets_) poses_.push_back(PosesOfSet(rig_, set));
  }

  [[nodiscard]] ScaleFit At(double scale) const {
    ScaleFit fit;
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      fit.boards.push_back(Place(rig_, sets_[i], poses_[i], scale));
      if (fit.boards.back()) fit.cost += fit.boards.back()->cost;
    }
    return fit;
  }

  // The median over all pairs of views, refined by parabolas through the cost. Nothing: no pair tells any.
  [[nodiscard]] std::optional<double> Find() const {
    std::vector<double> scales;
    for (std::size_t k = 0; k < sets_.size(); ++k) {
      for (std::size_t j = 1; j < sets_[k].views.size(); ++j) {
        for (std::size_t i = 0; i < j; ++i)
          if (const auto scale = ScaleOfPair(rig_, sets_[k], poses_[k], i, j))
            scales.push_back(std::abs(*scale));
      }
    }
    if (scales.empty()) return std::nullopt;
    double scale = Median(std::move(scales));
    if (!(scale > 0.0) || !std::isfinite(scale)) return std::nullopt;
    for (const double step : {0.05, 0.02, 0.005, 0.001}) scale = Refined(scale, step);
    return scale;
  }

 private:
  // The minimum of the parabola through three scales, at most three steps away.
  [[nodiscard]] double Refined(double scale, double step) const {
    const double below = At(scale * (1.0 - step)).cost, at = At(scale).cost,
                 above = At(scale * (1.0 + step)).cost;
    const double curvature = below - 2.0 * at + above, slope = 0.5 * (above - below);
    double steps = slope > 0.0 ? -1.0 : 1.0;
    if (curvature > 0.0) steps = std::clamp(-slope / curvature, -3.0, 3.0);
    return scale * (1.0 + steps * step);
  }

  const ScaledRig& rig_;
  const std::vector<CheckedSet>& sets_;
  std::vector<SetPoses> poses_;
};

RigCheck Summed(const ScaleFit& fit, const std::vector<CheckedSet>& sets, std::size_t cameras, double scale) {
  RigCheck check;
  check.scale = scale;
  std::vector<double> errors_px;
  std::vector<std::vector<double>> by_camera(cameras);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (!fit.boards[i]) continue;
    ++check.sets;
    for (std::size_t v = 0; v < sets[i].views.size(); ++v) {
      const double rms_px = ErrorOf(fit.boards[i]->views[v], fit.boards[i]->world_from_board).rms_px;
      errors_px.push_back(rms_px);
      by_camera[static_cast<std::size_t>(sets[i].views[v].camera)].push_back(rms_px);
      ++check.views;
    }
  }
  check.error_px = Median(std::move(errors_px));
  for (std::vector<double>& errors : by_camera)
    check.camera_error_px.push_back(errors.empty() ? std::nullopt : std::optional(Median(std::move(errors))));
  return check;
}

}  // namespace

std::optional<RigCheck> CheckRig(const CalibrationInput& input,
                                 std::span<const core::CameraCalibration> cameras,
                                 std::optional<double> scale) {
  core::Require(cameras.size() == input.cameras.size(), "a rig is checked with the cameras of its footage");
  const BoardSurface surface(input.board);
  const ScaledRig rig(cameras);
  const std::vector<CheckedSet> sets = SetsToCheck(input, surface);
  if (sets.empty()) return std::nullopt;
  const ScaleSearch search(rig, sets);
  if (!scale) scale = search.Find();
  if (!scale) return std::nullopt;
  const ScaleFit fit = search.At(*scale);
  if (std::ranges::none_of(fit.boards, [](const auto& board) { return board.has_value(); }))
    return std::nullopt;
  return Summed(fit, sets, cameras.size(), *scale);
}

std::optional<RigidTransform> BoardInSet(const CalibrationInput& input,
                                         std::span<const core::CameraCalibration> cameras, int set) {
  constexpr double kDecided = 2.0;
  const BoardSurface surface(input.board);
  const ScaledRig rig(cameras);
  const ViewsBySet by_set = BySet(input);
  const auto found = by_set.find(set);
  if (found == by_set.end()) return std::nullopt;
  const CheckedSet checked = SetOf(surface, set, found->second);
  const std::optional<PlacedBoard> placed = Place(rig, checked, PosesOfSet(rig, checked), 1.0);
  if (!placed) return std::nullopt;
  if (checked.views.size() == 1) {
    const std::vector<PlanarPose> poses = PosesOf(rig, checked.views.front(), checked.views.front().points);
    if (poses.size() == 2 && poses[1].error.rms_px < kDecided * poses[0].error.rms_px) return std::nullopt;
  }
  const RigidTransform cam_from_board =
      rig.CamFromWorld(checked.views.front().camera, 1.0) * placed->world_from_board;
  const bool is_turned = !surface.half_turn().empty() && !surface.HasFirstCornerFirst(cam_from_board);
  return is_turned ? placed->world_from_board * surface.HalfTurn() : placed->world_from_board;
}

bool AreTheSameRig(std::span<const core::CameraCalibration> a, std::span<const core::CameraCalibration> b) {
  constexpr double kSameTurnRad = 0.1 * std::numbers::pi / 180.0, kSameShare = 0.01;
  const auto relative = [](std::span<const core::CameraCalibration> rig, std::size_t i) {
    return rig[i].cam_from_world * rig.front().cam_from_world.Inverse();
  };
  const auto size_of = [&](std::span<const core::CameraCalibration> rig) {
    double size = 0.0;
    for (std::size_t i = 1; i < rig.size(); ++i)
      size = std::max(size, relative(rig, i).Inverse().translation_mm.norm());
    return size;
  };
  const double size_a = size_of(a), size_b = size_of(b);
  for (std::size_t i = 1; i < a.size(); ++i) {
    const RigidTransform in_a = relative(a, i).Inverse(), in_b = relative(b, i).Inverse();
    if (VectorFromRotation(in_a.rotation.transpose() * in_b.rotation).norm() > kSameTurnRad) return false;
    if ((in_a.translation_mm / size_a - in_b.translation_mm / size_b).norm() > kSameShare) return false;
    if (!a[i].camera_matrix.isApprox(b[i].camera_matrix, 1e-6)) return false;
  }
  return true;
}

}  // namespace elbowroom::recon
