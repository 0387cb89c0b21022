// Rigs of two cameras as other programs write them, sound.
#pragma once

#include <array>
#include <string_view>

namespace elbowroom::adversary {

struct ForeignText {
  std::string_view format;  // for --format
  std::string_view name;    // of the file
  std::string_view text;
};

extern const std::array<ForeignText, 6> kForeignTexts;

}  // namespace elbowroom::adversary
