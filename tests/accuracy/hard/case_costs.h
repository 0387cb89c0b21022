// What the questions about one hard case cost.
#pragma once

#include "tests/accuracy/hard/hard_cases.h"
#include "tests/accuracy/hard/hard_kinds.h"
#include "tests/accuracy/interleaved_timing.h"

namespace elbowroom::accuracy {

// Contacts; heat map and recovery where the part touches the hull, clearance where it doesn't. One thread.
void AddCaseCosts(const SeenHull& seen, const HardCase& hard_case, const TimingEffort& effort,
                  HardKinds* kinds);

}  // namespace elbowroom::accuracy
