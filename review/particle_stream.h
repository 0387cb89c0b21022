// Particles that leave a place, fall, and run off what is real or virtual: the paper's faucet.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bvh.h"
#include "core/layout.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {

inline constexpr std::size_t kMostParticles = 2000;  // of a stream at a time; then it waits
// Particles keep this far from parts; their middles never enter the hull.
inline constexpr double kParticleGapMm = 0.05;

struct Particle {
  Eigen::Vector3d x_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_world = Eigen::Vector3d::Zero();  // mm/s
};

// emitted = particles + left + swallowed, always.
struct StreamState {
  std::vector<Particle> particles;  // in the order of their emission
  double due = 0.0;                 // share of the next particle
  std::int64_t emitted = 0;
  std::int64_t left = 0;       // the workspace
  std::int64_t swallowed = 0;  // the hull or a part came over them so that no way out was near
};

// A part that particles meet.
struct StreamObstacle {
  const core::TriangleTree* part = nullptr;
  core::RigidTransform world_from_part;
};

// The state `dt_s` later. A particle's middle moves no farther than what is free around it, by the hull's
// ball query and the distance to the parts, so nothing thick is passed; where it touches it loses its speed
// across the surface, and keeps most of that along it. Afterwards none is in the hull, nearer to a part's
// surface than kParticleGapMm, or in a closed part (particle_stream_test). The jitter of the jet follows the
// count alone: the same frames give the same particles for any number of threads. Throws: PreconditionError
// for a dt_s that isn't within (0, 1] s. Thread: any.
[[nodiscard]] StreamState StepStream(const core::Stream& stream, StreamState state,
                                     const recon::VisualHull& hull, std::span<const StreamObstacle> obstacles,
                                     double dt_s);

}  // namespace elbowroom::review
