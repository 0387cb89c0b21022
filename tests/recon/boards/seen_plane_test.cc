// The model of a plane behind a radial lens, and the points it throws out.
#include "recon/boards/seen_plane.h"

#include <gtest/gtest.h>

#include "tests/recon/boards/board_picture.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

std::vector<PointPair> PairsSeenBy(const std::string& lens) {
  const Board board = testing::MakeBoard(BoardKind::kCircles);
  const core::CameraModel camera = testing::CameraAt({lens, 420.0, 50.0}, DrawBoard(board));
  std::vector<PointPair> pairs;
  for (const Eigen::Vector3d& point : PointsOf(board))
    pairs.push_back({point.head<2>(), camera.Project(point).value()});
  return pairs;
}

TEST(SeenPlane, FollowsLensesToATenthOfASquare) {
  for (const char* lens : {"plain", "strong", "fisheye"}) {
    const std::vector<PointPair> pairs = PairsSeenBy(lens);
    const auto plane = FitSeenPlane(pairs, 644, 486);
    ASSERT_TRUE(plane.has_value());
    for (const PointPair& pair : pairs) EXPECT_LT((plane->Project(pair.from) - pair.to).norm(), 2.0) << lens;
  }
}

TEST(SeenPlane, LeavesOutPointsThatAreElsewhere) {
  std::vector<PointPair> pairs = PairsSeenBy("strong");
  for (const std::size_t wrong : {3U, 20U, 21U}) pairs[wrong].to += Vector2d(9.0, -4.0);
  const std::vector<std::size_t> kept = AgreeingPairs(pairs, 22.0, 644, 486);
  EXPECT_EQ(kept.size(), pairs.size() - 3);
  for (const std::size_t i : kept) EXPECT_TRUE(i != 3U && i != 20U && i != 21U);
}

TEST(SeenPlane, NeedsFourPointsThatAreNotOnALine) {
  std::vector<PointPair> pairs;
  for (int i = 0; i < 9; ++i) pairs.push_back({Vector2d(i, 2.0 * i), Vector2d(10.0 * i, 5.0 * i)});
  EXPECT_FALSE(FitSeenPlane(pairs, 640, 480).has_value());
  pairs.resize(3);
  EXPECT_FALSE(FitSeenPlane(pairs, 640, 480).has_value());
}

}  // namespace
}  // namespace elbowroom::recon
