// A pencil's lists against a search of all edges, and its bounds against the rays that they are for.
#include "recon/exact_view/cast_intervals.h"
#include "recon/contours/silhouette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "recon/exact_view/epipolar_edges.h"
#include "recon/hull/visual_hull.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// Keys of float32 forms in double: what float32 leaves of their coefficients, of their terms.
constexpr double kKeyRounding = 1e-6;

struct Crossing {
  double key = 0.0;
  double rounding = 0.0;
  bool is_entry = false;
};

Crossing CrossingAt(const CastForm& form, const Vector2d& uv, bool is_entry) {
  const double u = uv.x() * form.du, v = uv.y() * form.dv, at_origin = form.at_origin;
  return {u + v + at_origin, kKeyRounding * (std::abs(u) + std::abs(v) + std::abs(at_origin)), is_entry};
}

std::optional<float> AngleOf(const CastPencil& pencil, const Vector2d& uv) {
  const auto at = [&](const CastForm& form) {
    return static_cast<float>(uv.x() * form.du + uv.y() * form.dv + form.at_origin);
  };
  const float angle = PencilAngle(at(pencil.x), at(pencil.y));
  return std::isnan(angle) ? std::nullopt : std::optional(angle);
}

// In their listed order.
std::vector<Crossing> ListedAt(const CastPencil& pencil, float angle, const Vector2d& uv) {
  const CastIntervals& intervals = pencil.intervals;
  const auto after = std::upper_bound(intervals.begins.begin(), intervals.begins.end(), angle);
  const auto interval = static_cast<std::size_t>(after - intervals.begins.begin()) - 1;
  std::vector<Crossing> listed;
  const CastIntervals::Run run = intervals.RunOf(interval);
  for (std::size_t i = run.begin; i < run.end; ++i) {
    const CastEdge& edge = pencil.edges[static_cast<std::size_t>(intervals.crossings[i].edge())];
    listed.push_back(CrossingAt(edge.key, uv, edge.is_entry));
  }
  return listed;
}

std::vector<Crossing> SearchedAt(const CastPencil& pencil, float angle, const Vector2d& uv) {
  std::vector<Crossing> found;
  for (const CastEdge& edge : pencil.edges)
    if (edge.from <= angle && angle < edge.to) found.push_back(CrossingAt(edge.key, uv, edge.is_entry));
  std::ranges::sort(found, {}, &Crossing::key);
  return found;
}

ViewRays RandomRays(Random* random) {
  core::CameraCalibration view;
  view.image_width_px = 64, view.image_height_px = 48;
  const Eigen::Vector3d eye = random->LogUniform(30.0, 900.0) * random->Direction();
  view.cam_from_world = core::CamFromWorldLookingAt(eye, 30.0 * random->Direction());
  const bool is_orthographic = random->Chance(0.3);
  const double focal_px = is_orthographic ? 0.2 : 60.0;
  view.camera_matrix << focal_px, 0.0, 31.5, 0.0, focal_px, 23.5, 0.0, 0.0, 1.0;
  return ViewRays(core::CameraModel(view),
                  is_orthographic ? Projection::kOrthographic : Projection::kPerspective);
}

// Calls check(pencil, rays, random) for the cameras of seeded scenes.
template <typename Check>
void ForPencils(std::uint64_t seed, int scenes, const Check& check) {
  Random random(seed);
  for (int i = 0; i < scenes; ++i) {
    SCOPED_TRACE(i);
    const auto unseen = i % 2 == 0 ? core::UnseenPolicy::kOutside : core::UnseenPolicy::kAbstain;
    const RandomScene scene =
        i % 3 == 0 ? MakeRandomScene(&random) : MakeRingScene(&random, random.Whole(1, 4), unseen);
    const VisualHull hull = MakeVisualHull(scene.rig, scene.masks);
    const ViewRays rays = RandomRays(&random);
    for (core::CameraIndex camera = 0; camera < scene.rig->cameras.size(); ++camera) {
      const Silhouette& silhouette = *hull.silhouettes()[camera];
      const EpipolarEdges pencil(silhouette.labels(), silhouette.plane().focal_px(),
                                 scene.rig->cameras[camera], rays);
      if (!pencil.is_concentric()) check(pencil, rays, &random);
    }
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(CastIntervals, ListTheEdgesOfEveryAngleInOrder) {
  std::int64_t crossings = 0;
  ForPencils(8101, 60, [&](const EpipolarEdges& pencil, const ViewRays& rays, Random* random) {
    for (int i = 0; i < 60; ++i) {
      const Vector2d uv = rays.At(random->Whole(0, 63), random->Whole(0, 47));
      const std::optional<float> angle = AngleOf(pencil.cast(), uv);
      if (!angle) continue;
      const std::vector<Crossing> listed = ListedAt(pencil.cast(), *angle, uv);
      const std::vector<Crossing> searched = SearchedAt(pencil.cast(), *angle, uv);
      ASSERT_EQ(listed.size(), searched.size());
      for (std::size_t k = 0; k < listed.size(); ++k) {
        ASSERT_NEAR(listed[k].key, searched[k].key, listed[k].rounding + searched[k].rounding);
        // Entries and exits in turn, from the label of the start on.
        ASSERT_EQ(listed[k].is_entry, (k % 2 == 0) != pencil.starts_inside());
      }
      crossings += static_cast<std::int64_t>(listed.size());
    }
  });
  EXPECT_GT(crossings, 5000);
}

TEST(EpipolarEdges, ObjectsLieBetweenTheKeysThatItBounds) {
  std::int64_t bounded = 0, in_all = 0;
  ForPencils(8102, 60, [&](const EpipolarEdges& pencil, const ViewRays& rays, Random* random) {
    for (int i = 0; i < 40; ++i) {
      const int size = 1 << random->Whole(2, 5);
      const int x = 8 * random->Whole(0, 7), y = 8 * random->Whole(0, 5);
      const int right = std::min(x + size, 64), bottom = std::min(y + size, 48);
      const EpipolarEdges::KeyRange keys = pencil.ObjectKeys(rays.BoundsOf(x, y, right, bottom));
      ++in_all;
      bounded += std::isfinite(keys.least) || std::isfinite(keys.most) || keys.least > keys.most ? 1 : 0;
      for (int ray = 0; ray < 20; ++ray) {
        const Vector2d uv = rays.At(random->Whole(x, right - 1), random->Whole(y, bottom - 1));
        const std::optional<float> angle = AngleOf(pencil.cast(), uv);
        if (!angle) continue;
        const std::vector<Crossing> crossings = ListedAt(pencil.cast(), *angle, uv);
        if (crossings.empty()) {
          ASSERT_TRUE(!pencil.starts_inside() || (std::isinf(keys.least) && std::isinf(keys.most)));
          continue;
        }
        const Crossing &first = crossings.front(), &last = crossings.back();
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        ASSERT_LE(keys.least, first.is_entry ? first.key + first.rounding : -kInfinity);
        ASSERT_GE(keys.most, last.is_entry ? kInfinity : last.key - last.rounding);
      }
    }
  });
  EXPECT_GT(bounded, in_all / 2) << "a bound that binds nothing settles no square";
}

}  // namespace
}  // namespace elbowroom::recon
