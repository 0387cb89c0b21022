#include "tests/oracles/picture_labels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace elbowroom::oracles {
namespace {

constexpr double kTinyPx = 1e-9;  // beside a boundary, either way

// Left two columns object; the boundary's level is `object` on the left and `background` on the right of it.
core::SoftMask TwoColumns(std::uint8_t object, std::uint8_t background) {
  core::SoftMask mask{core::BitMask(4, 3), {}};
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 2; ++x) mask.mask.Set(x, y, true);
    mask.levels.insert(mask.levels.end(), {object, background});
  }
  return mask;
}

TEST(PictureLabels, SquaresCarryTheirPixelsBit) {
  const PictureLabels labels(TwoColumns(255, 0), BoundaryConvention::kPixelSquares, false);
  EXPECT_TRUE(labels.IsObject({1.5L - kTinyPx, 1.0L}));
  EXPECT_FALSE(labels.IsObject({1.5L, 1.0L}));
  EXPECT_TRUE(labels.IsObject({-0.5L, -0.5L}));
  EXPECT_FALSE(labels.IsObject({-0.5L - kTinyPx, 0.0L}));
}

TEST(PictureLabels, TheBoundaryCrossesWhereTheLevelsSay) {
  for (const auto& [object, background] : {std::pair{255, 0}, {200, 10}, {128, 0}, {255, 127}, {130, 100}}) {
    const PictureLabels labels(
        TwoColumns(static_cast<std::uint8_t>(object), static_cast<std::uint8_t>(background)),
        BoundaryConvention::kMarchingSquares, false);
    const long double x = 1.0L + (object - 127.5L) / (object - background);
    for (const long double y : {0.0L, 0.7L, 2.0L}) {
      EXPECT_TRUE(labels.IsObject({x - kTinyPx, y}));
      EXPECT_FALSE(labels.IsObject({x + kTinyPx, y}));
    }
    // Then straight to the picture's border, above the object's last pixel.
    EXPECT_TRUE(labels.IsObject({0.5L * (x + 1.0L) - kTinyPx, -0.25L}));
    EXPECT_FALSE(labels.IsObject({0.5L * (x + 1.0L) + kTinyPx, -0.25L}));
    EXPECT_FALSE(labels.IsObject({1.0L, -0.5L - kTinyPx}));
  }
}

TEST(PictureLabels, ReadyMasksHaveTheirBoundaryHalfway) {
  core::SoftMask mask = TwoColumns(255, 0);
  mask.levels.clear();
  const PictureLabels labels(mask, BoundaryConvention::kMarchingSquares, false);
  EXPECT_TRUE(labels.IsObject({1.5L - kTinyPx, 1.0L}));
  EXPECT_FALSE(labels.IsObject({1.5L + kTinyPx, 1.0L}));
}

TEST(PictureLabels, ASinglePixelIsADiamondAndAHoleTheSame) {
  core::SoftMask dot{core::BitMask(5, 5), {}}, hole{core::BitMask(5, 5), {}};
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) hole.mask.Set(x, y, x != 2 || y != 2);
  dot.mask.Set(2, 2, true);
  const PictureLabels in_dot(dot, BoundaryConvention::kMarchingSquares, false);
  const PictureLabels in_hole(hole, BoundaryConvention::kMarchingSquares, false);
  for (double angle_rad = 0.05; angle_rad < 6.28; angle_rad += 0.1) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double rim_px = 0.5 / (std::abs(c) + std::abs(s));
    const Vector2L inside(2 + (rim_px - 1e-6) * c, 2 + (rim_px - 1e-6) * s);
    const Vector2L outside(2 + (rim_px + 1e-6) * c, 2 + (rim_px + 1e-6) * s);
    EXPECT_TRUE(in_dot.IsObject(inside));
    EXPECT_FALSE(in_dot.IsObject(outside));
    EXPECT_FALSE(in_hole.IsObject(inside));
    EXPECT_TRUE(in_hole.IsObject(outside));
  }
}

TEST(PictureLabels, ObjectJoinsThroughASaddle) {
  core::SoftMask mask{core::BitMask(4, 4), {}};
  mask.mask.Set(1, 1, true);
  mask.mask.Set(2, 2, true);
  const PictureLabels labels(mask, BoundaryConvention::kMarchingSquares, false);
  EXPECT_TRUE(labels.IsObject({1.5L, 1.5L}));
  EXPECT_FALSE(labels.IsObject({1.8L, 1.2L}));
  EXPECT_FALSE(labels.IsObject({1.2L, 1.8L}));
}

TEST(PictureLabels, AMovedBoundaryMovesByWhatItWasTold) {
  for (const auto convention : {BoundaryConvention::kPixelSquares, BoundaryConvention::kMarchingSquares}) {
    const PictureLabels labels(TwoColumns(255, 0), convention, false);
    for (const double grow_px : {-0.3, -0.02, 0.02, 0.3}) {
      EXPECT_TRUE(labels.IsObject({1.5L + grow_px - 1e-6, 1.0L}, grow_px));
      EXPECT_FALSE(labels.IsObject({1.5L + grow_px + 1e-6, 1.0L}, grow_px));
      // Where the object meets the picture's border, the border is its boundary.
      EXPECT_TRUE(labels.IsObject({-0.5L - grow_px + 1e-6, 1.0L}, grow_px));
      EXPECT_FALSE(labels.IsObject({-0.5L - grow_px - 1e-6, 1.0L}, grow_px));
    }
  }
}

TEST(PictureLabels, TheExteriorIsAsTold) {
  const core::SoftMask empty{core::BitMask(3, 3), {}};
  const PictureLabels labels(empty, BoundaryConvention::kMarchingSquares, true);
  EXPECT_TRUE(labels.IsObject({-0.6L, 1.0L}));
  EXPECT_TRUE(labels.IsObject({2.5L, 1.0L}));
  EXPECT_FALSE(labels.IsObject({2.4L, 1.0L}));
}

}  // namespace
}  // namespace elbowroom::oracles
