#include "cad_import/normalisation/likely_unit.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::cad_import {
namespace {

using core::LengthUnit;

// Sizes of what is usually checked at a table.
constexpr double kUsuallySmallestMm = 20.0, kUsuallyLargestMm = 1000.0;

// A penalty for units in which CAD models are rarely drawn.
double RarityOf(LengthUnit unit) {
  if (unit == LengthUnit::kMillimetre) return 0.0;
  return unit == LengthUnit::kCentimetre ? 2.0 : 0.5;
}

}  // namespace

LengthUnit LikelyUnit(double longest) {
  return *std::ranges::min_element(kLengthUnits, {}, [&](LengthUnit unit) {
    const double longest_mm = longest * core::MillimetresPer(unit);
    const double beyond =
        std::max({std::log(kUsuallySmallestMm / longest_mm), std::log(longest_mm / kUsuallyLargestMm), 0.0});
    return beyond + RarityOf(unit);
  });
}

}  // namespace elbowroom::cad_import
