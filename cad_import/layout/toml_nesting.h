// How deep a TOML text nests, asked before it is parsed.
#pragma once

#include <string>
#include <string_view>

namespace elbowroom::cad_import {

// A parser, and code that walks over its tables, goes one call deeper with each list, table and dotted key.
// Strings and comments don't count. `file` is for messages.
// Throws: Error{kFormat} with the line of the first value more than 64 deep or key of more than 16 parts.
void RefuseDeepToml(std::string_view text, const std::string& file);

}  // namespace elbowroom::cad_import
