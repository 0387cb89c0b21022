// What a piece of work costs, for programs that print the figures of the documentation.
#pragma once

#include <functional>
#include <string>

namespace elbowroom::test_support {

// Milliseconds that all threads of the program have used so far.
[[nodiscard]] double ProcessorMs();

// Does the work once, then an odd number of times; prints the median of the processor time of all threads.
void PrintCost(const std::string& what, const std::function<void()>& work);

}  // namespace elbowroom::test_support
