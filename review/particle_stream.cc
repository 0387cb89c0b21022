#include "review/particle_stream.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "core/part_distance.h"
#include "core/units.h"
#include "recon/hull/visual_hull.h"
#include "review/hull_march.h"
#include "review/inside_cells.h"

namespace elbowroom::review {
namespace {

using core::NearestOnPart;
using Eigen::Vector3d;

using core::kGravityMmPerS2;
constexpr double kStepS = 1.0 / 240.0;
constexpr double kKeptAlong = 0.9;    // share of the speed along a surface that a touch in a step keeps
constexpr double kSpread = 0.06;      // half angle of the jet, rad
constexpr double kTouchingMm = 0.2;   // free room that counts as none
constexpr double kNearExitMm = 80.0;  // a particle moves no farther than this out of a hull that came over it
constexpr int kMostMoves = 64;        // at most, in one step

// Two numbers in [0, 1) that depend only on the particle's number (SplitMix64).
std::array<double, 2> Jitter(std::int64_t number) {
  const auto mix = [](std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  };
  const std::uint64_t seed = static_cast<std::uint64_t>(number) * 2 + 1;
  return {mix(seed * 0x9E3779B97F4A7C15ULL), mix((seed + 1) * 0x9E3779B97F4A7C15ULL)};
}

Particle Emitted(const core::Stream& stream, std::int64_t number) {
  const Vector3d ahead = stream.direction.normalized();
  const Vector3d right = ahead.unitOrthogonal(), up = ahead.cross(right);
  const auto [turn, share] = Jitter(number);
  const double angle = 2.0 * std::numbers::pi * turn, out = std::sqrt(share);
  const Vector3d aside = std::cos(angle) * right + std::sin(angle) * up;
  return {stream.position_mm + stream.radius_mm * out * aside,
          stream.speed_mm_per_s * (ahead + kSpread * out * aside).normalized()};
}

// Everything that a particle may meet.
class Surroundings {
 public:
  Surroundings(const recon::VisualHull& hull, std::span<const StreamObstacle> obstacles)
      : hull_(hull), obstacles_(obstacles) {}

  // The radius around a point that is free of hull and parts, and the outward direction of what limits it.
  // The hull's direction is only found where it is touched.
  struct Room {
    double free_mm = 0.0;
    Vector3d away = Vector3d::Zero();  // unit; zero: not known
  };
  [[nodiscard]] Room RoomAt(const Vector3d& x_in_world) const {
    Room room{std::numeric_limits<double>::infinity(), Vector3d::Zero()};
    for (const StreamObstacle& obstacle : obstacles_) {
      const Vector3d x_in_part = obstacle.world_from_part.Inverse() * x_in_world;
      if (obstacle.part->bounds().exteriorDistance(x_in_part) - kParticleGapMm >= room.free_mm) continue;
      const NearestOnPart nearest = FindNearest(*obstacle.part, {.center = x_in_part});
      if (nearest.distance_mm - kParticleGapMm >= room.free_mm) continue;
      room = {nearest.distance_mm - kParticleGapMm,
              obstacle.world_from_part.rotation * (x_in_part - nearest.position_in_part).normalized()};
    }
    const recon::PointAnswer answer = hull_.Probe(x_in_world);
    const double hull_mm = answer.is_inside ? 0.0 : answer.radius_mm;
    if (hull_mm >= room.free_mm) return room;
    room = {hull_mm, Vector3d::Zero()};
    if (hull_mm <= kTouchingMm)
      room.away = hull_.EdgeAt(x_in_world).normal_in_world.value_or(Vector3d::Zero());
    return room;
  }

  [[nodiscard]] bool IsInPart(const Vector3d& x_in_world) const {
    return std::ranges::any_of(obstacles_, [&](const StreamObstacle& obstacle) {
      if (!obstacle.part->is_closed()) return false;
      const Vector3d x_in_part = obstacle.world_from_part.Inverse() * x_in_world;
      return obstacle.part->bounds().contains(x_in_part) && IsInsideClosedMesh(*obstacle.part, x_in_part);
    });
  }

  // The nearest way out of the hull along the surface's normal or an axis of the world.
  [[nodiscard]] std::optional<Vector3d> OutOfHull(const Vector3d& x_in_world) const {
    std::optional<Vector3d> out;
    double least_mm = kNearExitMm;
    const auto offer = [&](const Vector3d& direction) {
      const std::optional<double> exit_mm = ExitAlong(hull_, {x_in_world, direction}, least_mm);
      if (!exit_mm || *exit_mm >= least_mm) return;
      least_mm = *exit_mm;
      out = x_in_world + *exit_mm * direction;
    };
    if (const auto normal = hull_.EdgeAt(x_in_world).normal_in_world) offer(*normal);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      offer(Vector3d::Unit(axis));
      offer(-Vector3d::Unit(axis));
    }
    return out;
  }

  [[nodiscard]] const recon::VisualHull& hull() const { return hull_; }

 private:
  const recon::VisualHull& hull_;
  std::span<const StreamObstacle> obstacles_;
};

// Moves a particle through free room, piece by piece, and lets it slide where it touches.
void Move(const Surroundings& around, double step_s, Particle* particle) {
  particle->velocity_in_world.z() -= kGravityMmPerS2 * step_s;
  double left_s = step_s;
  bool has_touched = false;
  for (int i = 0; i < kMostMoves && left_s > 0.0; ++i) {
    const double speed = particle->velocity_in_world.norm();
    if (speed <= 0.0) return;
    const Surroundings::Room room = around.RoomAt(particle->x_in_world);
    if (room.free_mm > kTouchingMm) {
      const double move_s = std::min(left_s, 0.999 * room.free_mm / speed);
      particle->x_in_world += move_s * particle->velocity_in_world;
      left_s -= move_s;
      continue;
    }
    // In touch: the speed into the surface is lost. The particle is put a little away from the surface, so
    // that it can slide on.
    Vector3d& velocity = particle->velocity_in_world;
    const Vector3d away = room.away.isZero() ? Vector3d(-velocity.normalized()) : room.away;
    velocity -= std::min(velocity.dot(away), 0.0) * away;
    if (!has_touched) velocity *= kKeptAlong;
    has_touched = true;
    const Vector3d aside = particle->x_in_world + 2.0 * kTouchingMm * away;
    const Surroundings::Room there = around.RoomAt(aside);
    if (there.free_mm <= room.free_mm) return;
    particle->x_in_world = aside;
  }
}

enum class Fate { kStays, kLeft, kSwallowed };

Fate Step(const Surroundings& around, double step_s, Particle* particle) {
  if (around.hull().Contains(particle->x_in_world)) {
    const std::optional<Vector3d> out = around.OutOfHull(particle->x_in_world);
    if (!out) return Fate::kSwallowed;
    particle->x_in_world = *out;
    particle->velocity_in_world.setZero();
  }
  const double free_mm = around.RoomAt(particle->x_in_world).free_mm;
  if (free_mm < 0.0 || around.IsInPart(particle->x_in_world)) return Fate::kSwallowed;
  Move(around, step_s, particle);
  const bool stays = around.hull().rig().workspace_mm.contains(particle->x_in_world);
  return stays ? Fate::kStays : Fate::kLeft;
}

void Emit(const core::Stream& stream, double step_s, StreamState* state) {
  state->due = std::min(state->due + stream.rate_per_s * step_s, static_cast<double>(kMostParticles));
  for (; state->due >= 1.0 && state->particles.size() < kMostParticles; state->due -= 1.0) {
    state->particles.push_back(Emitted(stream, state->emitted));
    ++state->emitted;
  }
}

}  // namespace

StreamState StepStream(const core::Stream& stream, StreamState state, const recon::VisualHull& hull,
                       std::span<const StreamObstacle> obstacles, double dt_s) {
  core::Require(dt_s > 0.0 && dt_s <= 1.0, "a step within (0, 1] s");
  const Surroundings around(hull, obstacles);
  const int steps = std::max(1, static_cast<int>(std::ceil(dt_s / kStepS - 1e-9)));
  for (int i = 0; i < steps; ++i) {
    Emit(stream, dt_s / steps, &state);
    std::vector<Fate> fates(state.particles.size());
    tbb::parallel_for(std::size_t{0}, fates.size(),
                      [&](std::size_t k) { fates[k] = Step(around, dt_s / steps, &state.particles[k]); });
    std::size_t kept = 0;
    for (std::size_t k = 0; k < fates.size(); ++k) {
      if (fates[k] == Fate::kStays) state.particles[kept++] = state.particles[k];
      state.left += fates[k] == Fate::kLeft ? 1 : 0;
      state.swallowed += fates[k] == Fate::kSwallowed ? 1 : 0;
    }
    state.particles.resize(kept);
  }
  return state;
}

}  // namespace elbowroom::review
