// What a what-if found, in a line.
#pragma once

#include <QString>

#include "app/control/reviewing/needed_gap.h"
#include "app/control/reviewing/what_if.h"
#include "core/session.h"

namespace elbowroom::console {

[[nodiscard]] QString GapsText(const control::HeldGaps& held_mm);  // "payload_a_gap 160 mm"

// "at payload_a_gap 160 mm: 0 touches, clearance ≥ 16.3 mm (15 mm clearance required)"
[[nodiscard]] QString WhatIfText(const control::WhatIf& what_if, const core::SessionHeader& header);

// How long it took, and what wasn't judged again: "2 of 3 parts stay, and keep their verdicts".
[[nodiscard]] QString SkippedText(const control::WhatIf& what_if);

// "payload_a_gap: touched at 213.4 mm, free from 213.8 mm, with 15 mm clearance from 230 mm"
[[nodiscard]] QString NeededText(const QString& spacing, const control::NeededGap& needed,
                                 double required_clearance_mm);

}  // namespace elbowroom::console
