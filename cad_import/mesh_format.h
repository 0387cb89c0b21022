// Which mesh formats can be read, and a look at a file before a parser is trusted with it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace elbowroom::cad_import {

enum class MeshFormat { kStl, kObj, kPly, kGltf, kGlb };

[[nodiscard]] std::string_view ToString(MeshFormat format);  // "STL", "OBJ", "PLY", "glTF", "GLB"

// True for glTF and GLB, which are in metres by their specification; the others don't say.
[[nodiscard]] bool CarriesUnit(MeshFormat format);

// The format that the path's extension names (any case); nothing for another one.
[[nodiscard]] std::optional<MeshFormat> FindFormat(const std::filesystem::path& path);

// The format that the file's extension names (any case).
// Throws: Error{kFormat} naming what is supported.
[[nodiscard]] MeshFormat FormatOfExtension(const std::filesystem::path& path);

struct CheckedFile {
  MeshFormat format = MeshFormat::kStl;
  std::string bytes;  // the whole file
};

// Reads the file after a look inside: its content is of the format that its extension names and holds all
// that its header claims. Throws: Error{kFile} (missing, not a file, unreadable, over 1 GiB), Error{kFormat}
// (another format, cut off).
[[nodiscard]] CheckedFile ReadCheckedFile(const std::filesystem::path& path);

}  // namespace elbowroom::cad_import
