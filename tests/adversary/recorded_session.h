// What is asked of a session file after something went wrong while it was recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/support/run_program.h"

namespace elbowroom::adversary {

// The frames that the session has now, as another program sees them; nothing while there is no session to
// see.
[[nodiscard]] std::optional<std::int64_t> FramesOnDisk(const std::filesystem::path& session);

// Waits until the session has at least `frames` frames or the program `process` has ended; what it has.
std::int64_t WaitForFrames(const std::filesystem::path& session, std::int64_t frames, int process);

// Fails the running test unless the session opens, has at least `frames` frames without a hole, all readable,
// and `report` works on it, run by the program. Then SQLite finds no complaint in its files.
void ExpectSound(const std::filesystem::path& session, std::int64_t frames);

// One line on stderr and exit status 1, or exit status 0.
void ExpectOrderlyEnd(const test_support::ProgramRun& run);

// The program as the tests run it: software rendering, no display, Qt's offscreen platform.
[[nodiscard]] test_support::RunOptions AsInATest();

}  // namespace elbowroom::adversary
