#include "review/cloth_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "review/hull_march.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

// Pieces are moved this far beyond the hull's end, so that what lies on the hull isn't in it by rounding.
constexpr double kClothMarginMm = 1.0;
// Assumed: no object is thicker than this along V_rec.
constexpr double kThickestMm = 3000.0;
// Assumed: within a frame no object comes this far through the side to which a vertex left it. Where the way
// out is longer, another object has come, and the side is chosen anew.
constexpr double kDeepestMm = 200.0;
// Pins hold a point if the squared weights of its free vertices sum to less than this.
constexpr double kLeastFreeWeight = 0.05;

double LongestSide(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return std::sqrt(std::max({(a - b).squaredNorm(), (b - c).squaredNorm(), (c - a).squaredNorm()}));
}

}  // namespace

ClothContact::ClothContact(const ClothPanel& panel, const recon::VisualHull& hull,
                           const Vector3d& v_rec_in_world, ClothState* state)
    : panel_(panel),
      hull_(hull),
      v_rec_(v_rec_in_world),
      state_(state),
      sides_agree_(panel.leaves_one_way()),
      one_side_(panel.leaves_one_way() ? 1 : 0),
      known_(panel.rest().triangles.size()),
      touched_(state->x_in_world.size(), 0) {}

ClothContact::Corners ClothContact::CornersOf(std::size_t triangle) const {
  const auto& vertices = panel_.rest().triangles[triangle];
  return {static_cast<std::uint32_t>(vertices[0]), static_cast<std::uint32_t>(vertices[1]),
          static_cast<std::uint32_t>(vertices[2])};
}

Vector3d ClothContact::At(const Corners& corners, const Vector3d& weights) const {
  const std::vector<Vector3d>& x = state_->x_in_world;
  return weights[0] * x[corners[0]] + weights[1] * x[corners[1]] + weights[2] * x[corners[2]];
}

recon::PointAnswer ClothContact::Ask(const Vector3d& x_in_world) {
  ++state_->count.queries;
  return hull_.Probe(x_in_world);
}

std::int64_t ClothContact::MoveOut() {
  const std::int64_t before = state_->count.contacts;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const Corners corners = CornersOf(i);
    Known& known = known_[i];
    if (known.free_mm >= 0.0) {
      double moved_mm2 = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
        moved_mm2 = std::max(moved_mm2, (state_->x_in_world[corners[k]] - known.corners[k]).squaredNorm());
      if (moved_mm2 <= known.free_mm * known.free_mm) continue;
    }
    known.free_mm = MoveTriangleOut(i);
    for (std::size_t k = 0; k < 3; ++k) known.corners[k] = state_->x_in_world[corners[k]];
  }
  return state_->count.contacts - before;
}

// How far the triangle's corners may move while it certainly stays out; negative if a piece had to be moved.
double ClothContact::MoveTriangleOut(std::size_t triangle) {
  const Corners corners = CornersOf(triangle);
  return MovePieceOut(corners, {{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()}});
}

double ClothContact::MovePieceOut(const Corners& corners, const Piece& piece) {
  const Vector3d a = At(corners, piece.weights[0]), b = At(corners, piece.weights[1]),
                 c = At(corners, piece.weights[2]);
  const Vector3d middle_weights = (piece.weights[0] + piece.weights[1] + piece.weights[2]) / 3.0;
  const Vector3d middle = (a + b + c) / 3.0;
  const recon::PointAnswer answer = Ask(middle);
  // A ball outside of the hull that holds the three corners holds the whole piece. The piece stays in it
  // while no corner moves by more than the radius exceeds the distance to the farthest corner.
  if (!answer.is_inside) {
    const double to_corner_mm = std::sqrt(
        std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()}));
    if (answer.radius_mm > to_corner_mm) return answer.radius_mm - to_corner_mm;
  }
  if (LongestSide(a, b, c) <= kClothPieceMm) {
    if (!answer.is_inside) return answer.radius_mm;
    Leave(corners, middle_weights);
    return -1.0;
  }
  const Vector3d ab = 0.5 * (piece.weights[0] + piece.weights[1]),
                 bc = 0.5 * (piece.weights[1] + piece.weights[2]),
                 ca = 0.5 * (piece.weights[2] + piece.weights[0]);
  double free_mm = std::numeric_limits<double>::infinity();
  for (const Piece& part : {Piece{{ab, bc, ca}}, Piece{{piece.weights[0], ab, ca}},
                            Piece{{ab, piece.weights[1], bc}}, Piece{{ca, bc, piece.weights[2]}}}) {
    free_mm = std::min(free_mm, MovePieceOut(corners, part));
  }
  return free_mm;
}

// Moves a point that is in the hull, by its triangle's corners, to the hull's end.
void ClothContact::Leave(const Corners& corners, const Vector3d& weights) {
  const Vector3d from = At(corners, weights);
  int side = SideOf(corners, weights);
  if (side == 0) side = SideAwayFromLast(from);
  std::optional<double> exit_mm;
  if (side != 0) exit_mm = ExitAlong(hull_, {from, side * v_rec_}, one_side_ != 0 ? kThickestMm : kDeepestMm);
  if (!exit_mm) {
    exit_mm = ExitAlong(hull_, {from, v_rec_}, kThickestMm);
    const std::optional<double> other_mm = ExitAlong(hull_, {from, -v_rec_}, exit_mm.value_or(kThickestMm));
    side = other_mm ? -1 : 1;
    if (other_mm) exit_mm = other_mm;
  }
  if (!exit_mm || !Push(corners, weights, side, *exit_mm + kClothMarginMm)) {
    ++state_->count.blocked;
    return;
  }
  ++state_->count.contacts;
}

int ClothContact::SideOf(const Corners& corners, const Vector3d& weights) const {
  if (one_side_ != 0) return one_side_;
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    sum += weights[static_cast<Eigen::Index>(k)] * state_->sides[corners[k]];
  return sum > 0.0 ? 1 : sum < 0.0 ? -1 : 0;
}

// Moves a point of a triangle by `by_mm` to a side, with the least change of its free corners (least
// squares): corner i, of weight u_i, moves by u_i by_mm / sum u^2. False: pins hold it.
bool ClothContact::Push(const Corners& corners, const Vector3d& weights, int side, double by_mm) {
  double free_weight = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double weight = weights[static_cast<Eigen::Index>(k)];
    if (panel_.inverse_mass_per_kg()[corners[k]] > 0.0) free_weight += weight * weight;
  }
  if (free_weight < kLeastFreeWeight) return false;
  const Vector3d out = side * v_rec_;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t vertex = corners[k];
    const double weight = weights[static_cast<Eigen::Index>(k)];
    if (panel_.inverse_mass_per_kg()[vertex] <= 0.0 || weight <= 0.0) continue;
    state_->x_in_world[vertex] += weight / free_weight * by_mm * out;
    Vector3d& velocity = state_->velocity_in_world[vertex];
    const double leaving = std::max(velocity.dot(out), 0.0);
    const Vector3d along = velocity - velocity.dot(out) * out;
    velocity = leaving * out + (touched_[vertex] ? 1.0 : 1.0 - panel_.rule().friction) * along;
    touched_[vertex] = 1;
    if (state_->sides[vertex] == 0 || sides_agree_) state_->sides[vertex] = static_cast<std::int8_t>(side);
  }
  return true;
}

void ClothContact::ChooseOneSide() {
  if (one_side_ != 0) return;
  double along_mm = 0.0, against_mm = 0.0;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const Vector3d middle = At(CornersOf(i), Vector3d::Constant(1.0 / 3.0));
    if (!hull_.Contains(middle)) continue;
    along_mm += ExitAlong(hull_, {middle, v_rec_}, kThickestMm).value_or(kThickestMm);
    against_mm += ExitAlong(hull_, {middle, -v_rec_}, kThickestMm).value_or(kThickestMm);
  }
  sides_agree_ = true;
  one_side_ = along_mm <= against_mm ? 1 : -1;
}

void ClothContact::ForgetSides() {
  for (std::size_t i = 0; i < touched_.size(); ++i)
    if (!touched_[i]) state_->sides[i] = 0;
}

// Looks along V_rec from each vertex and each triangle's middle that the hull may reach. Triangles are
// skipped node by node if the box that they sweep within reach is outside of the hull.
void ClothContact::CarryAlong(const recon::VisualHull& last, double dt_s) {
  const double reach_mm = kFastestHandMmPerS * dt_s;
  last_ = &last;
  reach_mm_ = reach_mm;
  const auto& nodes = panel_.tree().nodes();
  const auto& order = panel_.tree().order();
  std::vector<std::uint8_t> is_asked(state_->x_in_world.size(), 0);
  constexpr std::uint32_t kFewTriangles = 32;
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const core::TriangleTree::Node& node = nodes[waiting.back()];
    waiting.pop_back();
    Eigen::AlignedBox3d box;
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      for (const std::uint32_t vertex : CornersOf(order[i])) {
        box.extend(state_->x_in_world[vertex] + reach_mm * v_rec_);
        box.extend(state_->x_in_world[vertex] - reach_mm * v_rec_);
      }
    recon::UndecidedCameras open;
    ++state_->count.queries;
    const auto shape = recon::WorldShape::Box(box.center(), (0.5 * box.sizes()).asDiagonal());
    if (hull_.Classify(shape, &open) == recon::BallAnswer::kOutside) continue;
    if (node.left != 0 && node.end - node.begin > kFewTriangles) {
      waiting.push_back(node.left + 1);
      waiting.push_back(node.left);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const Corners corners = CornersOf(order[i]);
      CarryPoint(corners, Vector3d::Constant(1.0 / 3.0));
      for (Eigen::Index k = 0; k < 3; ++k) {
        std::uint8_t& asked = is_asked[corners[static_cast<std::size_t>(k)]];
        if (!asked) CarryPoint(corners, Vector3d::Unit(k));
        asked = 1;
      }
    }
  }
}

// The side on which a point leaves the hull: away from where the last frame's hull was. 0: that hull held the
// point already, or wasn't within reach, or (beside a hull that slopes) the way out on that side is longer
// than the hull can have moved.
int ClothContact::SideAwayFromLast(const Vector3d& from) const {
  if (last_ == nullptr || last_->Contains(from)) return 0;
  const auto ahead_mm = EntryAlong(*last_, {from, v_rec_}, reach_mm_);
  const auto behind_mm = EntryAlong(*last_, {from, -v_rec_}, ahead_mm.value_or(reach_mm_));
  if (!ahead_mm && !behind_mm) return 0;
  const int side = behind_mm ? 1 : -1;
  return ExitAlong(hull_, {from, side * v_rec_}, reach_mm_) ? side : 0;
}

// The hull has come over a point: corners without a side get the one away from where the hull was.
void ClothContact::NoteSide(const Corners& corners, const Vector3d& from) {
  const int side = SideAwayFromLast(from);
  for (const std::uint32_t vertex : corners)
    if (state_->sides[vertex] == 0) state_->sides[vertex] = static_cast<std::int8_t>(side);
}

// A hull that was on one side of the point, and is now on the other and wasn't there before, has passed the
// point. The point is moved to that hull's far end.
void ClothContact::CarryPoint(const Corners& corners, const Vector3d& weights) {
  const recon::VisualHull& last = *last_;
  const double reach_mm = reach_mm_;
  const Vector3d from = At(corners, weights);
  ++state_->count.queries;
  if (last.Contains(from)) return;
  if (hull_.Contains(from)) return NoteSide(corners, from);
  for (const int side : {1, -1}) {
    const Vector3d ahead = side * v_rec_;
    const std::optional<double> entry_mm = EntryAlong(hull_, {from, ahead}, reach_mm);
    if (!entry_mm) continue;
    const auto was_behind_mm = EntryAlong(last, {from, -ahead}, reach_mm - *entry_mm);
    if (!was_behind_mm || EntryAlong(last, {from, ahead}, reach_mm)) continue;
    const double in_mm = *entry_mm + kExitStepMm;
    const auto through_mm = ExitAlong(hull_, {from + in_mm * ahead, ahead}, kThickestMm);
    if (through_mm && Push(corners, weights, side, in_mm + *through_mm + kClothMarginMm))
      ++state_->count.carried;
    return;
  }
}

}  // namespace elbowroom::review
