#include "recon/contours/contour.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "tests/oracles/picture_labels.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using oracles::PictureLabels;

core::CameraModel CameraOf(int width_px, int height_px, std::vector<double> coefficients = {}) {
  core::CameraCalibration c;
  c.name = "camera";
  c.image_width_px = width_px, c.image_height_px = height_px;
  c.camera_matrix << 200.0, 0.0, 0.45 * width_px, 0.0, 200.0, 0.55 * height_px, 0.0, 0.0, 1.0;
  c.distortion_coefficients = std::move(coefficients);
  return core::CameraModel(c);
}

Vector2d InPlane(const UndistortedPlane& plane, double x, double y) { return *plane.FromPixel({x, y}); }

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

void ExpectClosedLoops(const Contour& contour) {
  ASSERT_EQ(contour.edges.size(), contour.vertices.size());
  ASSERT_EQ(contour.edge_from.size(), contour.vertices.size());
  ASSERT_EQ(contour.edge_to.size(), contour.vertices.size());
  for (std::uint32_t v = 0; v < contour.vertices.size(); ++v) {
    ASSERT_EQ(contour.edges[contour.edge_from[v]].from, v);
    ASSERT_EQ(contour.edges[contour.edge_to[v]].to, v);
    ASSERT_TRUE(contour.vertices[v].allFinite());
  }
}

// A little to the left of each edge (y down: to its right) there is object, to its other side none.
void ExpectObjectOnTheLeft(const Contour& contour, bool exterior) {
  constexpr double kBesidePx = 1e-4;
  for (const ContourEdge& edge : contour.edges) {
    const Vector2d a = contour.vertices[edge.from], b = contour.vertices[edge.to];
    if ((b - a).norm() < 0.05) continue;  // another edge may be as near
    const Vector2d across = kBesidePx * Vector2d(-(b - a).y(), (b - a).x()).normalized();
    const Vector2d middle = 0.5 * (a + b);
    EXPECT_GT(Cross(b - a, across), 0.0);
    EXPECT_TRUE(IsObjectByParity(contour, exterior, middle + across));
    EXPECT_FALSE(IsObjectByParity(contour, exterior, middle - across));
  }
}

// Labels by the contour's parity against the definition, cell by cell.
void ExpectLabelsOfThePicture(Random* random, const Contour& contour, const PictureLabels& labels,
                              bool exterior, const UndistortedPlane& plane, double band_px) {
  const core::CameraModel& camera = plane.camera();
  for (int i = 0; i < 150; ++i) {
    const Vector2d pixel(random->Uniform(-2.0, camera.width_px() + 1.0),
                         random->Uniform(-2.0, camera.height_px() + 1.0));
    const std::optional<Vector2d> normalised = camera.NormalisedFromPixel(pixel);
    if (!normalised) continue;
    const oracles::Vector2L at = pixel.cast<long double>();
    if (labels.IsObject(at, band_px) != labels.IsObject(at, -band_px)) continue;
    EXPECT_EQ(IsObjectByParity(contour, exterior, plane.focal_px() * *normalised), labels.IsObject(at))
        << pixel.transpose();
  }
}

PictureLabels LabelsOf(const core::SoftMask& silhouette, bool exterior) {
  return {silhouette, oracles::BoundaryConvention::kMarchingSquares, exterior};
}

core::SoftMask RandomSilhouette(Random* random, int width_px, int height_px) {
  core::BitMask mask = RandomMask(random, width_px, height_px);
  return random->Chance(0.5) ? RandomLevels(random, std::move(mask)) : core::SoftMask{std::move(mask), {}};
}

TEST(Contour, IsClosedAndHasTheObjectOnOneSideForEveryWidthAndExterior) {
  Random random(5101);
  std::vector<int> widths = {1, 2, 3, 126, 127, 128, 129};
  for (int width = 61; width <= 67; ++width) widths.push_back(width);
  for (const int width_px : widths) {
    for (int trial = 0; trial < 16; ++trial) {
      const int height_px = random.Whole(1, 20);
      const UndistortedPlane plane(CameraOf(width_px, height_px));
      const core::SoftMask silhouette = RandomSilhouette(&random, width_px, height_px);
      const bool exterior = trial % 2 == 1;
      const Contour contour = TraceContour(silhouette, exterior, plane);
      ExpectClosedLoops(contour);
      ExpectObjectOnTheLeft(contour, exterior);
      constexpr double kRoundingPx = 1e-9;
      ExpectLabelsOfThePicture(&random, contour, LabelsOf(silhouette, exterior), exterior, plane,
                               kRoundingPx);
      if (HasFailure()) FAIL() << width_px << " x " << height_px << ", trial " << trial;
    }
  }
}

TEST(Contour, LabelsAreThoseOfThePictureThroughEveryLens) {
  Random random(5102);
  for (int trial = 0; trial < 150; ++trial) {
    const core::CameraModel camera = RandomCamera(&random, static_cast<LensKind>(trial % kLensKinds));
    const UndistortedPlane plane(camera);
    if (plane.unseen_pixels()) continue;  // below
    const core::SoftMask silhouette = RandomSilhouette(&random, camera.width_px(), camera.height_px());
    const bool exterior = random.Chance(0.5);
    const Contour contour = TraceContour(silhouette, exterior, plane);
    ExpectClosedLoops(contour);
    // Pictures of 40 px through lenses of 100 degrees: a pixel bends by some thousandths.
    constexpr double kCoarsePx = 2e-2;
    ExpectLabelsOfThePicture(&random, contour, LabelsOf(silhouette, exterior), exterior, plane, kCoarsePx);
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

// What docs/frames_and_units.md says of an ordinary lens: edges are straight in the plane, and that is less
// than a thousandth of a pixel off.
TEST(Contour, StraightEdgesAreWithinAThousandthOfAPixelOfTheLens) {
  core::CameraCalibration c;
  c.image_width_px = 640, c.image_height_px = 480;
  c.camera_matrix << 620.0, 0.0, 320.0, 0.0, 620.0, 240.0, 0.0, 0.0, 1.0;
  c.distortion_coefficients = {-0.37, 0.17, 1e-3, -1e-3, -0.04};
  const UndistortedPlane plane{core::CameraModel(c)};
  double worst_px = 0.0;
  for (int y = 0; y < 479; y += 3) {
    for (int x = 0; x < 639; x += 3) {
      const Vector2d a(x + 0.5, y), b(x, y + 0.5);  // the longest edges but the straight ones
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{a, Vector2d(x + 0.5, y + 1.0)}}) {
        const Vector2d chord =
            0.5 * (*plane.camera().NormalisedFromPixel(from) + *plane.camera().NormalisedFromPixel(to));
        worst_px = std::max(worst_px, (plane.camera().PixelFromNormalised(chord) - 0.5 * (from + to)).norm());
      }
    }
  }
  EXPECT_LT(worst_px, 1e-3);
  RecordProperty("worst_px", std::to_string(worst_px));
}

TEST(Contour, CrossesBetweenCentresWhereTheLevelsSay) {
  Random random(5103);
  const UndistortedPlane plane(CameraOf(70, 9));
  for (int trial = 0; trial < 40; ++trial) {
    const core::SoftMask silhouette = RandomSilhouette(&random, 70, 9);
    const bool exterior = trial % 2 == 0;
    const PictureLabels labels = LabelsOf(silhouette, exterior);
    const auto share = [&](int x, int y, int dx, int dy) {
      return static_cast<double>(labels.CrossingShare(x, y, x + dx, y + dy));
    };
    const Contour contour = TraceContour(silhouette, exterior, plane);
    std::vector<Vector2d> expected;
    for (int y = -1; y <= 9; ++y) {
      for (int x = -1; x <= 70; ++x) {
        if (labels.IsObjectPixel(x, y) != labels.IsObjectPixel(x + 1, y))
          expected.push_back(InPlane(plane, x + share(x, y, 1, 0), y));
        if (labels.IsObjectPixel(x, y) != labels.IsObjectPixel(x, y + 1))
          expected.push_back(InPlane(plane, x, y + share(x, y, 0, 1)));
      }
    }
    ASSERT_EQ(contour.vertices.size(), expected.size());
    const auto order = [](const Vector2d& a, const Vector2d& b) {
      return std::pair(a.y(), a.x()) < std::pair(b.y(), b.x());
    };
    std::vector<Vector2d> found = contour.vertices;
    // Rounding must not change the order: round both alike.
    for (auto* list : {&expected, &found}) {
      for (Vector2d& v : *list) v = (v * 1e9).array().round().matrix() / 1e9;
      std::sort(list->begin(), list->end(), order);
    }
    for (std::size_t i = 0; i < found.size(); ++i)
      ASSERT_LE((found[i] - expected[i]).norm(), 3e-9) << "trial " << trial;
  }
}

TEST(Contour, JoinsObjectPixelsThatTouchAcrossACorner) {
  const UndistortedPlane plane(CameraOf(4, 4));
  for (const bool falls : {true, false}) {
    core::SoftMask silhouette{core::BitMask(4, 4), {}};
    silhouette.mask.Set(1, falls ? 1 : 2, true);
    silhouette.mask.Set(2, falls ? 2 : 1, true);
    const Contour contour = TraceContour(silhouette, false, plane);
    ExpectClosedLoops(contour);
    EXPECT_EQ(contour.edges.size(), 8U) << "one loop around both";
    EXPECT_TRUE(IsObjectByParity(contour, false, InPlane(plane, 1.5, 1.5)));
    core::BitMask holes = silhouette.mask;
    for (int i = 0; i < 16; ++i) holes.Set(i % 4, i / 4, !holes.At(i % 4, i / 4));
    const Contour around_holes = TraceContour({holes, {}}, true, plane);
    EXPECT_EQ(around_holes.edges.size(), 8U);
    EXPECT_TRUE(IsObjectByParity(around_holes, true, InPlane(plane, 1.5, 1.5))) << "two holes stay two";
  }
}

TEST(Contour, UniformPicturesAndTheirExteriors) {
  const UndistortedPlane plane(CameraOf(65, 3));
  core::SoftMask all{core::BitMask(65, 3), {}};
  const core::SoftMask none = all;
  for (int i = 0; i < 195; ++i) all.mask.Set(i % 65, i / 65, true);
  EXPECT_TRUE(TraceContour(none, false, plane).edges.empty());
  EXPECT_TRUE(TraceContour(all, true, plane).edges.empty());
  // The picture's border, with its corners cut: a vertex a border pixel and side.
  for (const bool exterior : {false, true}) {
    const Contour contour = TraceContour(exterior ? none : all, exterior, plane);
    ExpectClosedLoops(contour);
    EXPECT_EQ(contour.vertices.size(), 2U * (65 + 3));
    Eigen::AlignedBox2d bounds;
    for (const Vector2d& v : contour.vertices) bounds.extend(v);
    constexpr double kRounding = 1e-12;
    EXPECT_TRUE(bounds.min().isApprox(InPlane(plane, -0.5, -0.5), kRounding));
    EXPECT_TRUE(bounds.max().isApprox(InPlane(plane, 64.5, 2.5), kRounding));
  }
}

TEST(Contour, PixelsThatAFoldingLensDoesNotSeeAreExterior) {
  Random random(5104);
  const core::CameraModel camera = CameraOf(120, 100, {-2.2, 0.0, 0.0, 0.0});
  const UndistortedPlane plane(camera);
  ASSERT_TRUE(plane.unseen_pixels().has_value());
  for (int trial = 0; trial < 20; ++trial) {
    const core::SoftMask silhouette = RandomSilhouette(&random, 120, 100);
    const bool exterior = trial % 2 == 0;
    const Contour contour = TraceContour(silhouette, exterior, plane);
    ExpectClosedLoops(contour);
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 120; ++x) {
        const std::optional<Vector2d> normalised = camera.NormalisedFromPixel({x, y});
        if (!normalised) continue;
        // Vertices beside an unseen pixel may stand as near to the seen one as the lens sees.
        bool beside_unseen = false;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, 99); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, 119); ++u)
            beside_unseen = beside_unseen || plane.unseen_pixels()->At(u, v);
        if (beside_unseen) continue;
        EXPECT_EQ(IsObjectByParity(contour, exterior, plane.focal_px() * *normalised),
                  silhouette.mask.At(x, y))
            << x << ' ' << y;
      }
    }
    // Beyond the lens's domain everything is exterior.
    for (int i = 0; i < 20; ++i) {
      const Vector2d aside = random.Direction().head<2>().normalized();
      const Vector2d beyond = plane.focal_px() * camera.max_radius() * random.Uniform(1.001, 3.0) * aside;
      EXPECT_EQ(IsObjectByParity(contour, exterior, beyond), exterior);
    }
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

TEST(Contour, TangentsFollowTheLoopAndNeverTurnBack) {
  const UndistortedPlane plane(CameraOf(40, 40));
  // A single pixel's loop has four edges, two pixels' six: shorter than the smoothing reaches.
  for (const int pixels : {1, 2, 3, 4}) {
    core::SoftMask silhouette{core::BitMask(40, 40), {}};
    for (int i = 0; i < pixels; ++i) silhouette.mask.Set(20 + i, 20, true);
    const Contour contour = TraceContour(silhouette, false, plane);
    for (std::uint32_t i = 0; i < contour.edges.size(); ++i) {
      const ContourEdge& edge = contour.edges[i];
      const Vector2d along = contour.vertices[edge.to] - contour.vertices[edge.from];
      EXPECT_GE(SmoothTangent(contour, i).dot(along), 0.0) << pixels << " pixels, edge " << i;
      const Eigen::Vector3d outward = OutwardNormalInCam(contour, i, plane.focal_px());
      constexpr double kUnit = 1e-12;
      EXPECT_NEAR(outward.norm(), 1.0, kUnit);
      const Vector2d middle = 0.5 * (contour.vertices[edge.from] + contour.vertices[edge.to]);
      const Vector2d from_blob = middle - InPlane(plane, 20 + 0.5 * (pixels - 1), 20);
      EXPECT_GT(outward.head<2>().dot(from_blob), 0.0) << pixels << " pixels, edge " << i;
      EXPECT_NEAR(outward.dot(Eigen::Vector3d(middle.x(), middle.y(), plane.focal_px())), 0.0, 1e-9)
          << "the camera's centre is in the plane";
    }
  }
}

TEST(Contour, NormalsOfAReadyDiscAreRadial) {
  const UndistortedPlane plane(CameraOf(101, 101));
  core::SoftMask silhouette{core::BitMask(101, 101), {}};
  for (int y = 0; y < 101; ++y)
    for (int x = 0; x < 101; ++x) silhouette.mask.Set(x, y, std::hypot(x - 50, y - 50) <= 30.0);
  const Contour contour = TraceContour(silhouette, false, plane);
  for (std::uint32_t i = 0; i < contour.edges.size(); ++i) {
    const Vector2d middle =
        0.5 * (contour.vertices[contour.edges[i].from] + contour.vertices[contour.edges[i].to]);
    const Vector2d radial = (middle - InPlane(plane, 50, 50)).normalized();
    const Vector2d outward = OutwardNormalInCam(contour, i, plane.focal_px()).head<2>().normalized();
    // A staircase's direction over seven edges: within 15 degrees of the circle's.
    constexpr double kCosine15Deg = 0.9659;
    EXPECT_GT(outward.dot(radial), kCosine15Deg) << i;
  }
}

TEST(Contour, RefusesMasksThatDontFit) {
  const UndistortedPlane plane(CameraOf(5, 4));
  EXPECT_THROW((void)TraceContour({core::BitMask(4, 5), {}}, false, plane), core::PreconditionError);
  core::SoftMask few{core::BitMask(5, 4), {200}};
  few.mask.Set(2, 2, true);
  EXPECT_THROW((void)TraceContour(few, false, plane), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
