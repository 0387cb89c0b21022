// A checksum of a file's content.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <stop_token>

namespace elbowroom::core {

// 128-bit XXH3, in the order of its canonical form. Reads the file piece by piece. Throws: Error{kFile}
// naming the path where it can't be read; Error{kCancelled}.
[[nodiscard]] std::array<std::byte, 16> HashOfFile(const std::filesystem::path& path,
                                                   const std::stop_token& stop = {});

}  // namespace elbowroom::core
