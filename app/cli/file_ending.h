// Files that a command writes: what is written must be what its name says, asked before anything is computed.
#pragma once

#include <filesystem>
#include <initializer_list>

namespace elbowroom::cli {

// Throws: Error{kFile} naming the option, the file and the endings, unless the file has one of them. No file:
// nothing is asked.
void CheckEnding(const char* option, const std::filesystem::path& file,
                 std::initializer_list<const char*> endings);

}  // namespace elbowroom::cli
