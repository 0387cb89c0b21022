#include "core/statistics/balanced_orders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "core/error.h"

namespace elbowroom::core {
namespace {

TEST(BalancedOrders, EachStandsAndFollowsEquallyOften) {
  for (std::size_t n = 1; n <= 12; ++n) {
    SCOPED_TRACE(n);
    const std::vector<ConditionOrder> orders = BalancedOrders(n);
    EXPECT_EQ(orders.size(), n == 1 || n % 2 == 0 ? n : 2 * n);
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> at_place, after;
    for (const ConditionOrder& order : orders) {
      EXPECT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), n);
      ASSERT_EQ(order.size(), n);
      EXPECT_LT(*std::ranges::max_element(order), n);
      for (std::size_t i = 0; i < n; ++i) {
        ++at_place[{order[i], i}];
        if (i > 0) ++after[{order[i - 1], order[i]}];
      }
    }
    EXPECT_EQ(at_place.size(), n * n);
    for (const auto& [which, times] : at_place) EXPECT_EQ(times, orders.size() / n);
    EXPECT_EQ(after.size(), n * (n - 1));
    for (const auto& [which, times] : after) EXPECT_EQ(times, orders.size() / n);
  }
  EXPECT_THROW((void)BalancedOrders(0), PreconditionError);
}

TEST(DrawInBlocks, GivesEachEquallyOftenInEveryBlock) {
  for (const std::size_t count : {1U, 2U, 3U, 7U}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const std::vector<std::size_t> drawn = DrawInBlocks(40, count, seed);
      ASSERT_EQ(drawn.size(), 40U);
      for (std::size_t block = 0; block + count <= drawn.size(); block += count)
        EXPECT_EQ(std::set<std::size_t>(&drawn[block], &drawn[block] + count).size(), count);
      EXPECT_EQ(drawn, DrawInBlocks(40, count, seed)) << "the same seed gives the same";
      EXPECT_TRUE(std::ranges::equal(DrawInBlocks(23, count, seed), std::span(drawn).first(23)))
          << "more participants change nothing for those before";
    }
  }
}

// Of 6,000 blocks of three, each of the six orders is drawn about 1,000 times: within five standard
// deviations, of 29 each.
TEST(DrawInBlocks, EveryOrderOfABlockIsAsLikely) {
  const std::vector<std::size_t> drawn = DrawInBlocks(18'000, 3, 11);
  std::map<std::vector<std::size_t>, int> blocks;
  for (std::size_t i = 0; i < drawn.size(); i += 3) ++blocks[{drawn[i], drawn[i + 1], drawn[i + 2]}];
  EXPECT_EQ(blocks.size(), 6U);
  for (const auto& [block, times] : blocks) EXPECT_NEAR(times, 1000, 145);
}

// A plan that is printed today is the plan of another machine tomorrow.
TEST(DrawInBlocks, IsTheSameOnEveryMachine) {
  EXPECT_EQ(DrawInBlocks(6, 3, 7), (std::vector<std::size_t>{1, 2, 0, 1, 2, 0}));
}

}  // namespace
}  // namespace elbowroom::core
