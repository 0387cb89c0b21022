#include "recon/gl/exact_view/exact_view_gl.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "recon/exact_view/view_comparison.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/soak.h"

namespace elbowroom::recon::gl {
namespace {

using Eigen::Vector3d;

// Pixels that float32 can't decide, as a share of all of them together. Random rigs have cameras that show
// noise through 50,000 px of focal length: edges closer to each other than float32 can tell apart.
constexpr double kMostInBandOnRings = 0.01;
constexpr double kMostInBandOnRandomRigs = 0.1;

core::CameraCalibration ViewFrom(const Vector3d& eye, const Vector3d& target) {
  core::CameraCalibration view;
  view.name = "view";
  view.image_width_px = 150, view.image_height_px = 101;  // no whole number of squares
  view.camera_matrix << 170.0, 0.5, 73.0, 0.0, 165.0, 52.0, 0.0, 0.0, 1.0;
  view.cam_from_world = core::CamFromWorldLookingAt(eye, target);
  return view;
}

// Far, near, in the middle of things; with a lens now and then, or from a rig camera.
ViewRays RandomView(Random* random, const core::Rig& rig) {
  if (random->Chance(0.15)) return ViewRays(rig.cameras[0]);
  core::CameraCalibration view =
      ViewFrom(random->LogUniform(20.0, 1500.0) * random->Direction(), 40.0 * random->Direction());
  if (random->Chance(0.3)) {  // orthographic, pixels per mm
    view.camera_matrix << 0.4, 0.0, 75.0, 0.0, 0.45, 50.0, 0.0, 0.0, 1.0;
    return ViewRays(core::CameraModel(view), Projection::kOrthographic);
  }
  if (random->Chance(0.4)) view.distortion_coefficients = {-0.2, 0.05, 1e-3, -5e-4, 0.0};
  return ViewRays(core::CameraModel(view));
}

// Up to three planes near the middle of things.
ViewRays CutBy(Random* random, const ViewRays& rays) {
  std::vector<HalfSpace> half_spaces;
  for (int i = random->Whole(0, 3); i > 0; --i)
    half_spaces.push_back({random->Direction(), random->Uniform(-20.0, 60.0)});
  return rays.Within(half_spaces);
}

class Tally {
 public:
  void Add(const VisualHull& hull, const ViewRays& rays, ExactViewGl* gl) {
    const HullView cpu = recon::ViewHull(hull, rays, {});
    const HullView card = gl->ViewHull(hull, rays, {});
    const ViewComparison comparison = CompareViews(hull, rays, cpu, card);
    EXPECT_TRUE(comparison.Agree()) << comparison.differing_pixels << " of " << comparison.hit_pixels
                                    << " hits differ outside the band of " << comparison.band_pixels;
    EXPECT_EQ(card.edges, cpu.edges);
    hits += comparison.hit_pixels, band += comparison.band_pixels, pixels += comparison.pixels;
    differing += comparison.differing_in_band;
    std::int64_t unlike = 0;
    for (std::size_t i = 0; i < cpu.surface.size(); ++i) {
      EXPECT_EQ(card.surface[i].is_hit(), card.depth_mm[i] != 0.0F);
      unlike += card.surface[i] == cpu.surface[i] ? 0 : 1;
    }
    EXPECT_LE(unlike, comparison.band_pixels);
    surfaces += unlike;
  }

  std::int64_t hits = 0, band = 0, pixels = 0, differing = 0, surfaces = 0;
};

void ExpectEqualViews(std::uint64_t seed, int scenes, bool ring, double most_in_band) {
  Random random(seed);
  ExactViewGl gl;
  Tally tally;
  for (int i = 0; i < scenes; ++i) {
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene =
        ring ? MakeRingScene(&random, random.Whole(1, 8), unseen) : MakeRandomScene(&random);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    SCOPED_TRACE(i);
    tally.Add(hull, RandomView(&random, *scene.rig), &gl);
  }
  std::printf("%ld pixels, %ld hits, %ld in the band, %ld of them differ, %ld surfaces\n", tally.pixels,
              tally.hits, tally.band, tally.differing, tally.surfaces);
  EXPECT_GT(tally.hits, 1000 * scenes);
  EXPECT_LT(static_cast<double>(tally.band), most_in_band * static_cast<double>(tally.pixels));
}

// The planes' tables are the same; a walk that begins at a plane is as any other.
TEST(ExactViewGl, EqualsTheProcessorsWithinHalfSpaces) {
  Random random(2025);
  ExactViewGl gl;
  Tally tally;
  for (int i = 0; i < 30; ++i) {
    const RandomScene scene = MakeRingScene(&random, random.Whole(2, 6), core::UnseenPolicy::kOutside);
    SCOPED_TRACE(i);
    tally.Add(MakeVisualHull(scene.rig, scene.masks), CutBy(&random, RandomView(&random, *scene.rig)), &gl);
  }
  EXPECT_GT(tally.hits, 10'000);
  EXPECT_LT(static_cast<double>(tally.band), kMostInBandOnRings * static_cast<double>(tally.pixels));
}

TEST(ExactViewGl, DrawsAndUploadsOnlyWhatIsNew) {
  Random random(5203);
  const RandomScene scene = MakeRingScene(&random, 3, core::UnseenPolicy::kOutside);
  const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
  const ViewRays rays(core::CameraModel(ViewFrom({300.0, -200.0, 250.0}, Vector3d::Zero())));
  ExactViewGl gl;
  const HullView first = gl.ViewHull(hull, rays);
  ASSERT_GT(first.hit_pixels, 100);
  EXPECT_EQ(gl.draws(), 1);
  EXPECT_EQ(gl.ViewHull(hull, rays).depth_mm, first.depth_mm);
  EXPECT_EQ(gl.draws(), 1) << "the same view";
  core::RigidTransform moved = rays.view_from_world();
  moved.translation_mm.x() += 1.0;
  EXPECT_NE(gl.ViewHull(hull, rays.From(moved)).depth_mm, first.depth_mm);
  EXPECT_EQ(gl.draws(), 2) << "from elsewhere";
  (void)gl.ViewHull(MakeVisualHull(scene.rig, scene.masks), rays);
  EXPECT_EQ(gl.draws(), 3) << "another hull";
  (void)gl.ViewHull(hull, rays.Within({{Vector3d::UnitX(), 0.0}}));
  EXPECT_EQ(gl.draws(), 4) << "cut open";
  EXPECT_EQ(gl.ray_uploads(), 1) << "all with the same rays";
  core::CameraCalibration longer = ViewFrom({300.0, -200.0, 250.0}, Vector3d::Zero());
  longer.camera_matrix(0, 0) *= 1.5;
  (void)gl.ViewHull(hull, ViewRays(core::CameraModel(longer)));
  EXPECT_EQ(gl.ray_uploads(), 2);
}

TEST(ExactViewGl, EqualsTheProcessorsOnRings) {
  ExpectEqualViews(7001, 40 * test_support::SoakScale(), true, kMostInBandOnRings);
}

TEST(ExactViewGl, EqualsTheProcessorsOnRandomRigs) {
  ExpectEqualViews(7002, 60 * test_support::SoakScale(), false, kMostInBandOnRandomRigs);
}

}  // namespace
}  // namespace elbowroom::recon::gl
