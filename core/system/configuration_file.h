// Reads configuration files: small texts, read whole. Anything that isn't a regular file is refused.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace elbowroom::core {

inline constexpr std::size_t kLargestConfigurationBytes = std::size_t{4} << 20U;

// The file's bytes. `who` begins the messages ("rig file 'rig.yml'"), `what` names its kind in them ("rig
// file"). A pipe, a device, a folder and a file of more than 4 MiB are refused before a byte is read.
// Throws: Error{kFile}.
[[nodiscard]] std::string ReadConfiguration(const std::filesystem::path& path, const std::string& who,
                                            std::string_view what);

}  // namespace elbowroom::core
