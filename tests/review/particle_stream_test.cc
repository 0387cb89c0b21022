// A stream against what it falls on.
#include "review/particle_stream.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/part_distance.h"
#include "recon/hull/visual_hull.h"
#include "review/inside_cells.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/sweeping_hand.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;

constexpr double kStreamFrameS = 1.0 / 30.0;

core::Stream Faucet() {
  core::Stream stream;
  stream.name = "faucet";
  stream.position_mm = {30.0, 0.0, 420.0};
  return stream;
}

core::TriangleTree BoxTree(const Vector3d& size_mm) {
  return core::TriangleTree(std::make_shared<const core::TriangleMesh>(core::testing::Box(size_mm)));
}

// Every particle is accounted for and where it may be.
void Check(const StreamState& state, const recon::VisualHull& hull,
           std::span<const StreamObstacle> obstacles) {
  ASSERT_EQ(state.emitted, static_cast<std::int64_t>(state.particles.size()) + state.left + state.swallowed);
  ASSERT_LE(state.particles.size(), kMostParticles);
  for (const Particle& particle : state.particles) {
    ASSERT_TRUE(particle.x_in_world.allFinite() && particle.velocity_in_world.allFinite());
    ASSERT_FALSE(hull.Contains(particle.x_in_world)) << particle.x_in_world.transpose();
    ASSERT_TRUE(hull.rig().workspace_mm.contains(particle.x_in_world));
    for (const StreamObstacle& obstacle : obstacles) {
      const Vector3d x_in_part = obstacle.world_from_part.Inverse() * particle.x_in_world;
      ASSERT_GE(FindNearest(*obstacle.part, {.center = x_in_part}).distance_mm, 0.5 * kParticleGapMm);
      ASSERT_FALSE(obstacle.part->is_closed() && IsInsideClosedMesh(*obstacle.part, x_in_part));
    }
  }
}

TEST(ParticleStream, FallsFreelyAsGalileoSays) {
  const auto nothing = HullOf({});
  core::Stream stream = Faucet();
  stream.rate_per_s = 60.0;
  StreamState state;
  for (int i = 0; i < 5; ++i) state = StepStream(stream, std::move(state), *nothing, {}, kStreamFrameS);
  ASSERT_EQ(state.emitted, 10);
  // The first has fallen for 5 frames less the time to its emission, 1/60 s; steps of 1/240 s err by one
  // step.
  const double fell_s = 5.0 * kStreamFrameS - 1.0 / 60.0;
  const double fell_mm = 500.0 * fell_s + 0.5 * 9806.65 * fell_s * fell_s;
  EXPECT_NEAR(420.0 - state.particles.front().x_in_world.z(), fell_mm, 12.0);
}

TEST(ParticleStream, IsDeflectedByAHandAndByAPart) {
  const auto nothing = HullOf({}), hand = HullOf(HandAt(0.0));
  const core::TriangleTree box = BoxTree({300.0, 300.0, 40.0});
  core::RigidTransform world_from_box;
  world_from_box.translation_mm = {-150.0, -150.0, 10.0};
  const std::vector<StreamObstacle> obstacles{{&box, world_from_box}};
  StreamState free, deflected;
  for (int i = 0; i < 90; ++i) {
    free = StepStream(Faucet(), std::move(free), *nothing, {}, kStreamFrameS);
    deflected = StepStream(Faucet(), std::move(deflected), *hand, obstacles, kStreamFrameS);
    Check(deflected, *hand, obstacles);
  }
  const auto farthest = [](const StreamState& state) {
    double farthest_mm = 0.0;
    for (const Particle& p : state.particles)
      farthest_mm = std::max(farthest_mm, (p.x_in_world - Faucet().position_mm).head<2>().norm());
    return farthest_mm;
  };
  EXPECT_LT(farthest(free), 30.0);
  EXPECT_GT(farthest(deflected), 50.0);
  EXPECT_GT(deflected.particles.size(), free.particles.size());  // they lie on the box for a while
}

TEST(ParticleStream, AMovingHandSwallowsNoneUnnoticed) {
  std::vector<std::shared_ptr<const recon::VisualHull>> hulls;
  for (const double y_mm : {-60.0, -27.0, 6.0, 39.0, 72.0}) hulls.push_back(HullOf(HandAt(y_mm)));
  StreamState state;
  for (std::size_t i = 0; i < 60; ++i) {
    const recon::VisualHull& hull = *hulls[i % hulls.size()];
    state = StepStream(Faucet(), std::move(state), hull, {}, kStreamFrameS);
    Check(state, hull, {});
  }
}

TEST(ParticleStream, RandomHullsNeverBreakItAndItsNumberIsBounded) {
  recon::Random random(7);
  core::Stream stream = Faucet();
  stream.position_mm = {0.0, 0.0, 150.0};
  stream.rate_per_s = 10000.0;
  stream.speed_mm_per_s = 0.0;
  const core::TriangleTree box = BoxTree({120.0, 120.0, 30.0});
  StreamState state;
  const int hulls = 12 * test_support::SoakScale();
  for (int i = 0; i < hulls; ++i) {
    const recon::RandomScene scene = recon::MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
    const recon::VisualHull hull = recon::MakeVisualHull(scene.rig, scene.masks);
    core::RigidTransform world_from_box{random.Rotation(), Vector3d(-60.0, -60.0, -40.0)};
    const std::vector<StreamObstacle> obstacles{{&box, world_from_box}};
    state = StepStream(stream, std::move(state), hull, obstacles, kStreamFrameS);
    Check(state, hull, obstacles);
  }
  EXPECT_GT(state.emitted, 1000);
}

TEST(ParticleStream, ThreadsChangeNothing) {
  const auto hand = HullOf(HandAt(0.0));
  const auto run = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    StreamState state;
    for (int i = 0; i < 30; ++i) state = StepStream(Faucet(), std::move(state), *hand, {}, kStreamFrameS);
    return state;
  };
  const StreamState one = run(1), two = run(2);
  ASSERT_EQ(one.particles.size(), two.particles.size());
  for (std::size_t i = 0; i < one.particles.size(); ++i)
    EXPECT_EQ(one.particles[i].x_in_world, two.particles[i].x_in_world);
}

}  // namespace
}  // namespace elbowroom::review
