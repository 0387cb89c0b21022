// Cloth at rest against the catenary, in motion against energy, and against hulls that come at it.
#include "review/cloth.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/review/curtain.h"
#include "tests/review/sweeping_hand.h"
#include "tests/support/soak.h"

namespace elbowroom::review {
namespace {

using Eigen::Vector3d;
using SharedHull = std::shared_ptr<const recon::VisualHull>;

constexpr double kClothFrameS = 1.0 / 30.0;
// A state's own rounding.
constexpr double kClothRoundingMm = 1e-6;

const SharedHull& NoHull() {
  static const SharedHull hull = HullOf({});
  return hull;
}

ClothState Settled(const ClothPanel& panel, ClothState state, const core::RigidTransform& pose, int frames) {
  for (int i = 0; i < frames; ++i) state = StepCloth(panel, std::move(state), pose, NoHull(), kClothFrameS);
  return state;
}

// No point of the cloth is deeper than stated: the oracle asks points spread over every triangle.
void CheckOutside(const ClothPanel& panel, const ClothState& state, const recon::VisualHull& hull,
                  recon::Random* random, const std::string& where) {
  const core::TriangleMesh mesh = MeshInWorld(panel, state);
  for (const Vector3d& x : mesh.vertices_mm) ASSERT_TRUE(x.allFinite()) << where;
  for (const auto& triangle : mesh.triangles) {
    const bool is_pinned = std::ranges::any_of(triangle, [&](std::int32_t vertex) {
      return panel.inverse_mass_per_kg()[static_cast<std::size_t>(vertex)] <= 0.0;
    });
    if (is_pinned && state.count.blocked > 0) continue;
    for (int i = 0; i < 12; ++i) {
      double u = random->Uniform(0.0, 1.0), v = random->Uniform(0.0, 1.0);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const auto at = [&](std::size_t k) { return mesh.vertices_mm[static_cast<std::size_t>(triangle[k])]; };
      const Vector3d x = (1.0 - u - v) * at(0) + u * at(1) + v * at(2);
      if (!hull.Contains(x)) continue;
      const double depth_mm = hull.Probe(x).radius_mm;
      ASSERT_LE(depth_mm, kClothDepthMm)
          << where << ", " << state.count.blocked << ": too deep at " << x.transpose();
    }
  }
}

// y of a catenary of that length between two points at one height, `span_mm` apart, in its middle.
double CatenarySagMm(double span_mm, double length_mm) {
  double least = 1.0, most = 1e6;  // of a: 2 a sinh(span / 2a) falls with a
  for (int i = 0; i < 200; ++i) {
    const double a = 0.5 * (least + most);
    (2.0 * a * std::sinh(0.5 * span_mm / a) > length_mm ? least : most) = a;
  }
  return least * (std::cosh(0.5 * span_mm / least) - 1.0);
}

TEST(Cloth, AStripHangsAsACatenary) {
  // 600 mm long, both short ends pinned, then brought to a span of 480 mm by pinning it in an arc: the rest
  // shape is the strip bent to a V, whose edges keep their length.
  constexpr int kCells = 24;
  constexpr double kLengthMm = 600.0, kSpanMm = 480.0, kWidthMm = 20.0;
  auto mesh = std::make_shared<core::TriangleMesh>();
  const double drop_mm = std::sqrt(0.25 * (kLengthMm * kLengthMm - kSpanMm * kSpanMm));
  for (int i = 0; i <= kCells; ++i) {
    const double along = static_cast<double>(i) / kCells;
    for (const double y : {0.0, kWidthMm})
      mesh->vertices_mm.emplace_back(kSpanMm * (along - 0.5), y,
                                     -drop_mm * (1.0 - std::abs(2.0 * along - 1.0)));
  }
  for (int i = 0; i < kCells; ++i) {
    mesh->triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    mesh->triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
  }
  core::Part part;
  part.name = "strip";
  part.mesh = mesh;
  part.recovery = {.kind = core::RecoveryKind::kSlider,
                   .reference_in_part_mm = {},
                   .axis_in_part = Vector3d::UnitZ(),
                   .at_in_part_mm = {}};
  part.gives_way = core::ClothRule{.pins = {core::BoundsSide::kXMin, core::BoundsSide::kXMax},
                                   .stretch_stiffness_n_per_m = 1e5,
                                   .bending_stiffness_n_per_m = 1e-3,
                                   .damping_per_s = 3.0};
  const ClothPanel panel(part);
  const core::RigidTransform pose = WorldFromCurtain();
  // Short steps: what one pass over the springs leaves falls with their square (docs/deformables.md).
  constexpr double kShortStepS = 1.0 / 4000.0;
  ClothState state = ClothAtRest(panel, pose);
  for (int i = 0; i < 20000; ++i) state = StepCloth(panel, std::move(state), pose, NoHull(), kShortStepS);
  double length_mm = 0.0;
  for (std::size_t i = 0; i < kCells; ++i)
    length_mm += (state.x_in_world[2 * i + 2] - state.x_in_world[2 * i]).norm();
  // Tension, 1.2 N/m at most, stretches by 1e-5; a chain of 60 links is 1e-4 longer than its chord.
  EXPECT_NEAR(length_mm, kLengthMm, 2e-3 * kLengthMm);
  const double sag_mm = pose.translation_mm.z() - state.x_in_world[kCells].z();
  const double expected_mm = CatenarySagMm(kSpanMm, kLengthMm);
  EXPECT_NEAR(sag_mm, expected_mm, 5e-3 * expected_mm) << "sag against the catenary's";
  EXPECT_GT(std::abs(drop_mm - expected_mm), 3e-2 * expected_mm);  // the test can tell them apart
}

TEST(Cloth, ACurtainHangsWithinTheStretchOfItsWeight) {
  const ClothPanel panel(Curtain());
  const ClothState state = Settled(panel, ClothAtRest(panel, WorldFromCurtain()), WorldFromCurtain(), 150);
  // Its weight, 1.4 N/m under the pins, stretches 2000 N/m by 0.7e-3. What one pass a step leaves is n g h^2
  // = 0.19 mm for the uppermost of n = 18 rows, 0.0096 of its 20 mm (docs/deformables.md), 1.8 mm in all. On
  // the side where no diagonal helps, a fifth more.
  constexpr double kTopRow = 0.0007 + 0.0096, kFreeSide = 1.2;
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_LT((state.x_in_world[i] - state.x_in_world[i + 21]).norm() / 20.0 - 1.0, kTopRow) << i;
  EXPECT_LT(state.count.worst_stretch, kFreeSide * kTopRow);
  EXPECT_NEAR(state.x_in_world.back().z(), 40.0, 2.2);
}

TEST(Cloth, EnergyDoesNotGrowWithoutInput) {
  core::Part part = Curtain();
  std::get<core::ClothRule>(part.gives_way).damping_per_s = 0.0;
  const ClothPanel panel(part);
  ClothState state = ClothAtRest(panel, WorldFromCurtain());
  // Swung out by 45 degrees, from rest.
  for (Vector3d& x : state.x_in_world) {
    const double down_mm = 400.0 - x.z();
    x = {x.x(), std::sqrt(0.5) * down_mm, 400.0 - std::sqrt(0.5) * down_mm};
  }
  const double first_uj = EnergyUj(panel, state);
  // A fiftieth of the energy of the swing: what the springs, which aren't counted, give back.
  const double allowed_uj = 0.02 * panel.mass_kg() * 9806.65 * 180.0 * (1.0 - std::sqrt(0.5));
  double last_uj = first_uj, fastest = 0.0;
  for (int i = 0; i < 150; ++i) {
    state = StepCloth(panel, std::move(state), WorldFromCurtain(), NoHull(), kClothFrameS);
    const double now_uj = EnergyUj(panel, state);
    ASSERT_LE(now_uj, last_uj + allowed_uj) << "frame " << i;
    last_uj = std::min(last_uj, now_uj);
    for (const Vector3d& v : state.velocity_in_world) fastest = std::max(fastest, v.norm());
  }
  EXPECT_LT(last_uj, first_uj);
  EXPECT_GT(fastest, 500.0);  // it did swing
}

// Sweeps a hull through the curtain; afterwards the cloth must be beyond it all.
template <typename ObjectsAt>
void Sweep(const ObjectsAt& objects_at, double speed_mm_per_s, double frame_s, std::uint64_t seed) {
  const ClothPanel panel(Curtain());
  recon::Random random(seed);
  ClothState state = Settled(panel, ClothAtRest(panel, WorldFromCurtain()), WorldFromCurtain(), 10);
  std::int64_t contacts = 0;
  for (double y_mm = -150.0; y_mm < 60.0; y_mm += speed_mm_per_s * frame_s) {
    const SharedHull hull = HullOf(objects_at(y_mm));
    state = StepCloth(panel, std::move(state), WorldFromCurtain(), hull, frame_s);
    contacts += state.count.contacts + state.count.carried;
    CheckOutside(panel, state, *hull, &random, "y = " + std::to_string(y_mm));
    // Nowhere is it behind the hull: along -V_rec from any vertex nothing of the hull is met, but beside it.
    for (const Vector3d& x : state.x_in_world) {
      for (double ahead_mm = 1.0; ahead_mm < 200.0; ahead_mm += 4.0) {
        const Vector3d ahead = x + ahead_mm * Vector3d::UnitY();
        if (!hull->Contains(ahead)) continue;
        ASSERT_LE(hull->Probe(ahead).radius_mm, kClothDepthMm)
            << "passed through at y = " << y_mm << ", vertex " << x.transpose();
      }
    }
  }
  EXPECT_GT(contacts, 0);
}

TEST(Cloth, AHandAtOneMetreASecondNeverPassesThrough) { Sweep(HandAt, 1000.0, kClothFrameS, 1); }
TEST(Cloth, NorDoesItAtFifteenFrames) { Sweep(HandAt, 1000.0, 1.0 / 15.0, 2); }
TEST(Cloth, NorDoesAThinRodBetweenTheVertices) {
  Sweep([](double y_mm) { return RodAt(9.0, y_mm, 212.0); }, 1000.0, kClothFrameS, 3);
}

// Thousands of steps of the solver, hulls that come from nowhere.
TEST(Cloth, RandomHullsNeverBreakIt) {
  const ClothPanel panel(Curtain());
  recon::Random random(4);
  core::RigidTransform pose;
  pose.translation_mm = {0.0, 0.0, 180.0};
  ClothState state = ClothAtRest(panel, pose);
  const int hulls = 25 * test_support::SoakScale();
  for (int i = 0; i < hulls; ++i) {
    const recon::RandomScene scene = recon::MakeRingScene(
        &random, random.Whole(2, 4),
        random.Chance(0.5) ? core::UnseenPolicy::kAbstain : core::UnseenPolicy::kOutside);
    const auto hull =
        std::make_shared<const recon::VisualHull>(recon::MakeVisualHull(scene.rig, scene.masks));
    const double frame_s = random.LogUniform(0.005, 0.2);
    for (int k = 0; k < 4; ++k) {
      state = StepCloth(panel, std::move(state), pose, hull, frame_s);
      for (const Vector3d& x : state.x_in_world) ASSERT_TRUE(x.allFinite()) << i;
      CheckOutside(panel, state, *hull, &random, std::to_string(i));
      if (HasFatalFailure()) return;
    }
  }
}

// Fingers, a thumb and a pipe that a curtain can hang on behind.
TEST(Cloth, WhatIsCaughtLetsGo) {
  const ClothPanel panel(Curtain());
  const std::vector<SharedHull> hulls = PokingHand(12);
  const core::RigidTransform pose = core::FromPositionAndRollPitchYaw({-70.0, 0.0, 420.0}, {0.0, 0.0, 90.0});
  ClothState state = ClothAtRest(panel, pose);
  recon::Random random(5);
  std::int64_t contacts = 0;
  for (std::size_t frame = 0; frame < 120 * static_cast<std::size_t>(test_support::SoakScale()); ++frame) {
    const SharedHull& hull = hulls[frame % hulls.size()];
    state = StepCloth(panel, std::move(state), pose, hull, kClothFrameS);
    ASSERT_LT(state.count.worst_stretch, 2.0) << frame;
    CheckOutside(panel, state, *hull, &random, std::to_string(frame));
    if (HasFatalFailure()) return;
    contacts += state.count.contacts;
  }
  EXPECT_GT(contacts, 1000);
}

TEST(Cloth, ThreadsChangeNothing) {
  const ClothPanel panel(Curtain());
  const SharedHull far = HullOf(HandAt(-60.0)), near = HullOf(HandAt(-10.0));
  const auto run = [&](int threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    std::vector<ClothState> states(4, ClothAtRest(panel, WorldFromCurtain()));
    tbb::parallel_for(std::size_t{0}, states.size(), [&](std::size_t i) {
      for (const SharedHull& hull : {far, near, far})
        states[i] = StepCloth(panel, std::move(states[i]), WorldFromCurtain(), hull, kClothFrameS);
    });
    return states;
  };
  const std::vector<ClothState> one = run(1), two = run(2);
  for (const std::vector<ClothState>& states : {one, two})
    for (const ClothState& state : states) {
      EXPECT_EQ(state.x_in_world, one.front().x_in_world);
      EXPECT_EQ(state.velocity_in_world, one.front().velocity_in_world);
    }
}

TEST(Cloth, SaysWhatIsWrong) {
  core::Part part = Curtain();
  std::get<core::ClothRule>(part.gives_way).pins = {core::BoundsSide::kYMin};  // it is flat: all of it
  EXPECT_THROW(ClothPanel{part}, core::Error);
  const ClothPanel panel(Curtain());
  const ClothState state = ClothAtRest(panel, {});
  EXPECT_THROW((void)StepCloth(panel, state, {}, NoHull(), 0.0), core::PreconditionError);
  EXPECT_THROW((void)StepCloth(panel, ClothState{}, {}, NoHull(), kClothFrameS), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::review
