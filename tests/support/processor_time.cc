#include "tests/support/processor_time.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace elbowroom::test_support {
namespace {

constexpr int kRuns = 15;

}  // namespace

double ProcessorMs() { return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void PrintCost(const std::string& what, const std::function<void()>& work) {
  work();
  std::vector<double> times_ms;
  for (int i = 0; i < kRuns; ++i) {
    const double begin_ms = ProcessorMs();
    work();
    times_ms.push_back(ProcessorMs() - begin_ms);
  }
  std::ranges::sort(times_ms);
  std::printf("%-64s %8.2f ms\n", what.c_str(), times_ms[kRuns / 2]);
}

}  // namespace elbowroom::test_support
