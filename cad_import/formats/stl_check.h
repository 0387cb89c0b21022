// Checks STL files, and brings text into the form that parsers take.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace elbowroom::cad_import {

// Text STL as parsers take it: without a byte order mark and blank lines before its "solid", in lower case if
// it has no "facet", and with '_' for letters beyond ASCII in its first line. Binary STL stays as it is.
[[nodiscard]] std::string PlainStl(std::string bytes);

// Throws: Error{kFormat} naming `where`: neither text nor binary STL, cut off, another count of triangles
// than there are.
void CheckStl(std::string_view bytes, const std::string& where);

// The number of bytes after the last triangle of a binary file that CheckStl accepted; 0 for text.
[[nodiscard]] std::size_t BytesAfterTriangles(std::string_view bytes);

}  // namespace elbowroom::cad_import
