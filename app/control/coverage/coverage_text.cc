#include "app/control/coverage/coverage_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace elbowroom::control {

std::string MmText(double mm) {
  const double size = std::abs(mm);
  return fmt::format("{:.{}f}", mm, size >= 100.0 ? 0 : size >= 10.0 ? 1 : size >= 1.0 ? 2 : 3);
}

std::string PercentText(double share) {
  const double percent = 100.0 * share;
  return fmt::format("{:.{}f} %", percent, percent > 0.0 && percent < 1.0 ? 1 : 0);
}

std::string PlaceText(const Eigen::Vector3d& place_mm) {
  const int digits = place_mm.norm() < 100.0 ? 1 : 0;
  // Adding 0 makes -0 a 0.
  const Eigen::Vector3d p =
      (place_mm.array() * std::pow(10.0, digits)).round() / std::pow(10.0, digits) + 0.0;
  return fmt::format("({:.{}f}, {:.{}f}, {:.{}f}) mm", p.x(), digits, p.y(), digits, p.z(), digits);
}

std::string OrdinalText(std::size_t number) {
  constexpr std::array<const char*, 9> kWords = {"a second",  "a third",   "a fourth", "a fifth", "a sixth",
                                                 "a seventh", "an eighth", "a ninth",  "a tenth"};
  if (number >= 2 && number < 2 + kWords.size()) return kWords[number - 2];
  const std::size_t last = number % 10;
  const bool is_teen = number / 10 % 10 == 1;
  const char* ending = is_teen || last > 3 || last == 0 ? "th" : last == 1 ? "st" : last == 2 ? "nd" : "rd";
  const bool is_vowel = number == 11 || number == 18 || (number >= 80 && number < 90);
  return fmt::format("{} {}{}", is_vowel ? "an" : "a", number, ending);
}

}  // namespace elbowroom::control
