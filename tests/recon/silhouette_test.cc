#include "recon/silhouette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/recon/random_scene.h"

namespace elbowroom::recon {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// What silhouette.h promises.
constexpr double kExactWithinPx = 2.0;
constexpr double kExactTolerancePx = 1e-6;
constexpr double kShortfallPx = 1.5;

bool LabelByHand(const core::BitMask& mask, bool exterior, double x, double y) {
  const double i = std::floor(x + 0.5), j = std::floor(y + 0.5);
  if (i < 0 || j < 0 || i >= mask.width_px() || j >= mask.height_px()) return exterior;
  return mask.At(static_cast<int>(i), static_cast<int>(j));
}

double DistanceToSquare(double x, double y, int i, int j) {
  return std::hypot(std::max(std::abs(x - i) - 0.5, 0.0), std::max(std::abs(y - j) - 0.5, 0.0));
}

// Distance to the nearest position of the other label, square by square; the exterior is four half-planes.
double DistanceByHand(const core::BitMask& mask, bool exterior, double x, double y) {
  const bool label = LabelByHand(mask, exterior, x, y);
  double nearest = kInfinity;
  for (int j = 0; j < mask.height_px(); ++j) {
    for (int i = 0; i < mask.width_px(); ++i) {
      if (mask.At(i, j) != label) nearest = std::min(nearest, DistanceToSquare(x, y, i, j));
    }
  }
  if (label == exterior) return nearest;
  return std::min({nearest, x + 0.5, y + 0.5, mask.width_px() - 0.5 - x, mask.height_px() - 0.5 - y});
}

void ExpectPromiseHolds(const Silhouette& silhouette, bool exterior, const Eigen::Vector2d& at) {
  const PixelLabel label = silhouette.LabelAt(at);
  ASSERT_EQ(label.is_object, LabelByHand(silhouette.mask(), exterior, at.x(), at.y())) << at.transpose();
  ASSERT_EQ(label.is_object, silhouette.IsObject(at));
  const double truth_px = DistanceByHand(silhouette.mask(), exterior, at.x(), at.y());
  ASSERT_LE(label.distance_px, truth_px) << at.transpose();
  ASSERT_GE(label.distance_px, 0.0) << at.transpose();
  if (std::isinf(truth_px)) {
    ASSERT_TRUE(std::isinf(label.distance_px));
  } else if (!silhouette.IsInImage(at)) {
    const Eigen::AlignedBox2d image(
        Eigen::Vector2d(-0.5, -0.5),
        Eigen::Vector2d(silhouette.mask().width_px() - 0.5, silhouette.mask().height_px() - 0.5));
    ASSERT_GE(label.distance_px, image.exteriorDistance(at) - kExactTolerancePx) << at.transpose();
  } else {
    const double tolerance_px = truth_px < kExactWithinPx ? kExactTolerancePx : kShortfallPx;
    ASSERT_GE(label.distance_px, truth_px - tolerance_px) << at.transpose();
  }
}

TEST(Silhouette, DistanceFieldKeepsItsPromiseAgainstAllPixelSquares) {
  Random random(11);
  for (int trial = 0; trial < 120; ++trial) {
    const core::BitMask mask = RandomMask(&random, random.Whole(1, 70), random.Whole(1, 50));
    const bool exterior = random.Chance(0.5);
    const Silhouette silhouette(mask, exterior);
    for (int i = 0; i < 120; ++i) {
      const Eigen::Vector2d at(random.Uniform(-8.0, mask.width_px() + 8.0),
                               random.Uniform(-8.0, mask.height_px() + 8.0));
      ExpectPromiseHolds(silhouette, exterior, at);
      // On the squares' own edges and corners, where labels change.
      ExpectPromiseHolds(silhouette, exterior, {std::round(at.x()) - 0.5, at.y()});
      ExpectPromiseHolds(silhouette, exterior, {std::round(at.x()) - 0.5, std::round(at.y()) + 0.5});
    }
  }
}

TEST(Silhouette, UniformPictureReachesForever) {
  for (const bool object : {false, true}) {
    core::BitMask mask(5, 4);
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 5; ++x) mask.Set(x, y, object);
    }
    const Silhouette same(mask, object);
    EXPECT_EQ(same.LabelAt({2, 2}).distance_px, kInfinity);
    EXPECT_EQ(same.LabelAt({-200, 2}).distance_px, kInfinity);
    const Silhouette differs(mask, !object);
    EXPECT_NEAR(differs.LabelAt({2, 2}).distance_px, 1.5, kExactTolerancePx);
    EXPECT_NEAR(differs.LabelAt({-3.5, 2}).distance_px, 3.0, kExactTolerancePx);
  }
}

TEST(Silhouette, FarAndHugePositionsAreExterior) {
  core::BitMask mask(8, 8);
  mask.Set(0, 0, true);
  const Silhouette silhouette(mask, false);
  for (const double far : {-1e300, -1e9, 1e9, 1e300}) {
    EXPECT_FALSE(silhouette.IsObject({far, 3.0}));
    EXPECT_FALSE(silhouette.IsInImage({far, 3.0}));
    EXPECT_GT(silhouette.LabelAt({far, 3.0}).distance_px, 1e8);
  }
}

TEST(Silhouette, OutwardDirectionOfADiscIsRadial) {
  core::BitMask mask(101, 101);
  for (int y = 0; y < 101; ++y) {
    for (int x = 0; x < 101; ++x) mask.Set(x, y, std::hypot(x - 50, y - 50) <= 30.0);
  }
  const Silhouette silhouette(mask, false);
  for (int i = 0; i < 64; ++i) {
    const double angle_rad = 2.0 * M_PI * i / 64;
    const Eigen::Vector2d radial(std::cos(angle_rad), std::sin(angle_rad));
    const Eigen::Vector2d outward = silhouette.OutwardDirection(Eigen::Vector2d(50, 50) + 30.0 * radial, 4.0);
    // A staircase's direction, averaged over 8 px: within 10 degrees of the circle's.
    constexpr double kCosine10Deg = 0.9848;
    EXPECT_GT(outward.dot(radial), kCosine10Deg) << i;
  }
}

}  // namespace
}  // namespace elbowroom::recon
