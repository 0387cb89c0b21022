// What hard shapes cost, and how exact the answers about them are.
#pragma once

#include <vector>

#include "tests/accuracy/hard/hard_cases.h"
#include "tests/accuracy/hard/hard_kinds.h"
#include "tests/accuracy/interleaved_timing.h"

namespace elbowroom::accuracy {

// Contacts, recovery, heat map and clearance for every hull, part and place; exact views of every hull; an
// assembly by frame and by part. Tells stderr how far it is.
[[nodiscard]] std::vector<HardKind> MeasureHardCosts(const HardOptions& options, const TimingEffort& effort);

}  // namespace elbowroom::accuracy
