// Whole text files, for tests that write their own input and look at what came out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace elbowroom::test_support {

// Creates missing folders. Throws: std::ios_base::failure naming the file.
void WriteText(const std::filesystem::path& file, std::string_view text);

// Throws: std::ios_base::failure naming the file.
[[nodiscard]] std::string ReadText(const std::filesystem::path& file);

}  // namespace elbowroom::test_support
