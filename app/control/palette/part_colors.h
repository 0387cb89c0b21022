// The colours of parts and verdicts, the same in every picture. No two that mean something differ by red and
// green alone.
#pragma once

#include <Eigen/Core>

#include "core/contact.h"
#include "core/ids.h"

namespace elbowroom::control {

// Red, green, blue in [0, 1] as a screen shows them (sRGB).
using Color = Eigen::Vector3f;

// A part that nothing is said of.
[[nodiscard]] Color PlainPartColor(core::PartIndex part);

// Of parts that break a pair rule. Apart from the orange-red of contacts also for those who see no red or
// green.
[[nodiscard]] Color BrokenRuleColor();

// What a verdict means at a glance: contact orange-red, near yellow, clear green-blue, undecided grey. Near
// Okabe and Ito's palette; palette_test simulates who can't see red, green or blue.
[[nodiscard]] Color BandColor(core::Verdict verdict);

}  // namespace elbowroom::control
