// Particles that leave a place, fall, and run off the hull and the parts: the paper's faucet.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bvh.h"
#include "core/layout.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::review {

inline constexpr std::size_t kMostParticles = 2000;  // of a stream at a time; then it waits
// Particles' centres keep this far from parts. From the hull they keep no distance, but don't enter it.
inline constexpr double kParticleGapMm = 0.05;

struct Particle {
  Eigen::Vector3d x_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_in_world = Eigen::Vector3d::Zero();  // mm/s
};

// Always emitted = particles.size() + left + swallowed.
struct StreamState {
  std::vector<Particle> particles;  // in the order of their emission
  double due = 0.0;                 // fraction of the next particle to be emitted
  std::int64_t emitted = 0;
  std::int64_t left = 0;       // have left the workspace
  std::int64_t swallowed = 0;  // taken away: the hull came over them without a near way out, or a part did
};

// A part that particles meet.
struct StreamObstacle {
  const core::TriangleTree* part = nullptr;
  core::RigidTransform world_from_part;
};

// The state `dt_s` later. A particle's centre moves only through the room that the hull's ball query and the
// distance to the parts show to be free, so it passes through nothing thick. Where it touches, it loses
// its speed into the surface, and keeps most of its speed along it. Afterwards no particle is in the hull,
// nearer to a part's surface than kParticleGapMm, or in a closed part (particle_stream_test). The jet's
// jitter depends only on the particle's number: the same frames give the same particles for any number of
// threads. Throws: PreconditionError for a dt_s that isn't within (0, 1] s. Thread: any.
[[nodiscard]] StreamState StepStream(const core::Stream& stream, StreamState state,
                                     const recon::VisualHull& hull, std::span<const StreamObstacle> obstacles,
                                     double dt_s);

}  // namespace elbowroom::review
