// What is drawn for one participant of a cohort.
#pragma once

#include <cstdint>
#include <string>

namespace elbowroom::control {

// A function of (seed, participant, number of the draw) alone, the same on every machine. Thread: one.
class PersonDraws {
 public:
  PersonDraws(std::uint64_t seed, std::int64_t participant) : seed_(seed), participant_(participant) {}

  [[nodiscard]] double Uniform(double low, double high);
  // The sum of twelve uniform values: within 6 standard deviations of the mean.
  [[nodiscard]] double Normal(double mean, double sd);
  [[nodiscard]] int OneOf(int least, int most);  // both included

 private:
  std::uint64_t seed_;
  std::int64_t participant_;
  std::uint64_t drawn_ = 0;
};

// "P01", as a study's plan names them: as many digits as the last of them has, two at least.
[[nodiscard]] std::string CodeOf(int participant, int participants);

}  // namespace elbowroom::control
