// What the readers of text and binary formats say of a file that isn't what its format asks for.
#pragma once

#include <string>

namespace elbowroom::cad_import {

// Throws: core::Error(kFormat) "WHERE: WHAT".
[[noreturn]] void FailAsMalformed(const std::string& where, const std::string& what);
// The same, and asks for the file to be exported again.
[[noreturn]] void FailUntilExportedAgain(const std::string& where, const std::string& what);

}  // namespace elbowroom::cad_import
