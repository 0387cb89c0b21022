#include "review/cloth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "review/cloth_contact.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

constexpr double kGravityMmPerS2 = 9806.65;
// No vertex is let go faster: a hull that jumps must not throw the cloth.
constexpr double kFastestVertexMmPerS = 4000.0;
// Steps between two looks at the hull, and looks at a frame's end at most.
constexpr int kStepsPerLook = 4;
constexpr int kLastLooks = 40;

// Where a vertex that the part holds is at a share of the frame's way.
void MovePins(const ClothPanel& panel, const core::RigidTransform& world_from_part, double share,
              std::vector<Vector3d>* x) {
  for (std::size_t i = 0; i < x->size(); ++i) {
    if (panel.inverse_mass_per_kg()[i] > 0.0) continue;
    (*x)[i] += share * (world_from_part * panel.rest().vertices_mm[i] - (*x)[i]);
  }
}

// Moves both ends of a spring along it by an impulse.
void Apply(const ClothPanel& panel, const ClothSpring& spring, const Vector3d& direction, double impulse,
           std::vector<Vector3d>* x) {
  (*x)[spring.a] += panel.inverse_mass_per_kg()[spring.a] * impulse * direction;
  (*x)[spring.b] -= panel.inverse_mass_per_kg()[spring.b] * impulse * direction;
}

// One pass over the springs, from the last step's impulses.
void PullSprings(const ClothPanel& panel, double step_s, ClothState* state) {
  constexpr double kLeastLengthMm = 1e-9;
  // What a spring may carry over: the panel's weight. More comes from jumps and must not act twice.
  const double most = panel.mass_kg() * kGravityMmPerS2 * step_s * step_s;
  const auto& springs = panel.springs();
  std::vector<Vector3d>& x = state->x_in_world;
  const std::vector<Vector3d> before = x;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    double& multiplier = state->multipliers[i];
    multiplier = std::clamp(multiplier, -most, most);
    const Vector3d along = before[springs[i].a] - before[springs[i].b];
    const double length_mm = along.norm();
    if (length_mm > kLeastLengthMm) Apply(panel, springs[i], along / length_mm, multiplier, &x);
  }
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const ClothSpring& spring = springs[i];
    const Vector3d along = x[spring.a] - x[spring.b];
    const double length_mm = along.norm();
    if (length_mm <= kLeastLengthMm) continue;
    const double softness = spring.compliance_mm_per_mn / (step_s * step_s);
    const double inverse_mass = panel.inverse_mass_per_kg()[spring.a] + panel.inverse_mass_per_kg()[spring.b];
    const double change =
        (spring.rest_mm - length_mm - softness * state->multipliers[i]) / (inverse_mass + softness);
    state->multipliers[i] += change;
    Apply(panel, spring, along / length_mm, change, &x);
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
  PullSprings(panel, step_s, state);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (panel.inverse_mass_per_kg()[i] <= 0.0) continue;
    Vector3d velocity = kept * (state->x_in_world[i] - before[i]) / step_s;
    const double speed = velocity.norm();
    if (speed > kFastestVertexMmPerS) velocity *= kFastestVertexMmPerS / speed;
    state->velocity_in_world[i] = velocity;
  }
}

void MeasureStretch(const ClothPanel& panel, ClothState* state) {
  double sum = 0.0;
  for (std::size_t i = 0; i < panel.edge_springs(); ++i) {
    const ClothSpring& spring = panel.springs()[i];
    const double length_mm = (state->x_in_world[spring.a] - state->x_in_world[spring.b]).norm();
    const double stretch = std::abs(length_mm / spring.rest_mm - 1.0);
    sum += stretch;
    state->count.worst_stretch = std::max(state->count.worst_stretch, stretch);
  }
  state->count.mean_stretch = sum / static_cast<double>(panel.edge_springs());
}

}  // namespace

ClothState ClothAtRest(const ClothPanel& panel, const core::RigidTransform& world_from_part) {
  ClothState state;
  for (const Vector3d& vertex : panel.rest().vertices_mm)
    state.x_in_world.push_back(world_from_part * vertex);
  state.velocity_in_world.assign(state.x_in_world.size(), Vector3d::Zero());
  state.multipliers.assign(panel.springs().size(), 0.0);
  state.sides.assign(state.x_in_world.size(), 0);
  return state;
}

ClothState StepCloth(const ClothPanel& panel, ClothState state, const core::RigidTransform& world_from_part,
                     const std::shared_ptr<const recon::VisualHull>& hull, double dt_s) {
  core::Require(state.x_in_world.size() == panel.rest().vertices_mm.size() &&
                    state.multipliers.size() == panel.springs().size(),
                "a cloth's state is its panel's");
  core::Require(hull != nullptr && dt_s > 0.0 && dt_s <= 1.0, "a hull, and a step within (0, 1] s");
  state.count = {};
  ClothContact contact(panel, *hull, world_from_part.rotation * panel.v_rec_in_part(), &state);
  if (state.hull != nullptr && state.hull != hull) contact.CarryAlong(*state.hull, dt_s);
  const int steps = std::max(1, static_cast<int>(std::ceil(dt_s / kClothStepS - 1e-9)));
  for (int i = 0; i < steps; ++i) {
    MovePins(panel, world_from_part, 1.0 / (steps - i), &state.x_in_world);
    StepSprings(panel, dt_s / steps, &state);
    if (i % kStepsPerLook == 0) (void)contact.MoveOut();
  }
  for (int look = 0; look < kLastLooks; ++look)
    if (contact.MoveOut() == 0) break;
  contact.ForgetSides();
  state.hull = hull;
  MeasureStretch(panel, &state);
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
  for (const ClothSpring& spring : panel.springs()) {
    const double longer_mm =
        (state.x_in_world[spring.a] - state.x_in_world[spring.b]).norm() - spring.rest_mm;
    energy_uj += 0.5 * longer_mm * longer_mm / spring.compliance_mm_per_mn;
  }
  return energy_uj;
}

}  // namespace elbowroom::review
