// Coarser levels of meshes: how far they are from the whole, held to every triangle, and what pictures show.
#include "recon/gl/scene/detail_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <numbers>
#include <set>

#include "core/part_distance.h"
#include "core/units.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/gl/scene/scene_renderer.h"

namespace elbowroom::recon::gl {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3d kBoxMm(100, 60, 40);
constexpr double kCreaseRad = core::RadiansFromDegrees(30.0);

// A closed mesh of fans and rings: `place` gives the points of u (around, periodic) and v (from pole to
// pole).
template <typename Place>
core::SharedMesh Closed(int around, int rings, Place place) {
  auto mesh = std::make_shared<core::TriangleMesh>();
  mesh->vertices_mm = {place(0.0, 0.0), place(0.0, 1.0)};
  for (int ring = 1; ring < rings; ++ring)
    for (int i = 0; i < around; ++i)
      mesh->vertices_mm.push_back(place(static_cast<double>(i) / around, static_cast<double>(ring) / rings));
  const auto at = [&](int ring, int i) {
    if (ring == 0 || ring == rings) return ring == 0 ? 0 : 1;
    return 2 + (ring - 1) * around + i % around;
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < around; ++i) {
      if (ring > 0) mesh->triangles.push_back({at(ring, i), at(ring + 1, i), at(ring, i + 1)});
      if (ring + 1 < rings)
        mesh->triangles.push_back({at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1)});
    }
  }
  return mesh;
}

Vector3d OnBall(double u, double v) {
  const double longitude = 2.0 * std::numbers::pi * u, latitude = std::numbers::pi * v;
  return {std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
          std::cos(latitude)};
}

// Of 20 * 4^halvings triangles that are about equal.
core::SharedMesh BumpyBall(int halvings) {
  const double g = std::numbers::phi;
  core::TriangleMesh mesh{
      {{-1, g, 0},
       {1, g, 0},
       {-1, -g, 0},
       {1, -g, 0},
       {0, -1, g},
       {0, 1, g},
       {0, -1, -g},
       {0, 1, -g},
       {g, 0, -1},
       {g, 0, 1},
       {-g, 0, -1},
       {-g, 0, 1}},
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int i = 0; i < halvings; ++i) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [found, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(mesh.vertices_mm.size()));
      if (is_new)
        mesh.vertices_mm.emplace_back(mesh.vertices_mm[static_cast<std::size_t>(a)].normalized() +
                                      mesh.vertices_mm[static_cast<std::size_t>(b)].normalized());
      return found->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vector3d& vertex : mesh.vertices_mm) {
    const Vector3d n = vertex.normalized();
    vertex = (100.0 + 4.0 * std::sin(7.0 * n.x()) * std::sin(5.0 * n.y() + n.z())) * n;
  }
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

// A box, finely divided.
core::SharedMesh FineBox(int divisions) {
  auto mesh = std::make_shared<core::TriangleMesh>();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      const auto first = static_cast<std::int32_t>(mesh->vertices_mm.size());
      for (int i = 0; i <= divisions; ++i) {
        for (int k = 0; k <= divisions; ++k) {
          Vector3d at;
          at[axis] = side;
          at[(axis + 1) % 3] = static_cast<double>(i) / divisions;
          at[(axis + 2) % 3] = static_cast<double>(k) / divisions;
          mesh->vertices_mm.emplace_back(at.cwiseProduct(kBoxMm));
        }
      }
      for (int i = 0; i < divisions; ++i) {
        for (int k = 0; k < divisions; ++k) {
          const std::int32_t a = first + i * (divisions + 1) + k, b = a + divisions + 1;
          if (side > 0.0) {
            mesh->triangles.push_back({a, b, a + 1});
            mesh->triangles.push_back({a + 1, b, b + 1});
          } else {
            mesh->triangles.push_back({a, a + 1, b});
            mesh->triangles.push_back({a + 1, b + 1, b});
          }
        }
      }
    }
  }
  return mesh;
}

std::vector<DetailLevel> LevelsOf(const core::TriangleMesh& mesh) {
  return MakeDetailLevels(mesh, PrepareSurface(mesh, kCreaseRad));
}

Vector3f At(const std::vector<float>& floats, std::size_t first) { return Vector3f(floats.data() + first); }

double SlowFarthestMm(const core::TriangleMesh& mesh, const DetailLevel& level) {
  double farthest_mm = 0.0;
  for (const Vector3d& vertex : mesh.vertices_mm) {
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < level.corners.size(); i += 18) {
      const Vector3d p = core::NearestOnTriangle(vertex, At(level.corners, i).cast<double>(),
                                                 At(level.corners, i + 6).cast<double>(),
                                                 At(level.corners, i + 12).cast<double>());
      nearest_mm = std::min(nearest_mm, (p - vertex).norm());
    }
    farthest_mm = std::max(farthest_mm, nearest_mm);
  }
  return farthest_mm;
}

TEST(DetailLevels, EachIsCoarserAndItsErrorIsTheFarthestThatAVertexIsFromIt) {
  const core::SharedMesh ball = BumpyBall(5);
  const std::vector<DetailLevel> levels = LevelsOf(*ball);
  ASSERT_GE(levels.size(), 2U);
  auto triangles = static_cast<std::int64_t>(ball->triangles.size());
  for (const DetailLevel& level : levels) {
    EXPECT_LT(level.triangles, triangles * 6 / 10);
    EXPECT_EQ(level.corners.size(), 18U * static_cast<std::size_t>(level.triangles));
    triangles = level.triangles;
    constexpr double kSinglePrecisionMm = 2e-5;  // what is drawn is in floats
    EXPECT_NEAR(level.error_mm, SlowFarthestMm(*ball, level), kSinglePrecisionMm);
    EXPECT_GT(level.error_mm, 0.0);
  }
}

TEST(DetailLevels, CoarseCurvesAreShadedLikeFineOnes) {
  const core::SharedMesh ball =
      Closed(200, 100, [](double u, double v) -> Vector3d { return 50.0 * OnBall(u, v); });
  for (const DetailLevel& level : LevelsOf(*ball)) {
    for (std::size_t i = 0; i < level.corners.size(); i += 6) {
      const Vector3f place = At(level.corners, i), normal = At(level.corners, i + 3);
      ASSERT_GT(normal.dot(place.normalized()), 0.9995F);
    }
  }
}

TEST(DetailLevels, FlatFacesAreExactWithFewTriangles) {
  const core::SharedMesh box = FineBox(40);
  const std::vector<DetailLevel> levels = LevelsOf(*box);
  ASSERT_FALSE(levels.empty());
  constexpr double kRoundingMm = 1e-5;
  for (const DetailLevel& level : levels) {
    EXPECT_LT(level.error_mm, kRoundingMm);
    for (std::size_t i = 3; i < level.corners.size(); i += 6)
      ASSERT_NEAR(At(level.corners, i).lpNorm<Eigen::Infinity>(), 1.0F, 1e-5F);
  }
  EXPECT_LT(levels.back().triangles, 2000);  // of 19,200
}

TEST(DetailLevels, NoneOnceTheyAreNotWanted) {
  std::stop_source stop;
  stop.request_stop();
  const core::SharedMesh ball = BumpyBall(4);
  EXPECT_TRUE(MakeDetailLevels(*ball, PrepareSurface(*ball, kCreaseRad), stop.get_token()).empty());
}

Scene SceneOf(const core::SharedMesh& mesh, double distance_mm) {
  Scene scene;
  OrbitCamera camera;
  camera.distance_mm = distance_mm;
  scene.view = ViewFrom(camera, 320, 240);
  scene.parts = {{mesh, {}, {0.1F, 0.1F, 0.8F}}};
  scene.lamp = LampOver(core::BoundsOf(*mesh));
  return scene;
}

struct Difference {
  double mean = 0.0;  // of 255
  int largest = 0;
};
Difference Between(const Image& a, const Image& b) {
  Difference difference;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const int by = std::abs(int{a.rgb[i]} - int{b.rgb[i]});
    difference.mean += by / static_cast<double>(a.rgb.size());
    difference.largest = std::max(difference.largest, by);
  }
  return difference;
}

class LevelsInPictures : public ::testing::Test {
 protected:
  const core::SharedMesh ball_ = BumpyBall(7);
  const Scene scene_ = SceneOf(ball_, 600.0);
};

TEST_F(LevelsInPictures, ShowWhatTheWholeShowsWithAFractionOfItsTriangles) {
  SceneRenderer whole(PartDetail::kWhole), renderer(PartDetail::kOnDemand);
  const Image expected = whole.Render(scene_);
  EXPECT_EQ(renderer.Render(scene_).rgb, expected.rgb);  // nothing is coarser yet
  EXPECT_EQ(renderer.triangle_count().left_out, 0);
  renderer.AwaitLevels();
  const TriangleCount before = renderer.triangle_count();
  const Image picture = renderer.Render(scene_);
  const std::int64_t drawn = renderer.triangle_count().drawn - before.drawn;
  const std::int64_t left_out = renderer.triangle_count().left_out - before.left_out;
  // The lamp's picture is drawn anew, too, so that a part and its shadows are of one level.
  EXPECT_EQ(drawn + left_out, 2 * static_cast<std::int64_t>(ball_->triangles.size()));
  EXPECT_GT(left_out, 3 * drawn);
  (void)renderer.Render(scene_);
  EXPECT_EQ(renderer.triangle_count().drawn - before.drawn, drawn + drawn / 2);
  const Difference difference = Between(picture, expected);
  EXPECT_GT(difference.mean, 0.0);
  EXPECT_LT(difference.mean, 0.1);
  EXPECT_LT(difference.largest, 64);  // a quarter of a pixel at the outline
}

TEST_F(LevelsInPictures, ThrowTheShadowsThatTheWholeThrows) {
  SceneRenderer whole(PartDetail::kWhole), renderer(PartDetail::kOnDemand);
  (void)renderer.Render(scene_);
  renderer.AwaitLevels();
  Scene moved = scene_;
  moved.parts.front().world_from_part.translation_mm = {0, 0, 40};
  const Image picture = renderer.Render(moved),
              expected = whole.Render(moved);  // the lamp's pass is coarse, too
  EXPECT_LT(Between(picture, expected).mean, 0.1);
  EXPECT_LT(Between(picture, expected).largest, 64);
}

TEST_F(LevelsInPictures, AreNotTakenWhereTheyWouldShow) {
  SceneRenderer renderer(PartDetail::kOnDemand);
  (void)renderer.Render(scene_);
  renderer.AwaitLevels();
  Scene near = scene_;
  near.view.focal_px = 100.0 * near.view.focal_px;
  const std::int64_t left_out = renderer.triangle_count().left_out;
  (void)renderer.Render(near);
  EXPECT_EQ(renderer.triangle_count().left_out, left_out);
}

TEST_F(LevelsInPictures, ChangeNoDepthByMoreThanTheyMay) {
  SceneRenderer whole(PartDetail::kWhole), renderer(PartDetail::kOnDemand);
  (void)renderer.Render(scene_);
  renderer.AwaitLevels();
  const DepthImage depth = renderer.RenderDepth(scene_), expected = whole.RenderDepth(scene_);
  int at_outline = 0, hits = 0;
  for (std::size_t i = 0; i < depth.depth_mm.size(); ++i) {
    if (expected.depth_mm[i] <= 0.0F && depth.depth_mm[i] <= 0.0F) continue;
    ++hits;
    // Where rays graze, 0.15 mm across the surface are more along the ray.
    if (std::abs(depth.depth_mm[i] - expected.depth_mm[i]) > 1.0F) ++at_outline;
  }
  EXPECT_GT(hits, 5000);
  EXPECT_LT(at_outline, hits / 200);
}

TEST(LevelMaker, MeshesThatGoMeanwhileAreNoHarm) {
  SceneRenderer renderer(PartDetail::kOnDemand);
  for (int i = 0; i < 3; ++i) (void)renderer.Render(SceneOf(BumpyBall(6), 600.0));
  renderer.AwaitLevels();
  (void)renderer.Render(SceneOf(BumpyBall(2), 600.0));
  EXPECT_EQ(renderer.cached_meshes(), 1U);
  for (int i = 0; i < 3; ++i) (void)renderer.Render(SceneOf(BumpyBall(6), 600.0));  // and end meanwhile
}

}  // namespace
}  // namespace elbowroom::recon::gl
