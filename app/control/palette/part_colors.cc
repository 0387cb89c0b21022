#include "app/control/palette/part_colors.h"

#include <array>

namespace elbowroom::control {
namespace {

constexpr std::array<std::array<float, 3>, 6> kPartColors = {{{0.55F, 0.63F, 0.72F},
                                                              {0.72F, 0.68F, 0.55F},
                                                              {0.58F, 0.70F, 0.60F},
                                                              {0.66F, 0.60F, 0.72F},
                                                              {0.70F, 0.62F, 0.60F},
                                                              {0.55F, 0.69F, 0.71F}}};

}  // namespace

Color PlainPartColor(core::PartIndex part) { return Color(kPartColors[part % kPartColors.size()].data()); }

Color BrokenRuleColor() { return {0.95F, 0.80F, 0.15F}; }

Color BandColor(core::Verdict verdict) {
  switch (verdict) {
    case core::Verdict::kContact:
      return {0.835F, 0.369F, 0.0F};
    case core::Verdict::kNear:
      return {0.941F, 0.894F, 0.259F};
    case core::Verdict::kClear:
      return {0.0F, 0.55F, 0.42F};
    case core::Verdict::kUndecided:
      return {0.70F, 0.70F, 0.72F};
  }
  return {0.70F, 0.70F, 0.72F};
}

}  // namespace elbowroom::control
