#include "recon/exact_view/hull_view.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// What hull_view.h promises, of the depth: float32 keys, and as much again for the float that is returned.
constexpr double kFloatDepth = 2e-6;
// float32 moves an edge by up to 2^-22 of a tile's width of the view: a few millionths of a pixel.
constexpr double kFloatPx = 1e-5;

core::CameraCalibration ViewCalibration(int width_px, int height_px, double focal_px) {
  core::CameraCalibration c;
  c.name = "view";
  c.image_width_px = width_px, c.image_height_px = height_px;
  c.camera_matrix << focal_px, 0.0, 0.5 * width_px, 0.0, focal_px, 0.5 * height_px, 0.0, 0.0, 1.0;
  return c;
}

core::CameraModel ViewCamera(int width_px, int height_px, const Vector3d& eye, const Vector3d& target,
                             std::vector<double> lens = {}) {
  core::CameraCalibration c = ViewCalibration(width_px, height_px, 1.1 * width_px);
  c.distortion_coefficients = std::move(lens);
  c.cam_from_world = core::CamFromWorldLookingAt(eye, target);
  return core::CameraModel(std::move(c));
}

// The ray of a place of the view, and how far along it a depth of 1 mm is; nothing for an empty place.
struct PixelRay {
  Ray ray;
  double mm_per_depth_mm = 1.0;
};
std::optional<PixelRay> RayThrough(const ViewRays& rays, const Vector2d& uv) {
  if (!uv.allFinite()) return std::nullopt;
  const core::RigidTransform world_from_view = rays.view_from_world().Inverse();
  if (rays.projection() == Projection::kOrthographic) {
    return PixelRay{{world_from_view * Vector3d(uv.x(), uv.y(), 0.0), world_from_view.rotation.col(2)}, 1.0};
  }
  const Vector3d d(uv.x(), uv.y(), 1.0);
  return PixelRay{{world_from_view.translation_mm, (world_from_view.rotation * d).normalized()}, d.norm()};
}

// Depth of the first crossing by IntervalsInHull; orthographic rays come from far behind the picture.
struct Depth {
  std::optional<double> mm;
  bool is_thin = false;  // the first stretch of hull, is nothing to a float32
};
Depth DepthByCrossings(const VisualHull& hull, const ViewRays& rays, const Vector2d& uv) {
  const std::optional<PixelRay> through = RayThrough(rays, uv);
  if (!through) return {};
  const double behind_mm = rays.projection() == Projection::kOrthographic ? 4096.0 : 0.0;
  Ray ray = through->ray;
  ray.origin_in_world -= behind_mm * ray.direction_in_world;
  const std::vector<HullInterval> intervals = IntervalsInHull(hull, ray);
  // A centre in the hull: nothing to see.
  if (intervals.empty() || intervals[0].from_mm == 0.0) return {};
  const double thin_mm = 2.0 * kFloatDepth * intervals[0].from_mm;
  return {(intervals[0].from_mm - behind_mm) / through->mm_per_depth_mm,
          intervals[0].to_mm - intervals[0].from_mm < thin_mm};
}

struct Comparison {
  int pixels = 0;
  int hits = 0;
  int grazing = 0;     // rays beside it, a hundred-thousandth of a pixel off, see something else
  double worst = 0.0;  // of the others, relative depth error
};

// Depths of the pixel's ray and of rays a little beside it: their range, or nothing if they don't agree on a
// hit.
struct DepthRange {
  bool is_hit = false;
  bool is_clear = true;
  double nearest_mm = std::numeric_limits<double>::infinity();
  double farthest_mm = -std::numeric_limits<double>::infinity();
};
DepthRange DepthsAround(const VisualHull& hull, const ViewRays& rays, const Vector2d& uv, double aside) {
  DepthRange range;
  const Vector2d offsets[] = {{0, 0}, {aside, 0}, {-aside, 0}, {0, aside}, {0, -aside}};
  for (const Vector2d& offset : offsets) {
    const Depth depth = DepthByCrossings(hull, rays, uv + offset);
    if (offset.isZero()) range.is_hit = depth.mm.has_value();
    range.is_clear = range.is_clear && depth.mm.has_value() == range.is_hit && !depth.is_thin;
    if (!depth.mm) continue;
    range.nearest_mm = std::min(range.nearest_mm, *depth.mm);
    range.farthest_mm = std::max(range.farthest_mm, *depth.mm);
  }
  return range;
}

// What is under a pixel is what its ray meets: on the named camera's edge, or on a face.
void ExpectSurfaceIsThere(const VisualHull& hull, const ViewRays& rays, const HullView& view,
                          std::size_t pixel, const Vector2d& uv, double tolerance_mm) {
  const HullSurface& surface = view.surface[pixel];
  ASSERT_TRUE(surface.is_hit());
  const double depth_mm = view.depth_mm[pixel];
  const Vector3d in_view = rays.projection() == Projection::kPerspective
                               ? Vector3d(uv.x() * depth_mm, uv.y() * depth_mm, depth_mm)
                               : Vector3d(uv.x(), uv.y(), depth_mm);
  const Vector3d x_in_world = rays.view_from_world().Inverse() * in_view;
  if (!surface.camera()) {
    const Eigen::AlignedBox3d& box = hull.rig().workspace_mm;
    const double to_face_mm = std::min((x_in_world - box.min()).cwiseAbs().minCoeff(),
                                       (box.max() - x_in_world).cwiseAbs().minCoeff());
    ASSERT_LE(to_face_mm, tolerance_mm);
    return;
  }
  const core::CameraIndex camera = *surface.camera();
  const Silhouette& silhouette = *hull.silhouettes()[camera];
  const Contour& own = silhouette.labels().contour();
  const bool is_outline = surface.edge() >= own.edges.size();
  const Contour& contour = is_outline ? silhouette.plane().outline().contour() : own;
  const auto edge =
      static_cast<std::uint32_t>(is_outline ? surface.edge() - own.edges.size() : surface.edge());
  ASSERT_LT(edge, contour.edges.size());
  const double focal_px = silhouette.plane().focal_px();
  const Vector3d x_in_cam = hull.rig().cameras[camera].cam_from_world() * x_in_world;
  ASSERT_GT(x_in_cam.z(), -tolerance_mm);
  if (x_in_cam.z() < 1e3 * tolerance_mm) return;  // at the camera's centre all edges meet
  const Vector2d position = x_in_cam.head<2>() * (focal_px / x_in_cam.z());
  const double tolerance_px = kFloatPx + tolerance_mm * (focal_px + position.norm()) / x_in_cam.z();
  ASSERT_LE(DistanceToEdge(contour, edge, position), tolerance_px) << "camera " << camera << " edge " << edge;
}

void ExpectPixelIsItsRaysCrossing(const VisualHull& hull, const ViewRays& rays, const HullView& view, int x,
                                  int y, Comparison* sum) {
  const auto pixel = static_cast<std::size_t>(y * view.width_px + x);
  const double depth_mm = view.depth_mm[pixel];
  const bool is_hit = view.surface[pixel].is_hit();
  const Vector2d uv = rays.At(x, y);
  ++sum->pixels;
  if (!uv.allFinite()) {
    ASSERT_FALSE(is_hit);
    return;
  }
  const double pitch = std::max((rays.At(std::min(x + 1, view.width_px - 1), y) - uv).norm(),
                                (rays.At(std::max(x - 1, 0), y) - uv).norm());
  const DepthRange truth = DepthsAround(hull, rays, uv, kFloatPx * pitch);
  if (!truth.is_clear) {
    ++sum->grazing;
    return;
  }
  ASSERT_EQ(is_hit, truth.is_hit) << x << ' ' << y << " depth " << depth_mm << " or " << truth.nearest_mm;
  if (!is_hit) return;
  ++sum->hits;
  // Surfaces that turn along the ray: as far as they reach a hundred-thousandth of a pixel aside.
  const double slack_mm = truth.farthest_mm - truth.nearest_mm;
  const double rounding_mm = kFloatDepth * std::abs(depth_mm) + 1e-9;
  ASSERT_GE(depth_mm, truth.nearest_mm - slack_mm - rounding_mm) << x << ' ' << y;
  ASSERT_LE(depth_mm, truth.farthest_mm + slack_mm + rounding_mm) << x << ' ' << y;
  ExpectSurfaceIsThere(hull, rays, view, pixel, uv, 2.0 * (slack_mm + rounding_mm));
  ASSERT_NEAR(view.normal_in_world[pixel].norm(), 1.0F, 1e-5F);
}

// Every pixel against its own ray's crossings.
void ExpectEqualsCrossings(const VisualHull& hull, const ViewRays& rays, Comparison* sum) {
  const HullView view = ViewHull(hull, rays);
  std::int64_t hits = 0;
  for (int y = 0; y < view.height_px; ++y) {
    for (int x = 0; x < view.width_px; ++x) {
      hits += view.surface[static_cast<std::size_t>(y * view.width_px + x)].is_hit() ? 1 : 0;
      ExpectPixelIsItsRaysCrossing(hull, rays, view, x, y, sum);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
  ASSERT_EQ(hits, view.hit_pixels);
  ASSERT_EQ(view.cast_pixels + view.skipped_pixels, std::int64_t{view.width_px} * view.height_px);
}

void ExpectFewGraze(const Comparison& sum) {
  EXPECT_LT(sum.grazing, sum.pixels / 200) << "of " << sum.pixels;
}

TEST(ViewHull, EveryPixelIsItsOwnRaysFirstCrossing) {
  Random random(5401);
  Comparison sum;
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    for (int trial = 0; trial < 8; ++trial) {
      const RandomScene scene = MakeRingScene(&random, random.Whole(1, 5), unseen);
      const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
      // 8 n + 1 pixels a side: the last tile is a single pixel. With a lens and without.
      ExpectEqualsCrossings(hull,
                            ViewRays(ViewCamera(73, 49, 700.0 * random.Direction(), Vector3d::Zero(),
                                                {-0.1, 0.02, 1e-3, 1e-3, 0.0})),
                            &sum);
      // From inside the workspace, and possibly inside the hull.
      ExpectEqualsCrossings(
          hull, ViewRays(ViewCamera(41, 33, 60.0 * random.Direction(), 20.0 * random.Direction())), &sum);
      if (HasFatalFailure()) FAIL() << "trial " << trial;
    }
  }
  EXPECT_GT(sum.hits, 5000);
  ExpectFewGraze(sum);
}

TEST(ViewHull, EveryKindOfScene) {
  Random random(5402);
  Comparison sum;
  for (int trial = 0; trial < 80; ++trial) {
    const RandomScene scene = MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    const Vector3d eye = random.LogUniform(10.0, 2000.0) * random.Direction();
    ExpectEqualsCrossings(hull, ViewRays(ViewCamera(25, 17, eye, 30.0 * random.Direction())), &sum);
    if (HasFatalFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(sum.hits, 2000);
  // Noise seen by telephoto lenses: more edges in a pixel than elsewhere in a picture. 1.7 % measured.
  EXPECT_LT(sum.grazing, sum.pixels / 30);
}

TEST(ViewHull, Orthographic) {
  Random random(5403);
  Comparison sum;
  for (int trial = 0; trial < 12; ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, 3, unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    core::CameraCalibration c = ViewCalibration(49, 41, 0.2);  // pixels per mm
    // Along an axis of the world now and then: parallel to the faces.
    const Vector3d towards = trial % 3 == 0 ? Vector3d(Vector3d::Unit(trial % 2)) : random.Direction();
    c.cam_from_world = core::CamFromWorldLookingAt(-300.0 * towards, Vector3d::Zero());
    ExpectEqualsCrossings(hull, ViewRays(core::CameraModel(c), Projection::kOrthographic), &sum);
    if (HasFatalFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(sum.hits, 3000);
  ExpectFewGraze(sum);
  EXPECT_THROW(
      ViewRays(ViewCamera(9, 9, {0, 0, 9}, {0, 0, 0}, {0.1, 0.0, 0.0, 0.0}), Projection::kOrthographic),
      core::Error);
}

// The view is a camera of the rig, or stands beside it by less than anything a rig's numbers mean.
TEST(ViewHull, FromACameraOfTheRigAndAHairBesideIt) {
  Random random(5404);
  Comparison sum;
  for (int trial = 0; trial < 6; ++trial) {
    const auto unseen = trial % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene = MakeRingScene(&random, 4, unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    const core::CameraModel& camera = scene.rig->cameras[0];
    core::CameraCalibration c = ViewCalibration(57, 41, 60.0);
    for (const double beside_mm : {0.0, 1e-9, 1e-7, 1e-5, 1e-3}) {
      c.cam_from_world = camera.cam_from_world();
      c.cam_from_world.translation_mm += beside_mm * random.Direction();
      ExpectEqualsCrossings(hull, ViewRays(core::CameraModel(c)), &sum);
      if (HasFatalFailure()) FAIL() << "trial " << trial << " beside by " << beside_mm;
    }
    // The camera itself, lens and all, sees no more than its own silhouette.
    const HullView own = ViewHull(hull, camera);
    for (int y = 0; y < own.height_px; ++y) {
      for (int x = 0; x < own.width_px; ++x) {
        const bool hit = own.depth_mm[static_cast<std::size_t>(y * own.width_px + x)] > 0.0F;
        EXPECT_TRUE(!hit || scene.masks[0].At(x, y)) << x << ' ' << y;
      }
    }
    EXPECT_GT(own.hit_pixels, 0);
  }
  EXPECT_GT(sum.hits, 1000);
}

// Two ideal cameras and the view among round numbers, where epipoles, contours and rays fall on each other.
core::CameraModel RoundCamera(int size_px, const Vector3d& centre_in_world, const Eigen::Matrix3d& rotation) {
  core::CameraCalibration c = ViewCalibration(size_px, size_px, 64.0);
  c.camera_matrix(0, 2) = c.camera_matrix(1, 2) = 0.5 * size_px;
  c.cam_from_world = {rotation, -(rotation * centre_in_world)};
  return core::CameraModel(c);
}

RandomScene RoundScene(core::UnseenPolicy unseen) {
  core::Rig rig;
  rig.workspace_mm = {Vector3d(-64, -64, -64), Vector3d(64, 64, 64)};
  rig.unseen = unseen;
  Eigen::Matrix3d along_x;  // looks along +x, its right along y
  along_x << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  rig.cameras.push_back(RoundCamera(64, {0, 0, -256}, Eigen::Matrix3d::Identity()));
  rig.cameras.push_back(RoundCamera(64, {-256, 0, 0}, along_x));
  RandomScene scene;
  for (int i = 0; i < 2; ++i) {
    core::BitMask mask(64, 64);
    for (int y = 24; y < 44; ++y)
      for (int x = 20; x < 40; ++x) mask.Set(x, y, true);
    scene.masks.push_back(mask);
  }
  scene.rig = std::make_shared<const core::Rig>(std::move(rig));
  return scene;
}

TEST(ViewHull, EpipolesBehindAtInfinityInsideAndOnTheContour) {
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    const RandomScene scene = RoundScene(unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    struct Place {
      const char* what;
      Vector3d eye;
    };
    // Camera 1 at z = -256 sees (x, y, z) at 32 + 64 x / (z + 256): the contour's left is at 19.5.
    const std::vector<Place> places = {
        {"behind both", {-300, 7, -320}},
        {"beside camera 1: its epipole is at infinity", {64, 0, -256}},
        {"behind camera 1 on its axis", {0, 0, -300}},
        {"beyond the hull, its epipole inside the silhouette", {8, 3, 300}},
        {"beyond the hull, its epipole on the contour", {-12.5 / 64.0 * 512.0, 4, 256}},
        {"its epipole on a vertex of the contour", {-12.5 / 64.0 * 512.0, 0, 256}},
        {"its epipole on the contour, inside the workspace", {-12.5 / 64.0 * 300.0, 1, 44}},
        {"its epipole on a corner of the silhouette", {-12.5 / 64.0 * 512.0, -8.0 / 64.0 * 512.0, 256}},
    };
    for (const Place& place : places) {
      Comparison sum;
      ExpectEqualsCrossings(hull, ViewRays(ViewCamera(65, 49, place.eye, {1, 2, 3})), &sum);
      EXPECT_GT(sum.hits, 0) << place.what;
      EXPECT_LT(sum.grazing, sum.pixels / 20) << place.what;
      if (HasFatalFailure()) FAIL() << place.what;
    }
  }
}

TEST(ViewHull, OfSilhouettesThatTouchBordersHaveHolesOrComeInManyBlobs) {
  Random random(5405);
  const std::vector<std::function<bool(int, int)>> shapes = {
      [](int x, int) { return x < 80; },                               // touches three borders
      [](int x, int y) { return std::hypot(x - 80, y - 60) > 30.0; },  // a hole
      [](int x, int y) { return x / 8 % 2 == 0 && y / 8 % 2 == 0; },   // 150 blobs
      [](int x, int y) { return (x + y) % 2 == 0; },                   // joined at corners alone
      [](int, int) { return true; },
      [](int x, int y) { return x > 0 && y > 0 && x < 159 && y < 119; },
  };
  Comparison sum;
  for (const auto unseen : {core::UnseenPolicy::kOutside, core::UnseenPolicy::kAbstain}) {
    for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
      RandomScene scene = MakeRingScene(&random, 3, unseen);
      for (int i = 0; i < 160 * 120; ++i)
        scene.masks[0].Set(i % 160, i / 160, shapes[shape](i % 160, i / 160));
      const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
      ExpectEqualsCrossings(hull, ViewRays(ViewCamera(41, 33, 600.0 * random.Direction(), Vector3d::Zero())),
                            &sum);
      if (HasFatalFailure()) FAIL() << "shape " << shape;
    }
  }
  EXPECT_GT(sum.hits, 1000);
}

TEST(ViewHull, OfNearlyParallelCameras) {
  Random random(5406);
  Comparison sum;
  for (const double apart_mm : {1e-6, 1e-3, 1.0}) {
    RandomScene scene = MakeRingScene(&random, 2, core::UnseenPolicy::kOutside);
    core::Rig rig = *scene.rig;
    core::CameraCalibration twin = rig.cameras[0].calibration();
    twin.cam_from_world.translation_mm.x() += apart_mm;
    rig.cameras.emplace_back(twin);
    scene.masks.push_back(scene.masks[0]);
    const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), scene.masks);
    ExpectEqualsCrossings(hull, ViewRays(ViewCamera(41, 33, 600.0 * random.Direction(), Vector3d::Zero())),
                          &sum);
    if (HasFatalFailure()) FAIL() << apart_mm;
  }
}

TEST(ViewHull, OneThreadPaintsWhatManyPaint) {
  Random random(5407);
  const RandomScene scene = MakeRingScene(&random, 4, core::UnseenPolicy::kAbstain);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const core::CameraModel view = ViewCamera(200, 150, Vector3d(500, 300, 400), Vector3d::Zero());
  const HullView many = ViewHull(hull, view);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const HullView one = ViewHull(hull, view);
  EXPECT_GT(one.hit_pixels, 500);
  EXPECT_EQ(one.depth_mm, many.depth_mm);
  EXPECT_EQ(one.normal_in_world, many.normal_in_world);
  EXPECT_EQ(one.crossings_met, many.crossings_met);
  EXPECT_EQ(one.skipped_pixels, many.skipped_pixels);
  EXPECT_TRUE(one.surface == many.surface);
}

TEST(ViewHull, TheMemoryOfAnotherViewChangesNothing) {
  Random random(5409);
  const core::CameraModel camera = ViewCamera(200, 150, Vector3d(500, 300, 400), Vector3d::Zero());
  const core::CameraModel small = ViewCamera(90, 150, Vector3d(500, 300, 400), Vector3d::Zero());
  HullView kept;
  for (int trial = 0; trial < 24; ++trial) {
    RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
    if (trial % 6 == 5) scene.masks[0] = core::BitMask(scene.masks[0].width_px(), scene.masks[0].height_px());
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    const ViewRays rays(trial % 7 == 6 ? small : camera);
    const HullViewOptions options{random.Chance(0.7), random.Chance(0.7)};
    const HullView fresh = ViewHull(hull, rays, options);
    kept = ViewHull(hull, rays, options, std::move(kept));
    EXPECT_EQ(kept.depth_mm, fresh.depth_mm);
    EXPECT_TRUE(kept.surface == fresh.surface);
    EXPECT_EQ(kept.normal_in_world, fresh.normal_in_world);
    EXPECT_EQ(kept.hit_pixels, fresh.hit_pixels);
    for (int y = 0; y < kept.height_px; ++y) {
      for (int x = 0; x < kept.width_px; ++x) {
        if (kept.depth_mm[static_cast<std::size_t>(y * kept.width_px + x)] == 0.0F) continue;
        EXPECT_TRUE(x >= kept.hits.x && x < kept.hits.right && y >= kept.hits.y && y < kept.hits.bottom);
      }
    }
  }
}

TEST(ViewHull, OfEmptyAndFullMasks) {
  Random random(5408);
  RandomScene scene = MakeRingScene(&random, 2, core::UnseenPolicy::kAbstain);
  const core::CameraModel view = ViewCamera(80, 60, Vector3d(0, -600, 0), Vector3d::Zero());
  for (core::BitMask& mask : scene.masks) mask = core::BitMask(160, 120);
  EXPECT_EQ(ViewHull(MakeVisualHull(scene.rig, scene.masks), view).hit_pixels, 0);
  for (core::BitMask& mask : scene.masks)
    for (int i = 0; i < 160 * 120; ++i) mask.Set(i % 160, i / 160, true);
  // All object, seen by both: the hull is the workspace where it is seen, and its front face fills the
  // picture's middle at the depth of that face.
  const HullView full = ViewHull(MakeVisualHull(scene.rig, scene.masks), view);
  constexpr double kFaceDepthMm = 460.0;  // the face y = -140 from y = -600
  EXPECT_NEAR(full.depth_mm[30 * 80 + 40], kFaceDepthMm, kFloatDepth * kFaceDepthMm);
  EXPECT_EQ(full.surface[30 * 80 + 40], HullSurface::Workspace());
  EXPECT_TRUE(full.normal_in_world[30 * 80 + 40].isApprox(-Eigen::Vector3f::UnitY()));
}

TEST(ViewHull, RaysFromElsewhereAreThoseOfAViewThere) {
  Random random(5409);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const core::CameraModel here = ViewCamera(64, 48, {0, -500, 100}, Vector3d::Zero(), {-0.1, 0.0, 0.0, 0.0});
  const core::CameraModel there = ViewCamera(64, 48, {400, 300, 0}, Vector3d::Zero(), {-0.1, 0.0, 0.0, 0.0});
  const ViewRays moved = ViewRays(here).From(there.cam_from_world());
  EXPECT_EQ(ViewHull(hull, moved).depth_mm, ViewHull(hull, there).depth_mm);
}

TEST(ViewHull, NormalsOfABallSeenByManyCamerasPointAwayFromIt) {
  // Silhouettes of a ball from 24 cameras: the hull is nearly the ball, its normals nearly radial.
  constexpr double kBallRadiusMm = 60.0;
  core::Rig rig;
  rig.workspace_mm = {Vector3d::Constant(-100), Vector3d::Constant(100)};
  std::vector<core::BitMask> masks;
  Random random(5410);
  for (int i = 0; i < 24; ++i) {
    core::CameraCalibration c = ViewCalibration(240, 240, 700.0);
    c.camera_matrix(0, 2) = c.camera_matrix(1, 2) = 119.5;
    c.cam_from_world = core::CamFromWorldLookingAt(600.0 * random.Direction(), Vector3d::Zero());
    rig.cameras.emplace_back(c);
    core::BitMask mask(240, 240);
    const double apparent_px = std::tan(std::asin(kBallRadiusMm / 600.0)) * 700.0;
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 240; ++x) mask.Set(x, y, std::hypot(x - 119.5, y - 119.5) <= apparent_px);
    masks.push_back(mask);
  }
  const VisualHull hull = MakeVisualHull(std::make_shared<const core::Rig>(rig), masks);
  const core::CameraModel view = ViewCamera(96, 96, Vector3d(400, 100, 200), Vector3d::Zero());
  const HullView picture = ViewHull(hull, view);
  ASSERT_GT(picture.hit_pixels, 500);
  double sum = 0.0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const auto pixel = static_cast<std::size_t>(y * 96 + x);
      if (picture.depth_mm[pixel] == 0.0F) continue;
      const Vector3d in_cam = picture.depth_mm[pixel] * view.NormalisedFromPixel({x, y})->homogeneous();
      const Vector3d hit = view.cam_from_world().Inverse() * in_cam;
      sum += hit.normalized().dot(picture.normal_in_world[pixel].cast<double>());
    }
  }
  // The hull of 24 views is faceted by about 15 degrees and the picture's edges are staircases.
  constexpr double kMeanCosine = 0.95;
  EXPECT_GT(sum / static_cast<double>(picture.hit_pixels), kMeanCosine);
}

}  // namespace
}  // namespace elbowroom::recon
