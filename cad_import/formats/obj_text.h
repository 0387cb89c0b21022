// The shape that an OBJ file describes, without all else that it may say.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace elbowroom::cad_import {

struct PlainObj {
  std::string text;            // v, f, l, o and g lines only; corners by position index only
  std::int64_t triangles = 0;  // that its faces make when cut up
};

// Leaves out materials, texture coordinates and normals: they don't matter here, other files may hold them,
// and a wrong index of theirs would cost faces.
// Throws: Error{kFormat} naming `where`: binary data, no face.
[[nodiscard]] PlainObj PlainObjOf(std::string_view bytes, const std::string& where);

}  // namespace elbowroom::cad_import
