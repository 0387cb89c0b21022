// In which order participants meet the conditions of a study.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace elbowroom::core {

// A permutation of the conditions 0 ... n - 1.
using ConditionOrder = std::vector<std::size_t>;

// Orders in which each condition stands equally often at each place, and comes equally often right after each
// other one: as many as there are conditions if these are even in number, else twice as many.
// Source: E. J. Williams, "Experimental designs balanced for the estimation of residual effects of
// treatments", Australian Journal of Scientific Research A 2, 1949.
// Throws: PreconditionError without conditions.
[[nodiscard]] std::vector<ConditionOrder> BalancedOrders(std::size_t conditions);

// Which of `count` things each of the participants gets, in blocks: of the first `count` participants each
// gets another one, of the next `count` again, and so on; in each block the order is drawn with the seed. The
// same on every machine. Throws: PreconditionError without things.
[[nodiscard]] std::vector<std::size_t> DrawInBlocks(std::size_t participants, std::size_t count,
                                                    std::uint64_t seed);

}  // namespace elbowroom::core
