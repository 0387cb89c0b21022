// Where this build has its program, its sources and the data beside them. Functions, so that what a test
// compiles to is the same in every clone, and the compiler's cache serves them all.
#pragma once

#include <filesystem>

namespace elbowroom::test_support {

[[nodiscard]] std::filesystem::path ProgramFile();       // the built elbowroom
[[nodiscard]] std::filesystem::path SourceFolder();      // of the repository
[[nodiscard]] std::filesystem::path SharedDataFolder();  // ../shared/data, which may not be there

}  // namespace elbowroom::test_support
