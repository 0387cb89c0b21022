#include "recon/hull/hull_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

Contour LoopOf(std::vector<Vector2d> vertices) {
  Contour contour;
  const auto count = static_cast<std::uint32_t>(vertices.size());
  contour.vertices = std::move(vertices);
  for (std::uint32_t i = 0; i < count; ++i) {
    contour.edges.push_back({i, (i + 1) % count});
    contour.edge_from.push_back(i);
    contour.edge_to.push_back((i + count - 1) % count);
  }
  return contour;
}

// Vertices as unevenly far apart as marching squares puts them.
std::vector<Vector2d> Circle(Random* random, double radius_px) {
  std::vector<Vector2d> vertices;
  for (double angle = 0.0; angle < 2.0 * std::numbers::pi; angle += random->Uniform(0.1, 1.2) / radius_px)
    vertices.push_back(radius_px * Vector2d(std::cos(angle), std::sin(angle)));
  return vertices;
}

double AngleBetween(const Vector2d& a, const Vector2d& b) {
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
}

TEST(FitTangent, OfACircleIsItsTangentWhereAChordsIsNot) {
  Random random(7701);
  double worst_fit = 0.0, worst_chord = 0.0;
  for (int trial = 0; trial < 200; ++trial) {
    const double radius_px = random.Uniform(20.0, 200.0);
    const Contour contour = LoopOf(Circle(&random, radius_px));
    const auto edge = static_cast<std::uint32_t>(random.Whole(0, static_cast<int>(contour.edges.size()) - 1));
    const double share = random.Uniform(0.0, 1.0);
    const Vector2d position = (1.0 - share) * contour.vertices[contour.edges[edge].from] +
                              share * contour.vertices[contour.edges[edge].to];
    const Vector2d truth(-position.y(), position.x());
    const auto fitted = FitTangent(contour, edge, position);
    ASSERT_TRUE(fitted);
    worst_fit = std::max(worst_fit, radius_px * AngleBetween(fitted->tangent, truth));
    worst_chord = std::max(worst_chord, radius_px * AngleBetween(SmoothTangent(contour, edge), truth));
    constexpr double kCurvature = 0.05;  // a parabola's is not quite a circle's
    EXPECT_NEAR(fitted->curvature_per_px * radius_px, 1.0, kCurvature);
  }
  constexpr double kTurnPx = 0.05;  // of turns in a pixel
  EXPECT_LT(worst_fit, kTurnPx);
  EXPECT_GT(worst_chord, 10.0 * worst_fit);
}

TEST(FitTangent, TurnsNoFartherThanItsGainForVerticesThatAreOff) {
  Random random(7702);
  double most = 0.0;
  for (int trial = 0; trial < 500; ++trial) {
    const double off_px = random.Uniform(0.01, 0.3);
    std::vector<Vector2d> vertices = Circle(&random, random.Uniform(40.0, 200.0));
    const Contour exact = LoopOf(vertices);
    const auto edge = static_cast<std::uint32_t>(random.Whole(0, static_cast<int>(vertices.size()) - 1));
    const Vector2d position = vertices[edge];
    const auto before = FitTangent(exact, edge, position);
    for (Vector2d& vertex : vertices) vertex += vertex.normalized() * (random.Chance(0.5) ? off_px : -off_px);
    const auto after = FitTangent(LoopOf(std::move(vertices)), edge, position);
    ASSERT_TRUE(before && after);
    const double turned = AngleBetween(before->tangent, after->tangent);
    constexpr double kTurnedFrame = 1.05;  // heights are measured from a chord that turns a little too
    EXPECT_LE(turned, kTurnedFrame * std::atan(before->gain_per_px * off_px)) << trial;
    most = std::max(most, turned / std::atan(before->gain_per_px * off_px));
  }
  EXPECT_GT(most, 0.7) << "a bound that nothing comes near says nothing";
}

TEST(FitTangent, ACornerFitsBadlyAndAShortLoopNotAtAll) {
  std::vector<Vector2d> square;
  for (int i = 0; i < 10; ++i) square.emplace_back(i, 0);
  for (int i = 0; i < 10; ++i) square.emplace_back(10, i);
  for (int i = 10; i > 0; --i) square.emplace_back(i, 10);
  for (int i = 10; i > 0; --i) square.emplace_back(0, i);
  const Contour contour = LoopOf(std::move(square));
  constexpr double kStraightPx = 1e-12, kCornerPx = 0.2;
  EXPECT_LT(FitTangent(contour, 4, {4.5, 0.0})->residual_px, kStraightPx);
  EXPECT_GT(FitTangent(contour, 9, {9.8, 0.0})->residual_px, kCornerPx);
  EXPECT_FALSE(FitTangent(LoopOf({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), 0, {0.5, 0}));
}

}  // namespace
}  // namespace elbowroom::recon
