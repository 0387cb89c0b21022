// The mean of a resting board's pictures, and how well it is known.
#include "recon/boards/resting_board.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace elbowroom::recon {
namespace {

constexpr double kRestSigmaPx = 0.2;
constexpr int kRestPictures = 30;

const Board kRestBoard{BoardKind::kCharuco, 16, 12, 40.0, 28.0, "DICT_5X5_100"};

BoardSighting BoardAt(const Eigen::Vector2d& corner) {
  BoardSighting sighting;
  for (int i = 0; i < static_cast<int>(PointsOf(kRestBoard).size()); ++i)
    sighting.points.push_back({i, corner + 30.0 * Eigen::Vector2d(i % 15, i / 15), kRestSigmaPx});
  return sighting;
}

void Disturb(double sigma_px, std::mt19937_64* random, BoardSighting* sighting) {
  std::normal_distribution<double> normal;
  for (SightedPoint& point : sighting->points)
    for (double& coordinate : point.pixel) coordinate += sigma_px * normal(*random);
}

// The mean of pictures whose noise has a part that is the same in all of them.
BoardSighting MeanOf(double fixed_px, double changing_px, unsigned seed) {
  std::mt19937_64 random(seed);
  BoardSighting still = BoardAt({100.0, 80.0});
  Disturb(fixed_px, &random, &still);
  BoardSighting picture = still;
  Disturb(changing_px, &random, &picture);
  RestingBoard rest(kRestBoard, picture);
  for (int i = 1; i < kRestPictures; ++i) {
    picture = still;
    Disturb(changing_px, &random, &picture);
    EXPECT_TRUE(rest.Add(picture));
  }
  return rest.Mean();
}

// Mean squared error of a coordinate over the stated variance, over many boards.
double ErrorOverStated(double fixed_px, double changing_px) {
  constexpr int kBoards = 20;
  const BoardSighting truth = BoardAt({100.0, 80.0});
  double sum = 0.0, count = 0.0;
  for (unsigned seed = 0; seed < kBoards; ++seed)
    for (const SightedPoint& point : MeanOf(fixed_px, changing_px, seed).points) {
      sum += (point.pixel - truth.points[static_cast<std::size_t>(point.point)].pixel).squaredNorm() /
             std::pow(point.sigma_px, 2);
      count += 2.0;
    }
  return sum / count;
}

// 6,600 coordinates: the ratio's own standard error is 1.7 %.
TEST(RestingBoard, TheMeanIsKnownAsItSays) {
  constexpr double kThreeStandardErrors = 0.052;
  EXPECT_NEAR(ErrorOverStated(0.0, kRestSigmaPx), 1.0, kThreeStandardErrors);
  EXPECT_NEAR(ErrorOverStated(0.16, 0.12), 1.0, kThreeStandardErrors);
  EXPECT_NEAR(ErrorOverStated(kRestSigmaPx, 0.01), 1.0, kThreeStandardErrors);
}

TEST(RestingBoard, ABoardThatHasMovedIsAnother) {
  std::mt19937_64 random(1);
  RestingBoard rest(kRestBoard, BoardAt({100.0, 80.0}));
  BoardSighting moved = BoardAt({100.0 + 2.0 * kMostRestPx, 80.0});
  Disturb(0.1, &random, &moved);
  EXPECT_FALSE(rest.Add(moved));
  BoardSighting near = BoardAt({100.0 + 0.5 * kMostRestPx, 80.0});
  Disturb(0.1, &random, &near);
  EXPECT_TRUE(rest.Add(near));
  EXPECT_EQ(rest.pictures(), 2);
}

TEST(RestingBoard, PointsThatHalfOfThePicturesDontShowAreLeftOut) {
  RestingBoard rest(kRestBoard, BoardAt({100.0, 80.0}));
  BoardSighting half = BoardAt({100.0, 80.0});
  half.points.resize(90);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(rest.Add(half));
  EXPECT_EQ(rest.Mean().points.size(), 90U);
}

}  // namespace
}  // namespace elbowroom::recon
