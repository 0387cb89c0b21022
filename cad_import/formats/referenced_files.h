// Where the other files that a file refers to may be.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"

namespace elbowroom::cad_import {

// The folder that a file is in, and all below, links resolved.
class ReferencedFiles {
 public:
  explicit ReferencedFiles(const std::filesystem::path& file);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool Holds(const std::filesystem::path& file) const;

 private:
  std::filesystem::path path_;  // canonical
};

// The error for a file that refers to `name`, which its folder doesn't hold.
[[nodiscard]] core::Error RefersElsewhere(const std::filesystem::path& file, const std::string& name);

}  // namespace elbowroom::cad_import
