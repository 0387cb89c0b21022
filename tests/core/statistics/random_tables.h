// Groups of values of every kind: few and many, near together and far apart, tiny and huge, with ties.
#pragma once

#include <cmath>
#include <random>
#include <vector>

namespace elbowroom::core {

class RandomTables {
 public:
  explicit RandomTables(std::uint64_t seed) : random_(seed) {}

  [[nodiscard]] int Whole(int from, int to) { return std::uniform_int_distribution(from, to)(random_); }
  [[nodiscard]] double Number(double from, double to) {
    return std::uniform_real_distribution(from, to)(random_);
  }

  // Normally distributed around the middle.
  [[nodiscard]] std::vector<double> Group(int count, double middle, double spread) {
    std::normal_distribution<double> distribution(middle, spread);
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(distribution(random_));
    return values;
  }
  // Answers on a scale from 1 to 7.
  [[nodiscard]] std::vector<double> Answers(int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(Whole(1, 7));
    return values;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace elbowroom::core
