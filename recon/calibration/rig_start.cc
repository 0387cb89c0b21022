#include "recon/calibration/rig_start.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "core/error.h"
#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDecisive = 2.0;  // a view decides between its two poses if their errors differ so much
constexpr double kAgreementShare = 0.015;  // of the picture's longer side: half of a view's say is lost here
constexpr double kAgrees = 2.0;            // times that
constexpr int kMostHypotheses = 40;        // sets of a pair that give them
constexpr int kMostWitnesses = 60;         // sets that are asked about them

// A view with its poses, and a few of its points to ask.
struct StartView {
  std::vector<PlanarPose> poses;
  std::vector<PosePoint> points;      // all
  std::vector<PosePoint> few;         // up to eight, spread
  std::vector<PosePoint> few_turned;  // the same as numbered from the other end; empty: can't be
  double agreement_px = 0.0;
  bool is_decisive = false;
};

struct PairJoin {
  RigidTransform a_from_b;
  int agreeing = 0;
  int shared = 0;
  double score = 0.0;
  bool is_by_numbering = false;  // half a turn of the board would fit as well
};

double MeanError(const LensParameters& lens, const RigidTransform& cam_from_board,
                 std::span<const PosePoint> points) {
  constexpr double kBehindCameraPx = 1e4;
  double sum = 0.0;
  for (const PosePoint& point : points) {
    const auto pixel = ProjectPoint(lens, cam_from_board * point.x_in_board);
    sum += pixel ? std::min((*pixel - point.pixel).norm(), kBehindCameraPx) : kBehindCameraPx;
  }
  return sum / static_cast<double>(points.size());
}

// From either end of the board, the better one.
double ErrorFromEitherEnd(const LensParameters& lens, const RigidTransform& cam_from_board,
                          const StartView& view) {
  const double as_seen = MeanError(lens, cam_from_board, view.few);
  if (view.few_turned.empty()) return as_seen;
  return std::min(as_seen, MeanError(lens, cam_from_board, view.few_turned));
}

double Say(double error_px, double agreement_px) {
  return 1.0 / (1.0 + std::pow(error_px / agreement_px, 2));
}

class RigStarter {
 public:
  RigStarter(const std::stop_token& stop, RigState* state)
      : stop_(stop), state_(*state), half_turn_(state->surface->HalfTurn()) {}

  void Run() {
    FindViews();
    JoinCameras();
    for (RigSet& set : state_.sets) PlaceBoard(&set);
    KeepNumberingOverTime();
    PlaceLensViews();
    MoveToWorld();
  }

 private:
  [[nodiscard]] const LensParameters& LensOf(int camera) const {
    return state_.cameras[static_cast<std::size_t>(camera)].lens;
  }
  [[nodiscard]] const std::string& NameOf(int camera) const {
    return state_.input->cameras[static_cast<std::size_t>(camera)].name;
  }
  [[nodiscard]] bool is_symmetric() const { return !state_.surface->half_turn().empty(); }

  void FindViews();
  [[nodiscard]] StartView StartViewOf(const RigView& view) const;
  void LeaveViewsWithoutPose();
  [[nodiscard]] int ViewIn(const RigSet& set, int camera) const;
  [[nodiscard]] PairJoin Join(int a, int b) const;
  [[nodiscard]] double Disagreement(const RigidTransform& a_from_b, int a_view, int b_view) const;
  [[nodiscard]] std::vector<RigidTransform> PosesFromEitherEnd(int view) const;
  void JoinCameras();
  [[noreturn]] void FailToJoin(const std::vector<bool>& is_joined) const;
  void WarnOfNumbering(int a, int b);
  void PlaceBoard(RigSet* set);
  void TakeBoard(const RigidTransform& rig_from_board, RigSet* set);
  void TurnSet(RigSet* set);
  void KeepNumberingOverTime();
  void PlaceLensViews();
  void MoveToWorld();
  void TurnWorldAsSeen(RigSet* set);

  const std::stop_token& stop_;
  RigState& state_;
  RigidTransform half_turn_;
  std::vector<StartView> views_;
  std::vector<std::vector<PairJoin>> joins_;
};

StartView RigStarter::StartViewOf(const RigView& view) const {
  StartView start;
  const LensParameters& lens = LensOf(view.camera);
  const CalibrationCamera& camera = state_.input->cameras[static_cast<std::size_t>(view.camera)];
  start.agreement_px = kAgreementShare * std::max(camera.width_px, camera.height_px);
  std::vector<PosePoint> posed;
  std::vector<Vector2d> normalised;
  for (const AdjustedPoint& point : view.points) {
    start.points.push_back({state_.surface->Flat(point.point), point.pixel, point.inverse_sigma});
    const std::optional<Vector2d> at = NormalisedPoint(lens, point.pixel);
    if (!at) continue;
    normalised.push_back(*at);
    posed.push_back(start.points.back());
  }
  start.poses = PlanarPosesOf(lens, posed, normalised);
  const std::size_t count = view.points.size(), few = std::min<std::size_t>(8, count);
  for (std::size_t i = 0; i < few; ++i) {
    const std::size_t at = few < 2 ? 0 : i * (count - 1) / (few - 1);
    start.few.push_back(start.points[at]);
    if (!is_symmetric()) continue;
    const auto other = static_cast<std::size_t>(view.points[at].point);
    start.few_turned.push_back(
        {state_.surface->Flat(state_.surface->half_turn()[other]), view.points[at].pixel, 1.0});
  }
  start.is_decisive =
      start.poses.size() == 1 ||
      (start.poses.size() == 2 && start.poses[1].error.rms_px > kDecisive * start.poses[0].error.rms_px);
  return start;
}

void RigStarter::FindViews() {
  views_.resize(state_.views.size());
  tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t i) {
    if (!stop_.stop_requested()) views_[i] = StartViewOf(state_.views[i]);
  });
  core::ThrowIfStopped(stop_, "calibration");
  LeaveViewsWithoutPose();
}

// A view whose points no pose brings near, measured by its camera's other views.
void RigStarter::LeaveViewsWithoutPose() {
  constexpr double kMostMedians = 6.0;
  std::vector<std::vector<double>> errors(state_.cameras.size());
  for (std::size_t i = 0; i < views_.size(); ++i)
    if (!views_[i].poses.empty())
      errors[static_cast<std::size_t>(state_.views[i].camera)].push_back(
          views_[i].poses.front().error.median_px);
  for (auto& of_camera : errors) std::ranges::sort(of_camera);
  for (std::size_t i = 0; i < views_.size(); ++i) {
    RigView& view = state_.views[i];
    const auto& of_camera = errors[static_cast<std::size_t>(view.camera)];
    view.has_pose = !views_[i].poses.empty() &&
                    views_[i].poses.front().error.median_px <= kMostMedians * of_camera[of_camera.size() / 2];
    view.is_used = view.has_pose;
    if (view.has_pose) {
      view.cam_from_board = views_[i].poses.front().cam_from_board;
      continue;
    }
    view.is_final = true;
    view.reason = view.points.size() < 4 ? "fewer than four points" : "no pose of the board fits its points";
  }
}

int RigStarter::ViewIn(const RigSet& set, int camera) const {
  for (const int v : set.views)
    if (state_.views[static_cast<std::size_t>(v)].camera == camera &&
        state_.views[static_cast<std::size_t>(v)].has_pose)
      return v;
  return -1;
}

std::vector<RigidTransform> RigStarter::PosesFromEitherEnd(int view) const {
  std::vector<RigidTransform> poses;
  for (const PlanarPose& pose : views_[static_cast<std::size_t>(view)].poses) {
    poses.push_back(pose.cam_from_board);
    if (is_symmetric()) poses.push_back(pose.cam_from_board * half_turn_);
  }
  return poses;
}

// How far the board that one camera sees is from where the other sees it, in each other's picture, by the
// best of their poses; over the agreement.
double RigStarter::Disagreement(const RigidTransform& a_from_b, int a_view, int b_view) const {
  const StartView& a = views_[static_cast<std::size_t>(a_view)];
  const StartView& b = views_[static_cast<std::size_t>(b_view)];
  const LensParameters& a_lens = LensOf(state_.views[static_cast<std::size_t>(a_view)].camera);
  const LensParameters& b_lens = LensOf(state_.views[static_cast<std::size_t>(b_view)].camera);
  double in_a = 1e9, in_b = 1e9;
  for (const PlanarPose& pose : b.poses)
    in_a = std::min(in_a, ErrorFromEitherEnd(a_lens, a_from_b * pose.cam_from_board, a));
  const RigidTransform b_from_a = a_from_b.Inverse();
  for (const PlanarPose& pose : a.poses)
    in_b = std::min(in_b, ErrorFromEitherEnd(b_lens, b_from_a * pose.cam_from_board, b));
  return 0.5 * (in_a / a.agreement_px + in_b / b.agreement_px);
}

PairJoin RigStarter::Join(int a, int b) const {
  std::vector<std::pair<int, int>> shared;
  for (const RigSet& set : state_.sets) {
    const int a_view = ViewIn(set, a), b_view = ViewIn(set, b);
    if (a_view >= 0 && b_view >= 0) shared.emplace_back(a_view, b_view);
  }
  PairJoin best;
  best.shared = static_cast<int>(shared.size());
  const auto step_of = [&](int most) {
    return std::max<std::size_t>(
        1, (shared.size() + static_cast<std::size_t>(most) - 1) / static_cast<std::size_t>(most));
  };
  for (std::size_t s = 0; s < shared.size(); s += step_of(kMostHypotheses)) {
    if (stop_.stop_requested()) return best;
    for (const PlanarPose& in_a : views_[static_cast<std::size_t>(shared[s].first)].poses) {
      for (const RigidTransform& b_from_board : PosesFromEitherEnd(shared[s].second)) {
        PairJoin join{in_a.cam_from_board * b_from_board.Inverse(), 0, best.shared, 0.0};
        for (std::size_t w = 0; w < shared.size(); w += step_of(kMostWitnesses)) {
          const double disagreement = Disagreement(join.a_from_b, shared[w].first, shared[w].second);
          join.score += Say(disagreement, 1.0);
          join.agreeing += disagreement < kAgrees ? 1 : 0;
        }
        // Between equal hypotheses, as of one set alone, the poses' own errors decide: the better are first.
        if (join.score > best.score + 1e-9) best = join;
      }
    }
  }
  const bool is_decided = best.shared == 1 && views_[static_cast<std::size_t>(shared[0].first)].is_decisive &&
                          views_[static_cast<std::size_t>(shared[0].second)].is_decisive;
  if (best.agreeing < 2 && !is_decided) best.agreeing = 0;
  best.is_by_numbering = best.shared == 1 && is_symmetric();
  return best;
}

void RigStarter::FailToJoin(const std::vector<bool>& is_joined) const {
  std::string joined, apart;
  int first = -1, partner = -1, most_shared = -1;
  for (int i = 0; i < static_cast<int>(is_joined.size()); ++i) {
    std::string& list = is_joined[static_cast<std::size_t>(i)] ? joined : apart;
    list += fmt::format("{}'{}'", list.empty() ? "" : ", ", NameOf(i));
    if (first < 0 && !is_joined[static_cast<std::size_t>(i)]) first = i;
  }
  for (int i = 0; i < static_cast<int>(is_joined.size()); ++i) {
    const int shared = joins_[static_cast<std::size_t>(i)][static_cast<std::size_t>(first)].shared;
    if (is_joined[static_cast<std::size_t>(i)] && shared > most_shared) {
      most_shared = shared;
      partner = i;
    }
  }
  const std::string why =
      most_shared == 0
          ? "they share no view of the board"
          : fmt::format("of '{}' and '{}', {} shared view{} of the board don't decide how they stand",
                        NameOf(partner), NameOf(first), most_shared, most_shared == 1 ? "" : "s");
  throw core::Error(
      core::ErrorKind::kCamera,
      fmt::format("camera {} can't be joined to {}: {}; next, hold the board, tilted by 30 degrees, where "
                  "'{}' and '{}' both see it, at two places or more",
                  apart, joined, why, NameOf(partner), NameOf(first)));
}

void RigStarter::WarnOfNumbering(int a, int b) {
  state_.warnings.push_back(fmt::format(
      "the board looks the same after half a turn, and '{}' and '{}' share one view of it: both are taken to "
      "number it from the same end, the one nearer to the upper left of their pictures; check on which sides "
      "of the table they stand, or take more views",
      NameOf(a), NameOf(b)));
}

void RigStarter::JoinCameras() {
  const int count = static_cast<int>(state_.cameras.size());
  joins_.assign(static_cast<std::size_t>(count), std::vector<PairJoin>(static_cast<std::size_t>(count)));
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) pairs.emplace_back(a, b);
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) {
    const auto a = static_cast<std::size_t>(pairs[i].first), b = static_cast<std::size_t>(pairs[i].second);
    joins_[a][b] = Join(pairs[i].first, pairs[i].second);
    joins_[b][a] = joins_[a][b];
    joins_[b][a].a_from_b = joins_[a][b].a_from_b.Inverse();
  });
  core::ThrowIfStopped(stop_, "calibration");
  std::vector<bool> is_joined(static_cast<std::size_t>(count), false);
  is_joined[0] = true;
  for (int joined = 1; joined < count; ++joined) {
    int from = -1, to = -1;
    double best = 0.0;
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) {
        const PairJoin& join = joins_[static_cast<std::size_t>(b)][static_cast<std::size_t>(a)];
        if (!is_joined[static_cast<std::size_t>(a)] || is_joined[static_cast<std::size_t>(b)] ||
            join.agreeing == 0)
          continue;
        if (join.agreeing + join.score <= best) continue;
        best = join.agreeing + join.score;
        from = a;
        to = b;
      }
    }
    if (to < 0) FailToJoin(is_joined);
    if (joins_[static_cast<std::size_t>(to)][static_cast<std::size_t>(from)].is_by_numbering)
      WarnOfNumbering(from, to);
    is_joined[static_cast<std::size_t>(to)] = true;
    state_.cameras[static_cast<std::size_t>(to)].cam_from_rig =
        joins_[static_cast<std::size_t>(to)][static_cast<std::size_t>(from)].a_from_b *
        state_.cameras[static_cast<std::size_t>(from)].cam_from_rig;
  }
}

// The candidate of all views with which the most views agree.
void RigStarter::PlaceBoard(RigSet* set) {
  double best = 0.0;
  RigidTransform best_pose;
  for (const int v : set->views) {
    const RigView& view = state_.views[static_cast<std::size_t>(v)];
    if (!view.has_pose) continue;
    const RigidTransform rig_from_cam =
        state_.cameras[static_cast<std::size_t>(view.camera)].cam_from_rig.Inverse();
    for (const PlanarPose& pose : views_[static_cast<std::size_t>(v)].poses) {
      const RigidTransform rig_from_board = rig_from_cam * pose.cam_from_board;
      double score = 0.0;
      for (const int w : set->views) {
        const RigView& other = state_.views[static_cast<std::size_t>(w)];
        const StartView& start = views_[static_cast<std::size_t>(w)];
        if (!other.has_pose) continue;
        const auto& cam_from_rig = state_.cameras[static_cast<std::size_t>(other.camera)].cam_from_rig;
        score += Say(ErrorFromEitherEnd(LensOf(other.camera), cam_from_rig * rig_from_board, start),
                     start.agreement_px);
      }
      if (score <= best + 1e-9) continue;
      best = score;
      best_pose = rig_from_board;
    }
  }
  if (best > 0.0) TakeBoard(best_pose, set);
}

void TurnView(const BoardSurface& surface, RigView* view) {
  for (AdjustedPoint& point : view->points)
    point.point = surface.half_turn()[static_cast<std::size_t>(point.point)];
  view->is_half_turned = !view->is_half_turned;
}

// Each view of the set is numbered as the pose says.
void RigStarter::TakeBoard(const RigidTransform& rig_from_board, RigSet* set) {
  set->has_pose = true;
  set->rig_from_board = rig_from_board;
  if (!is_symmetric()) return;
  for (const int v : set->views) {
    RigView& view = state_.views[static_cast<std::size_t>(v)];
    if (!view.has_pose) continue;
    const StartView& start = views_[static_cast<std::size_t>(v)];
    const RigidTransform cam_from_board =
        state_.cameras[static_cast<std::size_t>(view.camera)].cam_from_rig * rig_from_board;
    if (MeanError(LensOf(view.camera), cam_from_board, start.few_turned) <
        MeanError(LensOf(view.camera), cam_from_board, start.few)) {
      TurnView(*state_.surface, &view);
      view.cam_from_board = view.cam_from_board * half_turn_;
    }
  }
}

void RigStarter::TurnSet(RigSet* set) {
  set->rig_from_board = set->rig_from_board * half_turn_;
  for (const int v : set->views) {
    RigView& view = state_.views[static_cast<std::size_t>(v)];
    if (!view.has_pose) continue;
    TurnView(*state_.surface, &view);
    view.cam_from_board = view.cam_from_board * half_turn_;
  }
}

// In the first camera that sees it, the world's first corner is the one with the smaller x + y.
void RigStarter::TurnWorldAsSeen(RigSet* set) {
  for (const int v : set->views) {
    const RigView& view = state_.views[static_cast<std::size_t>(v)];
    if (!view.has_pose) continue;
    const RigidTransform cam_from_board =
        state_.cameras[static_cast<std::size_t>(view.camera)].cam_from_rig * set->rig_from_board;
    if (!state_.surface->HasFirstCornerFirst(cam_from_board)) TurnSet(set);
    return;
  }
}

// A board that looks the same after half a turn doesn't jump by one from a set to the next.
void RigStarter::KeepNumberingOverTime() {
  if (!is_symmetric() || state_.sets.empty()) return;
  const int count = static_cast<int>(state_.sets.size()), start = std::max(0, state_.world_set);
  if (state_.world_set >= 0) TurnWorldAsSeen(&state_.sets[static_cast<std::size_t>(start)]);
  const auto follow = [&](int from, int to, int step) {
    const RigSet* before = nullptr;
    for (int k = from; k != to; k += step) {
      RigSet& set = state_.sets[static_cast<std::size_t>(k)];
      if (!set.has_pose) continue;
      if (before != nullptr &&
          VectorFromRotation(before->rig_from_board.rotation.transpose() * set.rig_from_board.rotation)
                  .norm() > 0.5 * std::numbers::pi)
        TurnSet(&set);
      before = &set;
    }
  };
  follow(start, count, 1);
  follow(start, -1, -1);
}

// Views of a set for themselves start where the set's board is, if they have no better pose.
void RigStarter::PlaceLensViews() {
  for (const RigSet& set : state_.sets) {
    if (!set.has_pose) continue;
    for (const int v : set.views) {
      RigView& view = state_.views[static_cast<std::size_t>(v)];
      if (view.has_pose && set.views.size() > 1)
        view.cam_from_board =
            state_.cameras[static_cast<std::size_t>(view.camera)].cam_from_rig * set.rig_from_board;
    }
  }
}

void RigStarter::MoveToWorld() {
  if (state_.world_set < 0) {
    AdjustedCamera& camera = state_.cameras[static_cast<std::size_t>(state_.input->world.number)];
    camera.is_pose_fixed = true;
    ChangeFrame(camera.cam_from_rig, &state_);
    camera.cam_from_rig = {};
    return;
  }
  RigSet& set = state_.sets[static_cast<std::size_t>(state_.world_set)];
  const bool is_decided =
      set.has_pose && (state_.UsedViewsOf(set) >= 2 || std::ranges::any_of(set.views, [&](int v) {
                         return state_.views[static_cast<std::size_t>(v)].is_used &&
                                views_[static_cast<std::size_t>(v)].is_decisive;
                       }));
  if (!is_decided)
    throw core::Error(
        core::ErrorKind::kCamera,
        fmt::format("camera '{}' doesn't tell how the board lies in set {}, which is to be the world; next, "
                    "take a picture of it on the table in which a second camera sees it too, or from "
                    "nearer and more from the side",
                    NameOf(state_.views[static_cast<std::size_t>(set.views.front())].camera), set.number));
  ChangeFrame(set.rig_from_board.Inverse(), &state_);
  set.rig_from_board = {};
}

}  // namespace

void StartRig(const std::stop_token& stop, RigState* state) { RigStarter(stop, state).Run(); }

}  // namespace elbowroom::recon
