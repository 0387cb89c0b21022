// Checks that the name of a file to be written ends as its format does, before anything is computed.
#pragma once

#include <filesystem>
#include <initializer_list>

namespace elbowroom::cli {

// Throws: Error{kFile} naming the option, the file and the endings, unless the file has one of them. An empty
// path is fine.
void CheckEnding(const char* option, const std::filesystem::path& file,
                 std::initializer_list<const char*> endings);

}  // namespace elbowroom::cli
