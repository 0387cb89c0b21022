#include "cad_import/formats/referenced_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace elbowroom::cad_import {

namespace fs = std::filesystem;

ReferencedFiles::ReferencedFiles(const fs::path& file) : path_(fs::weakly_canonical(file).parent_path()) {}

bool ReferencedFiles::Holds(const fs::path& file) const {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(file, error);
  return !error && std::mismatch(path_.begin(), path_.end(), whole.begin(), whole.end()).first == path_.end();
}

core::Error RefersElsewhere(const fs::path& file, const std::string& name) {
  return {core::ErrorKind::kFormat,
          fmt::format("{}: it refers to '{}', which is outside its own folder; put the file beside it",
                      file.string(), name)};
}

}  // namespace elbowroom::cad_import
