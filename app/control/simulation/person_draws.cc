#include "app/control/simulation/person_draws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::control {

double PersonDraws::Uniform(double low, double high) {
  constexpr std::uint64_t kPeople = 0x70656f706c65ULL;  // a stream beside those of images
  return low + (high - low) * recon::UniformFrom(recon::StreamSeed(seed_, participant_, kPeople, drawn_++));
}

double PersonDraws::Normal(double mean, double sd) {
  constexpr int kTerms = 12;  // their sum has the variance 1
  double sum = 0.0;
  for (int i = 0; i < kTerms; ++i) sum += Uniform(0.0, 1.0);
  return mean + sd * (sum - 0.5 * kTerms);
}

int PersonDraws::OneOf(int least, int most) {
  return std::min(least + static_cast<int>(std::floor(Uniform(0.0, most - least + 1.0))), most);
}

std::string CodeOf(int participant, int participants) {
  return fmt::format("P{:0{}}", participant + 1,
                     std::max<std::size_t>(2, std::to_string(participants).size()));
}

}  // namespace elbowroom::control
