// How much longer than usual the long tests run.
#pragma once

namespace elbowroom::test_support {

// Factor on the counts of tests labelled `soak`: 1, or what `./dev soak` sets in ELBOWROOM_SOAK_SCALE.
// Throws: std::invalid_argument when the variable is not a whole number from 1 to 1,000,000.
[[nodiscard]] int SoakScale();

}  // namespace elbowroom::test_support
