// An answer "outside" or "inside" of a ball, a box or a triangle is never contradicted by any point of it:
// docs/algorithms.md, sampled.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kScenes = 200;
constexpr int kBallsPerScene = 500;
// Sampled points stay inside the closed ball whatever the rounding of their own coordinates.
constexpr double kInsideBall = 1.0 - 1e-12;

Vector3d InWorld(const core::CameraModel& camera, const Vector3d& x_in_cam) {
  return camera.cam_from_world().Inverse() * x_in_cam;
}

// A point that projects near a change of the mask, or about anywhere in and around the picture.
std::optional<Vector3d> NearPicture(Random* random, const core::CameraModel& camera,
                                    const core::BitMask& mask) {
  Vector2d pixel(random->Uniform(-1.0, 2.0) * mask.width_px(), random->Uniform(-1.0, 2.0) * mask.height_px());
  for (int tries = 0; tries < 20 && random->Chance(0.9); ++tries) {
    const int x = random->Whole(0, mask.width_px() - 1), y = random->Whole(0, mask.height_px() - 1);
    const bool at_border = x == 0 || y == 0 || x == mask.width_px() - 1 || y == mask.height_px() - 1;
    const bool changes = x > 0 && mask.At(x - 1, y) != mask.At(x, y);
    if (!at_border && !changes) continue;
    const double jitter_px = random->LogUniform(1e-8, 3.0);
    pixel = Vector2d(x - 0.5, y + random->Uniform(-0.5, 0.5)) + jitter_px * random->Direction().head<2>();
    break;
  }
  const std::optional<Vector2d> normalised = camera.NormalisedFromPixel(pixel);
  if (!normalised) return std::nullopt;
  const double depth_mm = random->LogUniform(0.01, 4.0) * camera.center_in_world().norm();
  return InWorld(camera, depth_mm * normalised->homogeneous());
}

Vector3d NearDomainRim(Random* random, const core::CameraModel& camera) {
  const double off = random->LogUniform(1e-9, 0.5) * (random->Chance(0.5) ? 1.0 : -1.0);
  const double angle_rad = random->Uniform(0.0, 2.0 * M_PI);
  const Vector2d normalised =
      camera.max_radius() * (1.0 + off) * Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  return InWorld(camera, random->LogUniform(1e-3, 2e3) * normalised.homogeneous());
}

Vector3d NearCameraPlane(Random* random, const core::CameraModel& camera) {
  const double side_mm = random->LogUniform(1e-4, 1e3);
  Vector3d x_in_cam = side_mm * random->Direction();
  x_in_cam.z() = random->LogUniform(1e-6, 1e3) * (random->Chance(0.5) ? 1.0 : -1.0);
  return InWorld(camera, x_in_cam);
}

Vector3d NearWorkspaceFace(Random* random, const Eigen::AlignedBox3d& workspace_mm) {
  Vector3d x = random->PointIn(workspace_mm);
  const int axis = random->Whole(0, 2);
  x[axis] = (random->Chance(0.5) ? workspace_mm.min() : workspace_mm.max())[axis];
  return x + random->LogUniform(1e-9, 10.0) * random->Direction();
}

Vector3d RandomCenter(Random* random, const RandomScene& scene) {
  const Eigen::AlignedBox3d& workspace_mm = scene.rig->workspace_mm;
  const int i = random->Whole(0, static_cast<int>(scene.rig->cameras.size()) - 1);
  const core::CameraModel& camera = scene.rig->cameras[static_cast<std::size_t>(i)];
  switch (random->Whole(0, 9)) {
    case 0:
      return NearDomainRim(random, camera);
    case 1:
      return NearCameraPlane(random, camera);
    case 2:
      return camera.center_in_world() + random->LogUniform(1e-6, 1e2) * random->Direction();
    case 3:
      return NearWorkspaceFace(random, workspace_mm);
    case 4:
    case 5:
      return 1.5 * random->PointIn(workspace_mm);
    default:
      return NearPicture(random, camera, scene.masks[static_cast<std::size_t>(i)])
          .value_or(random->PointIn(workspace_mm));
  }
}

// Directions in which a ball's projection spreads farthest: across the line of sight towards each side of the
// picture, tilted towards the camera and away from it, and along the axes that bound the workspace.
std::vector<Vector3d> AdversarialDirections(const core::Rig& rig, const Vector3d& center) {
  std::vector<Vector3d> directions;
  for (int axis = 0; axis < 3; ++axis) {
    directions.push_back(Vector3d::Unit(axis));
    directions.push_back(-Vector3d::Unit(axis));
  }
  for (const core::CameraModel& camera : rig.cameras) {
    const Vector3d x_in_cam = camera.cam_from_world() * center;
    const Vector3d toward = -x_in_cam.normalized();
    const Vector2d c = x_in_cam.head<2>() / x_in_cam.z();
    for (int i = 0; i < 8; ++i) {
      const Vector2d u(std::cos(i * M_PI / 4), std::sin(i * M_PI / 4));
      const Vector3d across = Vector3d(u.x(), u.y(), -c.dot(u)).normalized();
      for (const double tilt : {0.0, 0.7}) {
        const Vector3d d =
            camera.cam_from_world().rotation.transpose() * (across + tilt * toward).normalized();
        if (d.allFinite()) directions.push_back(d);
      }
    }
    directions.push_back(camera.cam_from_world().rotation.transpose() * toward);
  }
  return directions;
}

// Points of the closed ball: its centre, extremes, random ones of its surface and inside.
std::vector<Vector3d> SampleBall(Random* random, const core::Rig& rig, const Vector3d& center,
                                 double radius_mm) {
  std::vector<Vector3d> samples = {center};
  const double reach_mm = radius_mm * kInsideBall;
  for (const Vector3d& direction : AdversarialDirections(rig, center))
    samples.push_back(center + reach_mm * direction);
  for (int i = 0; i < 8; ++i) {
    samples.push_back(center + reach_mm * random->Direction());
    samples.push_back(center + reach_mm * std::cbrt(random->Uniform(0.0, 1.0)) * random->Direction());
  }
  return samples;
}

struct Census {
  int balls = 0;
  int certified = 0;       // Classify said outside or inside
  int inside = 0;          // ... inside
  int agreeing = 0;        // ordinary balls whose samples all agree
  int agreeing_mixed = 0;  // ... yet called mixed
};

// The number of samples that say otherwise.
int Contradictions(const VisualHull& hull, const std::vector<Vector3d>& samples, bool is_inside) {
  return static_cast<int>(
      std::ranges::count_if(samples, [&](const Vector3d& x) { return hull.Contains(x) != is_inside; }));
}

void CheckBall(Random* random, const VisualHull& hull, const Vector3d& center, double radius_mm,
               Census* census) {
  const std::vector<Vector3d> samples = SampleBall(random, hull.rig(), center, radius_mm);
  const BallAnswer answer = hull.Classify(center, radius_mm);
  const int inside = Contradictions(hull, samples, false);
  const auto all = static_cast<int>(samples.size());
  ++census->balls;
  if (answer != BallAnswer::kMixed) ++census->certified;
  if (answer == BallAnswer::kOutside) {
    ASSERT_EQ(inside, 0) << center.transpose() << " r " << radius_mm;
  } else if (answer == BallAnswer::kInside) {
    ++census->inside;
    ASSERT_EQ(inside, all) << center.transpose() << " r " << radius_mm;
  }
  if (inside == 0 || inside == all) {
    ++census->agreeing;
    if (answer == BallAnswer::kMixed) ++census->agreeing_mixed;
  }
}

void CheckProbe(Random* random, const VisualHull& hull, const Vector3d& center) {
  const PointAnswer answer = hull.Probe(center);
  ASSERT_EQ(answer.is_inside, hull.Contains(center)) << center.transpose();
  ASSERT_GE(answer.radius_mm, 0.0) << center.transpose();
  ASSERT_EQ(hull.Classify(center, 0.0), answer.is_inside ? BallAnswer::kInside : BallAnswer::kOutside);
  const double radius_mm = std::min(answer.radius_mm, 1e5);
  const std::vector<Vector3d> samples = SampleBall(random, hull.rig(), center, radius_mm);
  ASSERT_EQ(Contradictions(hull, samples, answer.is_inside), 0)
      << center.transpose() << " probe " << answer.radius_mm << " inside " << answer.is_inside;
}

TEST(BallQuery, NoSampledPointContradictsACertifiedAnswer) {
  Random random(2001);
  Census census;
  for (int trial = 0; trial < kScenes * test_support::SoakScale(); ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (int i = 0; i < kBallsPerScene / 2; ++i) {
      const Vector3d center = RandomCenter(&random, scene);
      CheckProbe(&random, hull, center);
      CheckBall(&random, hull, center, random.LogUniform(1e-4, 1e3), &census);
      if (HasFatalFailure()) FAIL() << "scene " << trial;
    }
  }
  // The test asks something: a fair share of certified answers, of both kinds.
  EXPECT_GT(census.certified, census.balls / 4);
  EXPECT_GT(census.inside, census.balls / 200);
}

// Flat, long and cubic boxes, turned any way; triangles, needles, and such without area.
WorldShape RandomShape(Random* random, const Vector3d& at) {
  const double size_mm = random->LogUniform(1e-4, 1e3);
  const double thin = random->LogUniform(1e-4, 1.0), thinner = random->LogUniform(1e-4, 1.0);
  if (random->Chance(0.5))
    return WorldShape::Box(at, random->Rotation() * (size_mm * Vector3d(1.0, thin, thinner)).asDiagonal());
  const Vector3d b = at + size_mm * random->Direction();
  const Vector3d c = at + random->Uniform(-0.5, 1.5) * (b - at) + size_mm * thin * random->Direction();
  return WorldShape::Triangle(at, b, random->Chance(0.05) ? b : c);
}

// Corners and what lies between; a hair inside.
std::vector<Vector3d> SampleShape(Random* random, const WorldShape& shape) {
  std::vector<Vector3d> samples;
  const Vector3d middle =
      shape.kind == WorldShape::Kind::kBox ? Vector3d::Zero() : Vector3d(1.0 / 3.0, 1.0 / 3.0, 0.0);
  for (int i = 0; i < 40; ++i) {
    Vector3d at;
    if (shape.kind == WorldShape::Kind::kBox) {
      at = Vector3d(random->Uniform(-1.0, 1.0), random->Uniform(-1.0, 1.0), random->Uniform(-1.0, 1.0));
      if (i < 8) at = Vector3d((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
      if (i >= 8 && i < 20) at[i % 3] = at[i % 3] < 0.0 ? -1.0 : 1.0;
    } else {
      const double x = random->Uniform(0.0, 1.0), y = random->Uniform(0.0, 1.0 - x);
      at = i < 3 ? Vector3d(i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0, 0.0) : Vector3d(x, y, 0.0);
    }
    samples.emplace_back(shape.origin + shape.edges * (middle + kInsideBall * (at - middle)));
  }
  return samples;
}

TEST(ShapeQuery, NoSampledPointContradictsACertifiedAnswer) {
  Random random(2006);
  Census census;
  int where_balls_are_mixed = 0;
  for (int trial = 0; trial < kScenes * test_support::SoakScale(); ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (int i = 0; i < kBallsPerScene / 2; ++i) {
      const WorldShape shape = RandomShape(&random, RandomCenter(&random, scene));
      const std::vector<Vector3d> samples = SampleShape(&random, shape);
      UndecidedCameras open;
      const BallAnswer answer = hull.Classify(shape, &open);
      ++census.balls;
      if (answer == BallAnswer::kMixed) continue;
      ++census.certified;
      census.inside += answer == BallAnswer::kInside ? 1 : 0;
      const Eigen::AlignedBox3d bounds = shape.Bounds();
      where_balls_are_mixed +=
          hull.Classify(bounds.center(), 0.5 * bounds.diagonal().norm()) == BallAnswer::kMixed ? 1 : 0;
      ASSERT_EQ(Contradictions(hull, samples, answer == BallAnswer::kInside), 0)
          << "scene " << trial << ": " << shape.origin.transpose() << "\n"
          << shape.edges;
    }
  }
  EXPECT_GT(census.certified, census.balls / 4);
  EXPECT_GT(census.inside, census.balls / 400);
  EXPECT_GT(where_balls_are_mixed, census.certified / 50);
}

// A camera that a shape closes has nothing to say of any point of it.
TEST(ShapeQuery, ClosedCamerasCallAllOfItObject) {
  Random random(2007);
  int closed = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    for (int i = 0; i < 100; ++i) {
      const WorldShape shape = RandomShape(&random, RandomCenter(&random, scene));
      UndecidedCameras open;
      if (hull.Classify(shape, &open) == BallAnswer::kOutside) continue;
      for (const Vector3d& x : SampleShape(&random, shape)) {
        UndecidedCameras all;
        all.asks_visibility = open.asks_visibility;
        ASSERT_EQ(hull.Contains(x, open), hull.Contains(x, all));
      }
      closed += open.bits != ~std::uint64_t{0} ? 1 : 0;
    }
  }
  EXPECT_GT(closed, 500);
}

TEST(BallQuery, MixedIsRarelySaidOfABallThatAgrees) {
  // Of ordinary balls about an ordinary rig; measured: 0.028 under `outside`, 0.048 under `abstain`.
  constexpr double kLargestShare = 0.08;
  Random random(2002);
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    Census census;
    for (int trial = 0; trial < 30; ++trial) {
      const RandomScene scene = MakeRingScene(&random, random.Whole(2, 6), unseen);
      const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
      for (int i = 0; i < 300; ++i)
        CheckBall(&random, hull, random.PointIn(scene.rig->workspace_mm), random.LogUniform(0.5, 50.0),
                  &census);
    }
    const double share = static_cast<double>(census.agreeing_mixed) / census.agreeing;
    EXPECT_LT(share, kLargestShare) << census.agreeing << " of " << census.balls << " balls agree";
  }
}

TEST(BallQuery, WhatMayNotBeDeeperIsNot) {
  Random random(2007);
  int deeper = 0, shallower = 0, said_so = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, random.Whole(2, 6), unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    core::CameraIndex likely = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vector3d x = random.PointIn(scene.rig->workspace_mm);
      const PointAnswer answer = hull.Probe(x);
      if (!answer.is_inside) continue;
      const double asked_mm = answer.radius_mm * (random.Chance(0.5) ? 1.0 - random.LogUniform(1e-12, 0.9)
                                                                     : 1.0 + random.LogUniform(1e-6, 2.0));
      const bool may_be = hull.MayBeDeeper(x, asked_mm, &likely);
      if (answer.radius_mm > asked_mm) {
        ++deeper;
        ASSERT_TRUE(may_be) << answer.radius_mm << " mm, asked " << asked_mm;
      } else {
        ++shallower;
        said_so += may_be ? 0 : 1;
      }
    }
  }
  EXPECT_GT(deeper, 1000);
  EXPECT_GT(shallower, 100);
  EXPECT_GT(said_so, shallower / 2);  // else it saves nothing
}

// Balls that hold a point of known depth, many of them at their rims.
TEST(BallQuery, ABallThatMayHoldNothingDeeperHoldsNothingDeeper) {
  Random random(2009);
  int deeper = 0, shallower = 0, said_so = 0;
  for (int trial = 0; trial < 40 * test_support::SoakScale(); ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, random.Whole(2, 6), unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    core::CameraIndex likely = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vector3d x = random.PointIn(scene.rig->workspace_mm);
      const PointAnswer answer = hull.Probe(x);
      const double radius_mm = random.LogUniform(0.01, 60.0);
      if (!answer.is_inside) continue;
      const double share = random.Chance(0.5) ? 1.0 - 1e-12 : random.Uniform(0.0, 1.0);
      const Vector3d center = x + share * radius_mm * random.Direction();
      const double asked_mm = answer.radius_mm * (1.0 - random.LogUniform(1e-12, 0.9));
      ++deeper;
      ASSERT_TRUE(hull.MayHoldDeeper(center, radius_mm, asked_mm, &likely))
          << "a point " << answer.radius_mm << " mm deep, asked " << asked_mm << ", ball of " << radius_mm;
      ++shallower;
      said_so += hull.MayHoldDeeper(x, radius_mm, 2.0 * answer.radius_mm + radius_mm, &likely) ? 0 : 1;
    }
  }
  EXPECT_GT(deeper, 1000);
  EXPECT_GT(said_so, shallower / 2);  // else it saves nothing
}

TEST(BallQuery, HullShrinksWhenACameraIsAdded) {
  Random random(2003);
  for (int trial = 0; trial < 60; ++trial) {
    RandomScene scene = MakeRandomScene(&random);
    core::Rig rig = *scene.rig;
    rig.unseen = core::UnseenPolicy::kOutside;  // under `abstain` a new camera may be the first witness
    const VisualHull before = MakeVisualHull(std::make_shared<const core::Rig>(rig), scene.masks);
    rig.cameras.push_back(RandomCamera(&random, static_cast<LensKind>(random.Whole(0, kLensKinds - 1))));
    scene.masks.push_back(RandomMask(&random, rig.cameras.back().width_px(), rig.cameras.back().height_px()));
    const VisualHull after = MakeVisualHull(std::make_shared<const core::Rig>(rig), scene.masks);
    for (int i = 0; i < 500; ++i) {
      const Vector3d x = RandomCenter(&random, scene);
      const double radius_mm = random.LogUniform(1e-3, 1e2);
      EXPECT_TRUE(before.Contains(x) || !after.Contains(x));
      const BallAnswer was = before.Classify(x, radius_mm), is = after.Classify(x, radius_mm);
      EXPECT_TRUE(was != BallAnswer::kOutside || is == BallAnswer::kOutside);
      EXPECT_TRUE(is != BallAnswer::kInside || was == BallAnswer::kInside);
    }
  }
}

TEST(BallQuery, MovingRigAndPointsTogetherChangesNothing) {
  // Coordinates up to 1e5 mm carry 1e-11 mm of rounding; a point nearer than this to a change may flip.
  constexpr double kRoundingBandMm = 1e-6;
  Random random(2004);
  int asked = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    core::Rig rig = *scene.rig;
    rig.workspace_mm = {Vector3d::Constant(-1e7), Vector3d::Constant(1e7)};  // a box doesn't turn
    const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), scene.masks);
    const core::RigidTransform moved_from_world{random.Rotation(), 3000.0 * random.Direction()};
    core::Rig moved = rig;
    moved.cameras.clear();
    for (const core::CameraModel& camera : rig.cameras) {
      core::CameraCalibration calibration = camera.calibration();
      calibration.cam_from_world = calibration.cam_from_world * moved_from_world.Inverse();
      moved.cameras.emplace_back(std::move(calibration));
    }
    const VisualHull moved_hull = MakeVisualHull(std::make_shared<const core::Rig>(moved), scene.masks);
    for (int i = 0; i < 300; ++i) {
      const Vector3d x = RandomCenter(&random, scene);
      const PointAnswer here = hull.Probe(x), there = moved_hull.Probe(moved_from_world * x);
      if (here.radius_mm < kRoundingBandMm) continue;
      ++asked;
      ASSERT_EQ(here.is_inside, there.is_inside) << x.transpose();
    }
  }
  EXPECT_GT(asked, 10'000);
}

TEST(BallQuery, ThePicturesBorderBelongsToTheSameSideForPointAndBall) {
  // A pinhole whose border falls on round numbers: positions exactly on the contour.
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    core::Rig rig;
    rig.workspace_mm = {Vector3d::Constant(-100), Vector3d::Constant(100)};
    rig.unseen = unseen;
    core::CameraCalibration c;
    c.image_width_px = c.image_height_px = 8;
    c.camera_matrix << 64.0, 0.0, 3.5, 0.0, 64.0, 3.5, 0.0, 0.0, 1.0;
    c.cam_from_world.translation_mm.z() = 64.0;
    rig.cameras.emplace_back(c);
    core::BitMask mask(8, 8);
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) mask.Set(x, y, true);
    }
    const std::array masks{mask};
    const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), masks);
    Random random(2005);
    for (int x = -5; x <= 5; ++x) {
      for (int y = -5; y <= 5; ++y) CheckProbe(&random, hull, Vector3d(x, y, 0.0));
    }
  }
}

}  // namespace
}  // namespace elbowroom::recon
