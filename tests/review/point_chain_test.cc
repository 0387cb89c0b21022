// Chains against plain vectors.
#include "review/point_chain.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace elbowroom::review {
namespace {

std::vector<double> DepthsIn(const PointChain& chain) {
  std::vector<core::ContactPoint> points(3);  // is replaced
  chain.CopyTo(&points);
  std::vector<double> depths_mm;
  for (const core::ContactPoint& point : points) depths_mm.push_back(point.depth_mm);
  return depths_mm;
}

TEST(PointChain, JoinsInOrder) {
  PointChunks chunks;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> count(0, 100);
  for (int trial = 0; trial < 50; ++trial) {
    chunks.Reset();
    PointChain all(&chunks);
    std::vector<double> expected_mm;
    for (int part = 0; part < 5; ++part) {
      PointChain chain(&chunks);
      for (int i = count(random); i > 0; --i) {
        expected_mm.push_back(static_cast<double>(expected_mm.size()));
        (part % 2 == 0 ? chain : all).Add({{}, expected_mm.back(), 0.0});
      }
      all.Append(chain);
    }
    EXPECT_EQ(all.is_empty(), expected_mm.empty());
    EXPECT_EQ(DepthsIn(all), expected_mm);
  }
}

TEST(PointChain, IsEmptyAtFirst) {
  PointChunks chunks;
  const PointChain chain(&chunks);
  EXPECT_TRUE(chain.is_empty());
  EXPECT_TRUE(DepthsIn(chain).empty());
}

}  // namespace
}  // namespace elbowroom::review
