#include "cad_import/formats/file_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <utility>
#include <vector>

#include "cad_import/formats/glb_container.h"
#include "cad_import/formats/gltf_check.h"
#include "cad_import/formats/ply_check.h"
#include "cad_import/formats/stl_check.h"
#include "core/error.h"
#include "core/spelling.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

constexpr std::uintmax_t kLargestFileBytes = std::uintmax_t{1} << 30U;

struct FormatRow {
  FileFormat format;
  std::string_view extension;
  std::string_view text;
};
constexpr std::array<FormatRow, 16> kFormats = {{{FileFormat::kStl, ".stl", "STL"},
                                                 {FileFormat::kObj, ".obj", "OBJ"},
                                                 {FileFormat::kPly, ".ply", "PLY"},
                                                 {FileFormat::kOff, ".off", "OFF"},
                                                 {FileFormat::kGltf, ".gltf", "glTF"},
                                                 {FileFormat::kGlb, ".glb", "GLB"},
                                                 {FileFormat::k3mf, ".3mf", "3MF"},
                                                 {FileFormat::kCollada, ".dae", "COLLADA"},
                                                 {FileFormat::kFbx, ".fbx", "FBX"},
                                                 {FileFormat::k3ds, ".3ds", "3DS"},
                                                 {FileFormat::kStep, ".step", "STEP"},
                                                 {FileFormat::kStep, ".stp", "STEP"},
                                                 {FileFormat::kStep, ".p21", "STEP"},
                                                 {FileFormat::kIges, ".iges", "IGES"},
                                                 {FileFormat::kIges, ".igs", "IGES"},
                                                 {FileFormat::kBrep, ".brep", "BREP"}}};

const FormatRow& RowOf(FileFormat format) {
  const auto row = std::ranges::find(kFormats, format, &FormatRow::format);
  core::Require(row != kFormats.end(), "a format has a row");
  return *row;
}

std::string ReadWhole(const std::filesystem::path& path) {
  const auto size_bytes = static_cast<std::size_t>(ReadableBytes(path));
  std::ifstream file(path, std::ios::binary);
  std::string bytes(size_bytes, '\0');
  if (!file || (size_bytes > 0 && !file.read(bytes.data(), static_cast<std::streamsize>(size_bytes)))) {
    throw Error(ErrorKind::kFile, fmt::format("{}: can't be read; check its permissions", path.string()));
  }
  return bytes;
}

[[noreturn]] void FailFormat(const std::string& where, const std::string& what) {
  throw Error(ErrorKind::kFormat, fmt::format("{}: {}", where, what));
}

// What a file of the format begins with; nothing: that isn't told by its beginning.
std::vector<std::string_view> BeginningsOf(FileFormat format) {
  switch (format) {
    case FileFormat::k3mf:
      return {"PK"};
    case FileFormat::k3ds:
      return {"MM"};
    case FileFormat::kStep:
      return {"ISO-10303-21"};
    case FileFormat::kBrep:
      return {"DBRep_DrawableShape", "CASCADE Topology", "Open CASCADE Topology"};
    default:
      return {};
  }
}

void CheckBeginning(FileFormat format, std::string_view bytes, const std::string& where) {
  const std::vector<std::string_view> beginnings = BeginningsOf(format);
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  if (beginnings.empty() ||
      std::ranges::any_of(beginnings, [&](auto text) { return bytes.starts_with(text); }))
    return;
  FailFormat(where, fmt::format("not {} (it doesn't begin like it); export it again", ToString(format)));
}

void CheckContent(FileFormat format, std::string_view bytes, const std::string& where) {
  switch (format) {
    case FileFormat::kStl:
      return CheckStl(bytes, where);
    case FileFormat::kPly:
      return CheckPly(bytes, where);
    case FileFormat::kGltf:
      return CheckGltf(bytes, where);
    case FileFormat::kGlb:
      return CheckGlb(bytes, where);
    default:
      return CheckBeginning(format, bytes, where);
  }
}

}  // namespace

std::string_view ToString(FileFormat format) { return RowOf(format).text; }

std::string_view ExtensionOf(FileFormat format) { return RowOf(format).extension; }

bool IsBoundaryRepresentation(FileFormat format) {
  return format == FileFormat::kStep || format == FileFormat::kIges || format == FileFormat::kBrep;
}

std::optional<FileFormat> FindFormat(const std::filesystem::path& path) {
  const std::string extension = core::LowerCase(path.extension().string());
  for (const FormatRow& row : kFormats) {
    if (row.extension == extension) return row.format;
  }
  return std::nullopt;
}

FileFormat FormatOfExtension(const std::filesystem::path& path) {
  if (const std::optional<FileFormat> format = FindFormat(path)) return *format;
  const std::string extension = path.extension().string();
  FailFormat(path.string(),
             fmt::format("'{}' files can't be read; export the part as .step, .stl, .obj, .ply, .glb or .3mf",
                         extension.empty() ? "extensionless" : extension));
}

std::int64_t ReadableBytes(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw Error(ErrorKind::kFile, fmt::format("{}: no such file; check the path", path.string()));
  }
  if (status.type() != std::filesystem::file_type::regular) {
    throw Error(ErrorKind::kFile, fmt::format("{}: not a readable file; name a CAD file", path.string()));
  }
  const std::uintmax_t size_bytes = std::filesystem::file_size(path, error);
  if (error || size_bytes > kLargestFileBytes) {
    throw Error(ErrorKind::kFile, fmt::format("{}: larger than 1 GiB; export a coarser mesh", path.string()));
  }
  return static_cast<std::int64_t>(size_bytes);
}

CheckedFile ReadCheckedFile(const std::filesystem::path& path) {
  const std::string where = path.string();
  std::string bytes = ReadWhole(path);  // first, so that a missing file is called missing
  const FileFormat format = FormatOfExtension(path);
  if (bytes.empty()) FailFormat(where, "the file is empty; export it again");
  if (format == FileFormat::kStl) bytes = PlainStl(std::move(bytes));
  CheckContent(format, bytes, where);
  return {format, std::move(bytes)};
}

}  // namespace elbowroom::cad_import
