// The sessions of one block of a study.
#pragma once

#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace elbowroom::control {

// Those whose trial is of that block, in their order. Throws: core::Error{kRange} where none is, naming the
// blocks that there are; what sessions::SessionReader throws.
[[nodiscard]] std::vector<std::filesystem::path> SessionsOfBlock(
    std::span<const std::filesystem::path> sessions, const std::string& block, const std::stop_token& stop);

// "3 of 8 sessions are of another block than 'timed': they are left out"; empty: none is.
[[nodiscard]] std::string LeftOutNote(std::size_t kept, std::size_t sessions, const std::string& block);

}  // namespace elbowroom::control
