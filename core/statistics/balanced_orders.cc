#include "core/statistics/balanced_orders.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include "core/error.h"

namespace elbowroom::core {
namespace {

// 0 ... most, each as likely. std::uniform_int_distribution differs between libraries.
std::size_t DrawUpTo(std::size_t most, std::mt19937_64* random) {
  const std::uint64_t values = static_cast<std::uint64_t>(most) + 1;
  const std::uint64_t beyond =
      std::numeric_limits<std::uint64_t>::max() - std::numeric_limits<std::uint64_t>::max() % values;
  std::uint64_t drawn = (*random)();
  while (drawn >= beyond) drawn = (*random)();
  return static_cast<std::size_t>(drawn % values);
}

}  // namespace

std::vector<ConditionOrder> BalancedOrders(std::size_t conditions) {
  Require(conditions > 0, "orders are of at least one condition");
  // 0, 1, n - 1, 2, n - 2, ...: neighbours differ by each number once.
  ConditionOrder zigzag;
  for (std::size_t i = 0; i < conditions; ++i)
    zigzag.push_back(i % 2 == 1 ? (i + 1) / 2 : (conditions - i / 2) % conditions);
  std::vector<ConditionOrder> orders;
  for (std::size_t shift = 0; shift < conditions; ++shift) {
    ConditionOrder order;
    for (const std::size_t condition : zigzag) order.push_back((condition + shift) % conditions);
    orders.push_back(std::move(order));
  }
  if (conditions % 2 == 0 || conditions == 1) return orders;
  for (std::size_t i = 0; i < conditions; ++i) orders.emplace_back(orders[i].rbegin(), orders[i].rend());
  return orders;
}

std::vector<std::size_t> DrawInBlocks(std::size_t participants, std::size_t count, std::uint64_t seed) {
  Require(count > 0, "something must be given to each participant");
  std::mt19937_64 random(seed);
  std::vector<std::size_t> drawn, block(count);
  while (drawn.size() < participants) {
    std::iota(block.begin(), block.end(), std::size_t{0});
    for (std::size_t i = count - 1; i > 0; --i) std::swap(block[i], block[DrawUpTo(i, &random)]);
    const std::size_t taken = std::min(count, participants - drawn.size());
    drawn.insert(drawn.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(taken));
  }
  return drawn;
}

}  // namespace elbowroom::core
