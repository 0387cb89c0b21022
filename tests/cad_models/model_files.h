// CAD files that others made, to hold the importer against.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace elbowroom::cad_models {

struct ModelFile {
  std::string name;  // its collection, then its path there: "assimp-testmodels/STL/Wuson.stl"
  std::filesystem::path path;
};

// The files of an installed Debian package in formats that can be imported, by name. Nothing: it isn't
// installed, or this isn't a Debian system.
[[nodiscard]] std::optional<std::vector<ModelFile>> FilesOfPackage(const std::string& package);

// The same of a folder and all below it.
[[nodiscard]] std::optional<std::vector<ModelFile>> FilesOfFolder(const std::filesystem::path& folder,
                                                                  const std::string& name);

}  // namespace elbowroom::cad_models
