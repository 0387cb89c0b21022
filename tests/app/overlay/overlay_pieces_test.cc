// The overlay's pieces against slow oracles: curves through lenses, covered pixels, lines of sight.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "app/control/overlay/outlined_mesh.h"
#include "app/control/overlay/part_faces.h"
#include "app/control/overlay/projected_edge.h"
#include "app/control/overlay/sight_line.h"
#include "tests/app/overlay/overlay_samples.h"
#include "tests/oracles/camera_projection.h"
#include "tests/recon/scenes/part_samples.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using recon::Random;

double DistanceToCurve(const Vector2d& x, const std::vector<CurvePoint>& curve) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const Vector2d& a = curve[i - 1].pixel;
    const Vector2d along = curve[i].pixel - a;
    const double s =
        along.squaredNorm() > 0.0 ? std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
    least = std::min(least, (x - a - s * along).norm());
  }
  return least;
}

// Of any sample: in the frame, away from its border by a pixel or so, before the camera.
bool IsSurelyDrawn(const ViewPixels& view, const Vector3d& x_in_cam) {
  if (x_in_cam.z() < 1.01 * kOverlayNearMm) return false;
  const Vector2d normalised = x_in_cam.head<2>() / x_in_cam.z();
  return normalised.norm() < 0.999 * view.camera().max_radius() && view.frame().contains(normalised);
}

TEST(ProjectedEdge, IsNeverMoreThanHalfAPixelFromTheLensesFormulas) {
  Random random(25);
  double worst_px = 0.0;
  int samples = 0;
  for (int trial = 0; trial < 240; ++trial) {
    const ViewPixels view(
        recon::RandomCamera(&random, static_cast<recon::LensKind>(trial % recon::kLensKinds)));
    const core::CameraModel& camera = view.camera();
    // From a hair to far beyond the picture; every third passes the camera.
    const double far_mm = random.LogUniform(5.0, 5000.0);
    Vector3d a = far_mm * random.Direction(),
             b = a + random.LogUniform(0.1, 3.0) * far_mm * random.Direction();
    if (trial % 3 != 0) a.z() = std::abs(a.z()), b.z() = std::abs(b.z());
    const std::vector<CurvePoint> curve = ProjectEdge(camera, view.frame(), a, b);
    for (std::size_t i = 1; i < curve.size(); ++i)
      ASSERT_LE((curve[i].pixel - curve[i - 1].pixel).norm(), 1.0 + 1e-9);
    for (int i = 0; i <= 400; ++i) {
      const Vector3d x_in_cam = a + (b - a) * i / 400.0;
      if (!IsSurelyDrawn(view, x_in_cam)) continue;
      const Vector3d x_in_world = camera.cam_from_world().Inverse() * x_in_cam;
      const auto truth = oracles::Project(camera, x_in_world.cast<long double>());
      if (!truth) continue;
      ++samples;
      worst_px = std::max(worst_px, DistanceToCurve(truth->cast<double>(), curve));
    }
  }
  EXPECT_GT(samples, 5000);
  EXPECT_LE(worst_px, 0.5);
  RecordProperty("worst_px", std::to_string(worst_px));
}

TEST(ProjectedEdge, IsEmptyBehindTheCameraAndBesideThePicture) {
  const ViewPixels view(RigsOfEveryLens()[1].rig.cameras[0]);
  EXPECT_TRUE(ProjectEdge(view.camera(), view.frame(), {0, 0, -5}, {100, 0, -700}).empty());
  EXPECT_TRUE(ProjectEdge(view.camera(), view.frame(), {9000, 0, 700}, {9000, 9, 700}).empty());
  EXPECT_FALSE(ProjectEdge(view.camera(), view.frame(), {0, 0, -500}, {0, 10, 700}).empty());
}

// First meeting of any triangle, by its plane and areas: slow and plain.
double FirstDepth(const core::TriangleMesh& mesh, const core::RigidTransform& cam_from_part,
                  const Vector3d& ray, double* margin) {
  double first = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector3d a = cam_from_part * mesh.vertices_mm[static_cast<std::size_t>(i)],
                   b = cam_from_part * mesh.vertices_mm[static_cast<std::size_t>(j)],
                   c = cam_from_part * mesh.vertices_mm[static_cast<std::size_t>(k)];
    const Vector3d n = (b - a).cross(c - a);
    const double slope = n.dot(ray);
    if (slope == 0.0 || n.squaredNorm() == 0.0) continue;
    const double depth = n.dot(a) / slope;
    if (!(depth >= kOverlayNearMm)) continue;
    const Vector3d x = depth * ray;
    double least = std::numeric_limits<double>::infinity();  // barycentric
    least = std::min(least, (b - a).cross(x - a).dot(n) / n.squaredNorm());
    least = std::min(least, (c - b).cross(x - b).dot(n) / n.squaredNorm());
    least = std::min(least, (a - c).cross(x - c).dot(n) / n.squaredNorm());
    *margin = std::min(*margin, std::abs(least));
    if (least >= 0.0) first = std::min(first, depth);
  }
  return first;
}

TEST(PartFaces, AreTheFirstTrianglesAlongEveryPixelsRay) {
  constexpr double kUnsure = 1e-7;  // barycentric: a ray so near to a side may go either way
  Random random(2525);
  int compared = 0, covered = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const ViewPixels view(
        recon::RandomCamera(&random, static_cast<recon::LensKind>(trial % recon::kLensKinds)));
    const core::TriangleMesh mesh =
        recon::RandomTriangles(&random, {Vector3d::Constant(-150.0), Vector3d::Constant(150.0)}, 12);
    const core::RigidTransform cam_from_part = view.camera().cam_from_world();
    const PartFaces faces = DrawFaces(view, mesh, cam_from_part);
    for (int y = 0; y < view.camera().height_px(); y += 3) {
      for (int x = 0; x < view.camera().width_px(); x += 3) {
        const auto normalised = view.camera().NormalisedFromPixel({x, y});
        if (!normalised) continue;
        double margin = std::numeric_limits<double>::infinity();
        const double truth_mm = FirstDepth(mesh, cam_from_part, normalised->homogeneous(), &margin);
        if (margin < kUnsure || std::abs(truth_mm - kOverlayNearMm) < 1e-3) continue;
        const bool is_in =
            x >= faces.box.x && x < faces.box.right && y >= faces.box.y && y < faces.box.bottom;
        const float depth_mm = is_in ? faces.depth_mm[faces.At(x, y)] : 0.0F;
        ++compared;
        if (std::isinf(truth_mm)) {
          ASSERT_EQ(depth_mm, 0.0F) << trial << ": " << x << ", " << y;
        } else {
          ++covered;
          ASSERT_NEAR(depth_mm, truth_mm, 2e-3 * truth_mm) << trial << ": " << x << ", " << y;
        }
      }
    }
  }
  EXPECT_GT(compared, 20'000);
  EXPECT_GT(covered, 1'000);
}

TEST(SightLine, IsBrokenExactlyWhereATriangleOfAllMeetsIt) {
  Random random(252525);
  int hidden = 0, open = 0;
  const Eigen::AlignedBox3d box(Vector3d::Constant(-100.0), Vector3d::Constant(100.0));
  for (int trial = 0; trial < 40; ++trial) {
    const core::TriangleTree tree(
        std::make_shared<const core::TriangleMesh>(recon::RandomTriangles(&random, box, 60)));
    for (int i = 0; i < 200; ++i) {
      const Vector3d eye = random.PointIn({Vector3d::Constant(-300.0), Vector3d::Constant(300.0)}),
                     x = random.PointIn(box);
      double margin = std::numeric_limits<double>::infinity();
      // As a camera at the eye whose z axis is the line: depth in shares of the way.
      bool is_hidden = false;
      for (const auto& [p, q, r] : tree.mesh().triangles) {
        const Vector3d a = tree.mesh().vertices_mm[static_cast<std::size_t>(p)] - eye,
                       b = tree.mesh().vertices_mm[static_cast<std::size_t>(q)] - eye,
                       c = tree.mesh().vertices_mm[static_cast<std::size_t>(r)] - eye;
        const Vector3d n = (b - a).cross(c - a);
        if (n.squaredNorm() == 0.0 || n.dot(x - eye) == 0.0) continue;
        const double share = n.dot(a) / n.dot(x - eye);
        const Vector3d at = share * (x - eye);
        const double least = std::min({(b - a).cross(at - a).dot(n), (c - b).cross(at - b).dot(n),
                                       (a - c).cross(at - c).dot(n)}) /
                             n.squaredNorm();
        if (share > -1e-6 && share < 1.0 + 1e-6)
          margin = std::min({margin, std::abs(least), std::max(1e-9, std::abs(share - 1.0))});
        is_hidden = is_hidden || (least >= 0.0 && share > 0.0 && share < 1.0 - 1e-6);
      }
      if (margin < 1e-7) continue;
      ASSERT_EQ(IsHidden(tree, eye, x), is_hidden) << trial << ' ' << i;
      ++(is_hidden ? hidden : open);
    }
  }
  EXPECT_GT(hidden, 300);
  EXPECT_GT(open, 300);
}

TEST(OutlinedMesh, KeepsSharpEdgesAndFindsTheOutlineOfRoundParts) {
  const auto outlined = [](core::TriangleMesh mesh) {
    return OutlinedMesh(std::make_shared<const core::TriangleMesh>(std::move(mesh)));
  };
  const OutlinedMesh box = outlined(BoxMesh({10, 20, 30}));
  EXPECT_EQ(box.edges().size(), 12U);  // diagonals of its faces are none
  EXPECT_TRUE(std::ranges::all_of(box.edges(), &MeshEdge::is_sharp));
  EXPECT_EQ(box.EdgesSeenFrom({500, 600, 700}).size(), 12U);

  const OutlinedMesh ball = outlined(BallMesh(50.0, 64));
  EXPECT_TRUE(std::ranges::none_of(ball.edges(), &MeshEdge::is_sharp));
  // Each point of the outline is within a facet of the circle where lines of sight graze the ball.
  const Vector3d eye(0.0, 400.0, 30.0);
  const std::vector<MeshEdge> outline = ball.EdgesSeenFrom(eye);
  EXPECT_GT(outline.size(), 60U);
  for (const MeshEdge& edge : outline) {
    const Vector3d& x = ball.mesh().vertices_mm[static_cast<std::size_t>(edge.from)];
    EXPECT_LT(std::abs(x.dot(eye - x)) / (50.0 * (eye - x).norm()), 0.15);
  }
}

TEST(OutlinedMesh, WeldsCornersAtOnePlaceAndDrawsOpenRims) {
  core::TriangleMesh soup;  // a square of two triangles that share no corner
  soup.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}, {3, 4, 5}};
  const OutlinedMesh square(std::make_shared<const core::TriangleMesh>(soup));
  EXPECT_EQ(square.edges().size(), 4U);
  EXPECT_TRUE(std::ranges::all_of(square.edges(), &MeshEdge::is_sharp));
}

TEST(ScaledTo, KeepsEveryRay) {
  for (const NamedRig& named : RigsOfEveryLens()) {
    const core::CameraModel& camera = named.rig.cameras.front();
    const core::CameraModel small = ScaledTo(camera, camera.width_px() / 4, camera.height_px() / 3);
    for (const Vector2d& pixel : {Vector2d(3, 5), Vector2d(40.25, 22), Vector2d(77, 61.5)}) {
      const auto ray = small.NormalisedFromPixel(pixel);
      ASSERT_TRUE(ray);
      const double across = static_cast<double>(camera.width_px()) / small.width_px(),
                   down = static_cast<double>(camera.height_px()) / small.height_px();
      const Vector2d same((pixel.x() + 0.5) * across - 0.5, (pixel.y() + 0.5) * down - 0.5);
      EXPECT_LT((camera.PixelFromNormalised(*ray) - same).norm(), 1e-8) << named.name;
    }
  }
}

}  // namespace
}  // namespace elbowroom::control
