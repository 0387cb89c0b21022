#include "tests/support/soak.h"

#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

namespace elbowroom::test_support {

int SoakScale() {
  constexpr int kLargest = 1'000'000;
  const char* variable = std::getenv("ELBOWROOM_SOAK_SCALE");
  if (variable == nullptr) return 1;
  const std::string_view text = variable;
  int scale = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), scale);
  if (error != std::errc() || end != text.data() + text.size() || scale < 1 || scale > kLargest) {
    throw std::invalid_argument("ELBOWROOM_SOAK_SCALE must be a whole number from 1 to 1000000, not '" +
                                std::string(text) + "'");
  }
  return scale;
}

}  // namespace elbowroom::test_support
