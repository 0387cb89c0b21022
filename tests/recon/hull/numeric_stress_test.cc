// Every query of the hull at the ends of what numbers can do, held to long double (docs/accuracy.md,
// "Numerical stability").
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/triangle_mesh.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"
#include "tests/recon/hull/stress_scene.h"
#include "tests/recon/hull/sure_hull.h"
#include "tests/recon/scenes/sweep_oracle.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;
using oracles::Vector3L;

// What is promised. Of double precision, in half units in the last place of the largest number used: the
// chain from a world point to a label is some ten operations long.
constexpr double kRoundings = 4.0;
// Of single precision in a view, in half units in the last place of the distance from the view.
constexpr double kViewRoundings = 4.0;
// An edge that is straight in the picture plane is less than that beside one that is straight through the
// lens.
constexpr double kLensPx = 1e-3;
// A ray that passes a camera's centre nearer than this, as a share of how far away it starts, goes through.
constexpr double kThroughCentre = 1e-11;
// A view whose epipole is on a contour turns that camera: by 8 times 1e-10 at most.
constexpr double kTurnRad = 8e-10;
// Vertices keep this share of an edge away from its ends.
constexpr double kVertexShare = 1.0 / 1024.0;

// Denormals round by an absolute amount, so what is nearer than that is the same place;
constexpr double kLeastMm = 1e-300;
// in a view, where keys are -1 / mm in float32, anything nearer than that.
constexpr double kLeastViewMm = 1e-20;
// A camera less than 1e-12 mm along each axis from a perspective view's centre is taken to be at it.
constexpr double kConcentricMm = 2e-12;

constexpr int kScenes = 12;  // of each kind and query, in the ordinary run

class Stress : public testing::TestWithParam<int> {
 protected:
  // Calls check(random, scene, hull) for every scene of the kind.
  template <typename Check>
  void ForEachScene(int query, int scenes, const Check& check) {
    const auto kind = static_cast<StressKind>(GetParam());
    for (int i = 0; i < scenes * test_support::SoakScale() && !HasFailure(); ++i) {
      const int seed = 7'000'000 + query * 1'000'000 + GetParam() * 50'000 + i;
      Random random(static_cast<std::uint64_t>(seed));
      const StressScene scene = MakeStressScene(&random, kind);
      const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
      sure_ = std::make_unique<const SureHull>(*scene.rig, scene.masks);
      check(&random, scene, hull);
      if (HasFailure()) std::cout << ToString(kind) << " " << i << "\n";
    }
    std::cout << ToString(kind) << ": " << claims_ << " claims, " << inside_ << " of inside; " << share_
              << " of the bound used\n";
    EXPECT_GT(claims_, 0);
  }

  // That the hull has, or hasn't, this point; wrong only if no point within `error` agrees.
  void Claim(bool is_inside, const Vector3L& x_in_world, const StressError& error) {
    ++claims_;
    if (is_inside) ++inside_;
    const Sure opposite = is_inside ? Sure::kNo : Sure::kYes;
    if (sure_->Contains(x_in_world, error.Times(0.0)) != opposite) return;
    double low = 0.0, high = 4.0;
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (low + high);
      (sure_->Contains(x_in_world, error.Times(middle)) == opposite ? low : high) = middle;
    }
    share_ = std::max(share_, high);
    EXPECT_LE(low, 1.0) << "said " << (is_inside ? "inside" : "outside") << ": " << x_in_world.transpose();
  }

  // That the picture's depths are right, of pixels here and there.
  void ClaimPicture(Random* random, const StressScene& scene, const VisualHull& hull, const ViewRays& rays);

 private:
  void ClaimPixel(const StressScene& scene, const VisualHull& hull, const ViewRays& rays,
                  const HullView& view, int x, int y, bool may_start_inside);

  std::unique_ptr<const SureHull> sure_;
  std::int64_t claims_ = 0;
  std::int64_t inside_ = 0;
  double share_ = 0.0;  // of the stated bound, at most
};

Vector3d PointAbout(Random* random, const StressScene& scene) {
  const double reach = random->Chance(0.1) ? random->LogUniform(1e-9, 1e3) : random->Uniform(0.0, 1.2);
  Vector3d x = scene.middle_in_world + reach * scene.size_mm * random->Direction();
  if (random->Chance(0.05)) x[random->Whole(0, 2)] = random->Chance(0.5) ? -0.0 : 5e-324;
  return x;
}

// Points of the double grid, neighbours or nearly so, between which Contains() changes; the points
// themselves if it doesn't.
std::pair<Vector3d, Vector3d> Change(const VisualHull& hull, Vector3d a, Vector3d b) {
  const bool label = hull.Contains(a);
  if (hull.Contains(b) == label) return {a, b};
  for (int i = 0; i < 60; ++i) {
    const Vector3d middle = a + 0.5 * (b - a);
    (hull.Contains(middle) == label ? a : b) = middle;
  }
  return {a, b};
}

constexpr StressError kOfPoints{kLeastMm, kRoundings, kLensPx};

TEST_P(Stress, PointsAreThoseOfLongDouble) {
  ForEachScene(0, kScenes, [&](Random* random, const StressScene& scene, const VisualHull& hull) {
    for (int i = 0; i < 60; ++i) {
      const auto [a, b] = Change(hull, PointAbout(random, scene), PointAbout(random, scene));
      for (const Vector3d& x : {a, b}) Claim(hull.Contains(x), x.cast<long double>(), kOfPoints);
    }
  });
}

TEST_P(Stress, BallsHoldWhatTheyCertify) {
  ForEachScene(1, kScenes, [&](Random* random, const StressScene& scene, const VisualHull& hull) {
    for (int i = 0; i < 40; ++i) {
      const Vector3d center = PointAbout(random, scene);
      const PointAnswer probe = hull.Probe(center);
      ASSERT_EQ(probe.is_inside, hull.Contains(center));
      ASSERT_GE(probe.radius_mm, 0.0);
      const double radius_mm = random->LogUniform(1e-6, 10.0) * scene.size_mm;
      const BallAnswer answer = hull.Classify(center, radius_mm);
      for (int j = 0; j < 12; ++j) {
        const double share = random->Chance(0.5) ? 1.0 : random->Uniform(0.0, 1.0);
        const Vector3L way = share * random->Direction().cast<long double>();
        const Vector3L x = center.cast<long double>();
        if (std::isfinite(probe.radius_mm)) Claim(probe.is_inside, x + probe.radius_mm * way, kOfPoints);
        if (answer != BallAnswer::kMixed)
          Claim(answer == BallAnswer::kInside, x + radius_mm * way, kOfPoints);
      }
    }
  });
}

// How far off what is said of a ray's points may be.
StressError ErrorOf(const StressScene& scene, const Ray& ray, double t_mm) {
  double mm = kLeastMm + kRoundings * 0x1p-53 * (ray.origin_in_world.lpNorm<1>() + t_mm);
  for (const core::CameraModel& camera : scene.rig->cameras) {
    const Vector3d origin = camera.cam_from_world() * ray.origin_in_world;
    const Vector3d direction = camera.cam_from_world().rotation * ray.direction_in_world;
    const double through_mm = kThroughCentre * origin.norm();
    if (direction.cross(origin).norm() <= 2.0 * through_mm) mm += through_mm;
  }
  return {mm, kRoundings, kLensPx};
}

Vector3L At(const Ray& ray, double t_mm) {
  return ray.origin_in_world.cast<long double>() + t_mm * ray.direction_in_world.cast<long double>();
}

Ray RandomRay(Random* random, const StressScene& scene) {
  Ray ray;
  const double start = random->Chance(0.3) ? random->LogUniform(1e-3, 1e5) : random->Uniform(0.0, 2.0);
  ray.origin_in_world = scene.middle_in_world + start * scene.size_mm * random->Direction();
  const int kind = random->Whole(0, 9);
  const std::vector<core::CameraModel>& cameras = scene.rig->cameras;
  const Vector3d& center =
      cameras[static_cast<std::size_t>(random->Whole(0, static_cast<int>(cameras.size()) - 1))]
          .center_in_world();
  Vector3d target = scene.middle_in_world + 0.6 * scene.size_mm * random->Direction();
  if (kind == 0) target = center;  // through a camera
  if (kind == 1) ray.origin_in_world = center;
  if (kind == 2) ray.origin_in_world = scene.rig->workspace_mm.min();
  ray.direction_in_world = (target - ray.origin_in_world).normalized();
  if (kind == 3 || !(ray.direction_in_world.norm() > 0.5)) {
    ray.direction_in_world = Vector3d(-0.0, 5e-324, 0.0);
    ray.direction_in_world[random->Whole(0, 2)] = random->Chance(0.5) ? 1.0 : -1.0;
  }
  return ray;
}

TEST_P(Stress, RaysEnterAndLeaveWhereLongDoubleDoes) {
  ForEachScene(2, kScenes, [&](Random* random, const StressScene& scene, const VisualHull& hull) {
    for (int i = 0; i < 40; ++i) {
      const Ray ray = RandomRay(random, scene);
      const std::vector<HullInterval> intervals = IntervalsInHull(hull, ray);
      const std::optional<double> first = FirstInside(hull, ray);
      ASSERT_EQ(first.has_value(), !intervals.empty());
      const auto claim = [&](bool is_inside, double t_mm) {
        Claim(is_inside, At(ray, t_mm), ErrorOf(scene, ray, t_mm));
      };
      double outside_from_mm = 0.0;
      for (const HullInterval& interval : intervals) {
        ASSERT_TRUE(std::isfinite(interval.from_mm) && std::isfinite(interval.to_mm));
        ASSERT_LE(outside_from_mm, interval.from_mm);
        ASSERT_LT(interval.from_mm, interval.to_mm);
        for (const double share : {0.0, 0.5, 1.0, random->Uniform(0.0, 1.0), random->LogUniform(1e-15, 1e-3)})
          claim(true, interval.from_mm + share * (interval.to_mm - interval.from_mm));
        for (const double share : {0.5, 1.0 - 1e-15, random->Uniform(0.0, 1.0)}) {
          if (outside_from_mm < interval.from_mm)
            claim(false, outside_from_mm + share * (interval.from_mm - outside_from_mm));
        }
        outside_from_mm = interval.to_mm;
      }
      for (const double share : {1e-15, 1e-6, 0.1, random->Uniform(0.0, 3.0)})
        claim(false, outside_from_mm * (1.0 + 1e-15) + share * scene.size_mm);
    }
  });
}

// What a view's float32 makes of places: docs/exact_view.md, "Rounding".
StressError ErrorOf(const StressScene& scene, const ViewRays& rays, const Vector3d& x_in_view) {
  const core::RigidTransform& view_from_world = rays.view_from_world();
  const Vector3d x_in_world = view_from_world.Inverse() * x_in_view;
  double size_mm = x_in_view.norm(), cam_size_mm = 0.0, moved_mm = 0.0;
  for (const core::CameraModel& camera : scene.rig->cameras) {
    const double beside_mm = (view_from_world * camera.center_in_world()).norm();
    if (rays.projection() == Projection::kPerspective && beside_mm < kConcentricMm)
      moved_mm = std::max(moved_mm, beside_mm);
    cam_size_mm += (camera.cam_from_world() * x_in_world).norm();
    if (rays.projection() == Projection::kOrthographic) size_mm = std::max(size_mm, beside_mm);
  }
  const double world_mm = view_from_world.translation_mm.lpNorm<1>() + x_in_world.lpNorm<1>();
  return {kLeastViewMm + moved_mm + kViewRoundings * 0x1p-24 * size_mm + kTurnRad * cam_size_mm +
              kRoundings * 0x1p-53 * world_mm,
          kRoundings, kLensPx};
}

// One pixel's ray: orthographic ones start far behind all that there is.
struct PixelRay {
  Vector3d origin_in_view;
  Vector3d direction_in_view;  // z = 1
};

PixelRay RayOf(const StressScene& scene, const ViewRays& rays, const Eigen::Vector2d& uv) {
  if (rays.projection() == Projection::kPerspective) return {Vector3d::Zero(), {uv.x(), uv.y(), 1.0}};
  const double far_mm = (rays.view_from_world() * scene.middle_in_world).norm() + 4.0 * scene.size_mm;
  return {{uv.x(), uv.y(), -far_mm}, Vector3d::UnitZ()};
}

// Up to what the picture shows there is nothing, and there is the hull. Rays that may start in the hull may
// show nothing.
void Stress::ClaimPixel(const StressScene& scene, const VisualHull& hull, const ViewRays& rays,
                        const HullView& view, int x, int y, bool may_start_inside) {
  const Eigen::Vector2d uv = rays.At(x, y);
  if (!uv.allFinite()) return;
  const auto pixel = static_cast<std::size_t>(y * view.width_px + x);
  const bool is_hit = view.surface[pixel].is_hit();
  const double depth_mm = view.depth_mm[pixel];
  ASSERT_TRUE(std::isfinite(depth_mm));
  ASSERT_TRUE(view.normal_in_world[pixel].allFinite());
  ASSERT_NEAR(view.normal_in_world[pixel].norm(), is_hit ? 1.0F : 0.0F, 1e-5F);
  const PixelRay ray = RayOf(scene, rays, uv);
  const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
  const auto claim = [&](bool is_inside, double z_mm) {
    const Vector3d x_in_view = ray.origin_in_view + (z_mm - ray.origin_in_view.z()) * ray.direction_in_view;
    const Vector3L x_in_world = world_from_view.rotation.cast<long double>() * x_in_view.cast<long double>() +
                                world_from_view.translation_mm.cast<long double>();
    Claim(is_inside, x_in_world, ErrorOf(scene, rays, x_in_view));
  };
  if (is_hit) claim(true, depth_mm);
  if (!is_hit && may_start_inside) return;
  const double length = ray.direction_in_view.norm();
  const Ray in_world{world_from_view * ray.origin_in_view,
                     (world_from_view.rotation * ray.direction_in_view).normalized()};
  for (const HullInterval& interval : IntervalsInHull(hull, in_world)) {
    const double from_mm = ray.origin_in_view.z() + interval.from_mm / length;
    const double to_mm = ray.origin_in_view.z() + interval.to_mm / length;
    const double end_mm = is_hit ? std::min(to_mm, depth_mm) : to_mm;
    for (const double share : {0.01, 0.5, 0.99})
      if (end_mm > from_mm) claim(false, from_mm + share * (end_mm - from_mm));
  }
}

void Stress::ClaimPicture(Random* random, const StressScene& scene, const VisualHull& hull,
                          const ViewRays& rays) {
  const HullView view = ViewHull(hull, rays);
  const Vector3L eye = rays.view_from_world().Inverse().translation_mm.cast<long double>();
  const bool may_start_inside = rays.projection() == Projection::kPerspective &&
                                sure_->Contains(eye, ErrorOf(scene, rays, Vector3d::Zero())) != Sure::kNo;
  for (int i = 0; i < 50; ++i) {
    const int x = random->Whole(0, view.width_px - 1), y = random->Whole(0, view.height_px - 1);
    ClaimPixel(scene, hull, rays, view, x, y, may_start_inside);
  }
}

TEST_P(Stress, ViewsShowTheFirstSurfaceOfLongDouble) {
  ForEachScene(3, kScenes, [&](Random* random, const StressScene& scene, const VisualHull& hull) {
    for (int i = 0; i < 6 && !HasFailure(); ++i) {
      const ViewRays rays(MakeStressView(random, scene));
      ClaimPicture(random, scene, hull, rays);
      if (HasFailure()) std::cout << "view " << i << "\n";
    }
  });
}

TEST_P(Stress, OrthographicViewsToo) {
  ForEachScene(4, kScenes, [&](Random* random, const StressScene& scene, const VisualHull& hull) {
    for (int i = 0; i < 3 && !HasFailure(); ++i) {
      core::CameraCalibration c = MakeStressView(random, scene).calibration();
      c.camera_matrix(0, 0) = c.camera_matrix(1, 1) = 15.0 / scene.size_mm;
      c.distortion_coefficients.clear();
      const ViewRays rays(core::CameraModel(c), Projection::kOrthographic);
      ClaimPicture(random, scene, hull, rays);
    }
  });
}

TEST_P(Stress, MeshesAreClosedAndTheirVerticesOnTheSurface) {
  ForEachScene(
      5, std::max(kScenes / 2, 1), [&](Random* random, const StressScene& scene, const VisualHull& hull) {
        const double edge_mm = scene.size_mm / random->Uniform(4.0, 12.0);
        const HullMesh result = MeshHull(hull, edge_mm);
        EXPECT_TRUE(result.mesh.triangles.empty() || core::IsWatertight(result.mesh));
        for (const Vector3d& vertex : result.mesh.vertices_mm) {
          ASSERT_TRUE(vertex.allFinite());
          // On the surface: there is a point inside near by, and one outside.
          const StressError error{kVertexShare * edge_mm, kRoundings, kLensPx};
          Claim(true, vertex.cast<long double>(), error);
          Claim(false, vertex.cast<long double>(), error);
        }
        Claim(false, (scene.rig->workspace_mm.max() + Vector3d::Constant(scene.size_mm)).cast<long double>(),
              kOfPoints);
      });
}

TEST_P(Stress, SweepsAreWithinTheirBand) {
  ForEachScene(
      6, std::max(kScenes / 3, 1), [&](Random* random, const StressScene& scene, const VisualHull& hull) {
        Claim(false, (scene.rig->workspace_mm.max() + Vector3d::Constant(scene.size_mm)).cast<long double>(),
              kOfPoints);
        core::CameraCalibration c = MakeStressView(random, scene).calibration();
        c.image_width_px = 24, c.image_height_px = 20;
        const core::CameraModel view(c);
        PlaneSweepOptions options;
        const double middle_mm = (c.cam_from_world * scene.middle_in_world).z();
        options.spacing_mm = scene.size_mm / random->Uniform(3.0, 15.0);
        if (middle_mm / options.spacing_mm > 5e4) options.spacing_mm = middle_mm / 5e4;
        const SweptView swept = SweepPlanes(hull.rig(), scene.masks, view, options);
        for (const float depth_mm : swept.picture.depth_mm) ASSERT_TRUE(std::isfinite(depth_mm));
        const SweepCheck check = CheckSweep(hull.rig(), scene.masks, view, options, swept.picture, {});
        EXPECT_EQ(check.wrong_pixels, 0) << check.first_wrong;
      });
}

// Two full pictures: a hull that begins 54 mm over the table, seen from the table.
TEST(ViewHull, FromAFaceOfTheWorkspaceAndAlmostNothingBesideIt) {
  core::Rig rig;
  rig.workspace_mm = {Vector3d(-200, -200, 0), Vector3d(200, 200, 300)};
  std::vector<core::BitMask> masks;
  for (const Vector3d& eye : {Vector3d(400, 0, 150), Vector3d(0, 400, 150)}) {
    core::CameraCalibration c;
    c.image_width_px = 96, c.image_height_px = 72;
    c.camera_matrix << 150.0, 0.0, 47.5, 0.0, 150.0, 35.5, 0.0, 0.0, 1.0;
    c.cam_from_world = core::CamFromWorldLookingAt(eye, Vector3d(0, 0, 150));
    rig.cameras.emplace_back(c);
    core::BitMask& mask = masks.emplace_back(96, 72);
    for (int i = 0; i < 96 * 72; ++i) mask.Set(i % 96, i / 96, true);
  }
  const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), masks);
  const auto picture_from = [&](double z_mm) {
    core::CameraCalibration c;
    c.image_width_px = 40, c.image_height_px = 28;
    c.camera_matrix << 30.0, 0.0, 19.3, 0.0, 30.0, 13.8, 0.0, 0.0, 1.0;
    c.cam_from_world = core::CamFromWorldLookingAt(Vector3d(0, 0, z_mm), Vector3d(30, 20, 150));
    return ViewHull(hull, core::CameraModel(c));
  };
  const HullView on_it = picture_from(0.0);
  EXPECT_GT(on_it.hit_pixels, 300);
  for (const double beside_mm : {1e-300, 1e-100, 1e-40, 1e-35, 1e-19, 1e-15})
    for (const double z_mm : {beside_mm, -beside_mm})
      EXPECT_EQ(picture_from(z_mm).depth_mm, on_it.depth_mm) << z_mm << " mm from the face";
}

std::string NameOf(const testing::TestParamInfo<int>& kind) {
  std::string name(ToString(static_cast<StressKind>(kind.param)));
  std::ranges::replace(name, ' ', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Stress, testing::Range(0, kStressKinds), NameOf);

}  // namespace
}  // namespace elbowroom::recon
