#include "core/statistics/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "core/error.h"

namespace elbowroom::core {
namespace {

struct WeightedMean {
  double mean = 0.0;
  double weight = 0.0;
};

// Samples that differ in their order only are one: values 0 to `place` are still to be chosen from.
class AllSamples {
 public:
  explicit AllSamples(std::span<const double> values) : values_(values) {
    Choose(0, values.size(), 0.0, 1.0);
  }
  [[nodiscard]] std::vector<WeightedMean> Take() { return std::move(means_); }

 private:
  // `ways`: orders of what was chosen so far, among the draws so far, as a multinomial coefficient.
  void Choose(std::size_t place, std::size_t left, double sum, double ways) {
    const std::size_t drawn = values_.size() - left;
    if (place + 1 == values_.size()) {
      const double all = sum + static_cast<double>(left) * values_[place];
      means_.push_back({all / static_cast<double>(values_.size()), ways * Orders(drawn, left)});
      return;
    }
    for (std::size_t times = 0; times <= left; ++times)
      Choose(place + 1, left - times, sum + static_cast<double>(times) * values_[place],
             ways * Orders(drawn, times));
  }
  // Ways to put `times` draws among `drawn` others.
  static double Orders(std::size_t drawn, std::size_t times) {
    double ways = 1.0;
    for (std::size_t i = 1; i <= times; ++i)
      ways = ways * static_cast<double>(drawn + i) / static_cast<double>(i);
    return ways;
  }

  std::span<const double> values_;
  std::vector<WeightedMean> means_;
};

// std::uniform_int_distribution may differ between libraries.
std::size_t Draw(std::mt19937_64& random, std::size_t below) {
  const std::uint64_t whole = std::mt19937_64::max() - std::mt19937_64::max() % below;
  std::uint64_t value = random();
  while (value >= whole) value = random();
  return static_cast<std::size_t>(value % below);
}

std::vector<WeightedMean> DrawnSamples(std::span<const double> values, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<WeightedMean> means;
  for (int i = 0; i < kDraws; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) sum += values[Draw(random, values.size())];
    means.push_back({sum / static_cast<double>(values.size()), 1.0});
  }
  return means;
}

}  // namespace

std::optional<Interval> BootstrapMean(std::span<const double> values, double confidence, std::uint64_t seed) {
  Require(!values.empty(), "a mean is of at least one value");
  Require(confidence > 0.0 && confidence < 1.0, "a confidence is between 0 and 1");
  if (values.size() == 1) return std::nullopt;
  std::vector<WeightedMean> means = values.size() <= static_cast<std::size_t>(kAllDrawn)
                                        ? AllSamples(values).Take()
                                        : DrawnSamples(values, seed);
  std::ranges::sort(means, {}, &WeightedMean::mean);
  double all = 0.0;
  for (const WeightedMean& mean : means) all += mean.weight;
  const double tail = 0.5 * (1.0 - confidence) * all;
  Interval interval{means.front().mean, means.back().mean};
  double below = 0.0;
  for (const WeightedMean& mean : means) {
    interval.lower = mean.mean;
    below += mean.weight;
    if (below > tail) break;
  }
  double above = 0.0;
  for (auto mean = means.rbegin(); mean != means.rend(); ++mean) {
    interval.upper = mean->mean;
    above += mean->weight;
    if (above > tail) break;
  }
  return interval;
}

}  // namespace elbowroom::core
