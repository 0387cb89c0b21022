#include "core/units.h"

#include <array>
#include <utility>

namespace elbowroom::core {
namespace {

struct UnitRow {
  LengthUnit unit;
  std::string_view text;
  double millimetres;
};

constexpr std::array<UnitRow, 4> kUnits = {{{LengthUnit::kMillimetre, "mm", 1.0},
                                            {LengthUnit::kCentimetre, "cm", 10.0},
                                            {LengthUnit::kMetre, "m", 1000.0},
                                            {LengthUnit::kInch, "in", 25.4}}};

}  // namespace

double MillimetresPer(LengthUnit unit) { return kUnits[static_cast<std::size_t>(unit)].millimetres; }

std::optional<LengthUnit> ParseLengthUnit(std::string_view text) {
  for (const UnitRow& row : kUnits) {
    if (row.text == text) return row.unit;
  }
  return std::nullopt;
}

std::string_view ToString(LengthUnit unit) { return kUnits[static_cast<std::size_t>(unit)].text; }

}  // namespace elbowroom::core
