#include "review/cloth.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/units.h"
#include "review/cloth_contact.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

using core::kGravityMmPerS2;
// The speed of vertices is limited to this, so that a hull that jumps doesn't throw the cloth.
constexpr double kFastestVertexMmPerS = 4000.0;
// Steps between two tests against the hull; and how many tests there are at most at a frame's end.
constexpr int kStepsPerLook = 8;
constexpr int kLastLooks = 100;
// A cloth whose vertices are slower than this in a frame, and touch nothing, is not stepped until something
// moves.
constexpr double kStillMmPerS = 0.5;
// Tests at a frame's end before pieces give their sides to their corners, and before all leave to one side.
constexpr int kLooksBeforeAgreeing = 10;
constexpr int kLooksBeforeOneSide = 40;
// An edge that is longer by more than this share of its rest length is caught behind an object that moves on.
// A real curtain would slip off or tear.
constexpr double kCaughtStretch = 2.0;

// Moves the pinned vertices by a share of the way that is left to their places on the part.
void MovePins(const ClothPanel& panel, const core::RigidTransform& world_from_part, double share,
              std::vector<Vector3d>* x) {
  for (std::size_t i = 0; i < x->size(); ++i) {
    if (panel.inverse_mass_per_kg()[i] > 0.0) continue;
    const Vector3d there = world_from_part * panel.rest().vertices_mm[i];
    (*x)[i] = share == 1.0 ? there : Vector3d((*x)[i] + share * (there - (*x)[i]));
  }
}

// One Gauss-Seidel pass of extended position-based dynamics. Each spring starts with a multiplier of 0, so
// its impulse is (rest - length) / (w_a + w_b + compliance / step^2), with w = 1 / mass.
void PullSprings(std::span<const ClothSpring> springs, const std::vector<double>& inverse_mass, double step_s,
                 std::vector<Vector3d>* positions) {
  constexpr double kLeastLengthMm = 1e-9;
  Vector3d* x = positions->data();
  const double per_step2 = 1.0 / (step_s * step_s);
  for (const ClothSpring& spring : springs) {
    const Vector3d along = x[spring.a] - x[spring.b];
    const double length_mm = along.norm();
    if (length_mm <= kLeastLengthMm) continue;
    const double w_a = inverse_mass[spring.a], w_b = inverse_mass[spring.b];
    const double impulse =
        (spring.rest_mm - length_mm) / (length_mm * (w_a + w_b + spring.compliance_mm_per_mn * per_step2));
    x[spring.a] += w_a * impulse * along;
    x[spring.b] -= w_b * impulse * along;
  }
}

void StepSprings(const ClothPanel& panel, double step_s, ClothState* state) {
  const std::vector<Vector3d> before = state->x_in_world;
  const double kept = std::exp(-panel.rule().damping_per_s * step_s);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (panel.inverse_mass_per_kg()[i] <= 0.0) continue;
    state->velocity_in_world[i].z() -= kGravityMmPerS2 * step_s;
    state->x_in_world[i] += step_s * state->velocity_in_world[i];
  }
  PullSprings(panel.springs(), panel.inverse_mass_per_kg(), step_s, &state->x_in_world);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (panel.inverse_mass_per_kg()[i] <= 0.0) continue;
    Vector3d velocity = kept * (state->x_in_world[i] - before[i]) / step_s;
    const double speed = velocity.norm();
    if (speed > kFastestVertexMmPerS) velocity *= kFastestVertexMmPerS / speed;
    state->velocity_in_world[i] = velocity;
  }
}

// True if the pinned vertices are at their places on the part.
bool HasPins(const ClothPanel& panel, const core::RigidTransform& world_from_part,
             const std::vector<Vector3d>& x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (panel.inverse_mass_per_kg()[i] <= 0.0 && x[i] != world_from_part * panel.rest().vertices_mm[i])
      return false;
  }
  return true;
}

double FarthestMove(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) {
  double farthest_mm2 = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i)
    farthest_mm2 = std::max(farthest_mm2, (to[i] - from[i]).squaredNorm());
  return std::sqrt(farthest_mm2);
}

void MeasureStretch(const ClothPanel& panel, ClothState* state) {
  double sum = 0.0;
  state->count.worst_stretch = 0.0;
  for (std::size_t i = 0; i < panel.edge_springs(); ++i) {
    const ClothSpring& spring = panel.springs()[i];
    const double length_mm = (state->x_in_world[spring.a] - state->x_in_world[spring.b]).norm();
    const double stretch = std::abs(length_mm / spring.rest_mm - 1.0);
    sum += stretch;
    state->count.worst_stretch = std::max(state->count.worst_stretch, stretch);
  }
  state->count.mean_stretch = sum / static_cast<double>(panel.edge_springs());
}

// Puts the cloth to where it was before the frame, at rest, and moves all of it out of the hull to one side.
void LetGo(const ClothPanel& panel, const core::RigidTransform& world_from_part,
           const recon::VisualHull& hull, const std::vector<Vector3d>& from, ClothState* state) {
  state->x_in_world = from;
  MovePins(panel, world_from_part, 1.0, &state->x_in_world);
  std::ranges::fill(state->velocity_in_world, Vector3d::Zero());
  std::ranges::fill(state->sides, std::int8_t{0});
  state->count.was_caught = true;
  ClothContact contact(panel, hull, world_from_part.rotation * panel.v_rec_in_part(), state);
  contact.ChooseOneSide();
  for (int look = 0; look < kLastLooks && contact.MoveOut() > 0;) ++look;
  MeasureStretch(panel, state);
}

}  // namespace

ClothState ClothAtRest(const ClothPanel& panel, const core::RigidTransform& world_from_part) {
  ClothState state;
  for (const Vector3d& vertex : panel.rest().vertices_mm)
    state.x_in_world.push_back(world_from_part * vertex);
  state.velocity_in_world.assign(state.x_in_world.size(), Vector3d::Zero());
  state.sides.assign(state.x_in_world.size(), 0);
  return state;
}

ClothState StepCloth(const ClothPanel& panel, ClothState state, const core::RigidTransform& world_from_part,
                     const std::shared_ptr<const recon::VisualHull>& hull, double dt_s) {
  core::Require(state.x_in_world.size() == panel.rest().vertices_mm.size(), "a cloth's state is its panel's");
  core::Require(hull != nullptr && dt_s > 0.0 && dt_s <= 1.0, "a hull, and a step within (0, 1] s");
  state.count = {};
  const std::vector<Vector3d> at_first = state.x_in_world;
  ClothContact contact(panel, *hull, world_from_part.rotation * panel.v_rec_in_part(), &state);
  if (state.hull != nullptr && state.hull != hull) contact.CarryAlong(*state.hull, dt_s);
  if (state.is_still && HasPins(panel, world_from_part, state.x_in_world) && state.count.carried == 0 &&
      (state.hull == hull || contact.MoveOut() == 0)) {
    state.hull = hull;
    MeasureStretch(panel, &state);
    return state;
  }
  const std::vector<Vector3d> before = state.x_in_world;
  const int steps = std::max(1, static_cast<int>(std::ceil(dt_s / kClothStepS - 1e-9)));
  for (int i = 0; i < steps; ++i) {
    MovePins(panel, world_from_part, 1.0 / (steps - i), &state.x_in_world);
    StepSprings(panel, dt_s / steps, &state);
    if (i % kStepsPerLook == 0) (void)contact.MoveOut();
  }
  for (int look = 0; look < kLastLooks && contact.MoveOut() > 0; ++look) {
    if (look == kLooksBeforeAgreeing) contact.AgreeOnSides();
    if (look == kLooksBeforeOneSide) contact.ChooseOneSide();
  }
  contact.ForgetSides();
  MeasureStretch(panel, &state);
  if (state.count.worst_stretch > kCaughtStretch) LetGo(panel, world_from_part, *hull, at_first, &state);
  state.hull = hull;
  state.is_still = state.count.contacts == 0 && FarthestMove(before, state.x_in_world) < kStillMmPerS * dt_s;
  return state;
}

core::TriangleMesh MeshInWorld(const ClothPanel& panel, const ClothState& state) {
  return {state.x_in_world, panel.rest().triangles};
}

double EnergyUj(const ClothPanel& panel, const ClothState& state) {
  double energy_uj = 0.0;
  for (std::size_t i = 0; i < state.x_in_world.size(); ++i) {
    const double inverse_mass = panel.inverse_mass_per_kg()[i];
    if (inverse_mass <= 0.0) continue;
    energy_uj +=
        (0.5 * state.velocity_in_world[i].squaredNorm() + kGravityMmPerS2 * state.x_in_world[i].z()) /
        inverse_mass;
  }
  return energy_uj;
}

}  // namespace elbowroom::review
