// STL files: whether they are whole, and as parsers take them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace elbowroom::cad_import {

// Text without a byte order mark and blank lines before its "solid", its words in lower case, without letters
// beyond ASCII in its first line; all else as it is.
[[nodiscard]] std::string PlainStl(std::string bytes);

// Throws: Error{kFormat} naming `where`: neither text nor binary STL, cut off, another count of triangles
// than there are.
void CheckStl(std::string_view bytes, const std::string& where);

// After the last triangle of a binary file that CheckStl took; 0 for text.
[[nodiscard]] std::size_t BytesAfterTriangles(std::string_view bytes);

}  // namespace elbowroom::cad_import
