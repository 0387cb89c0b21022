// Which formats can be read, and a look at a file before a parser is trusted with it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace elbowroom::cad_import {

enum class FileFormat {
  kStl,
  kObj,
  kPly,
  kOff,
  kGltf,
  kGlb,
  k3mf,
  kCollada,
  kFbx,
  k3ds,
  kStep,
  kIges,
  kBrep
};

[[nodiscard]] std::string_view ToString(FileFormat format);  // "STL", "glTF"

// True for STEP, IGES and BREP: faces and edges, not triangles.
[[nodiscard]] bool IsBoundaryRepresentation(FileFormat format);

// The first of the extensions that the format has, such as ".stl".
[[nodiscard]] std::string_view ExtensionOf(FileFormat format);

// The format that the path's extension names (any case); nothing for another one.
[[nodiscard]] std::optional<FileFormat> FindFormat(const std::filesystem::path& path);

// The format that the file's extension names (any case).
// Throws: Error{kFormat} naming what is supported.
[[nodiscard]] FileFormat FormatOfExtension(const std::filesystem::path& path);

// Throws: Error{kFile} naming the file: there is none, it is no file, or it is larger than 1 GiB.
[[nodiscard]] std::int64_t ReadableBytes(const std::filesystem::path& path);

struct CheckedFile {
  FileFormat format = FileFormat::kStl;
  std::string bytes;  // the whole file
};

// Reads the file after a look inside: its content is of the format that its extension names and holds all
// that its header claims. Throws: Error{kFile} (missing, not a file, unreadable, over 1 GiB), Error{kFormat}
// (another format, cut off).
[[nodiscard]] CheckedFile ReadCheckedFile(const std::filesystem::path& path);

}  // namespace elbowroom::cad_import
