#include "tests/cad_models/model_files.h"

#include <algorithm>
#include <sstream>

#include "cad_import/formats/file_format.h"
#include "tests/support/run_program.h"

namespace elbowroom::cad_models {
namespace {

namespace fs = std::filesystem;

// The deepest folder that holds them all.
fs::path CommonFolder(const std::vector<fs::path>& files) {
  fs::path folder = files.front().parent_path();
  for (const fs::path& file : files)
    while (file.lexically_relative(folder).string().starts_with("..")) folder = folder.parent_path();
  return folder;
}

std::vector<ModelFile> Named(const std::vector<fs::path>& files, const fs::path& folder,
                             const std::string& collection) {
  std::vector<ModelFile> named;
  for (const fs::path& file : files)
    if (cad_import::FindFormat(file) && fs::is_regular_file(file))
      named.push_back({collection + '/' + file.lexically_relative(folder).string(), file});
  std::ranges::sort(named, {}, &ModelFile::name);
  return named;
}

}  // namespace

std::optional<std::vector<ModelFile>> FilesOfPackage(const std::string& package) {
  const test_support::ProgramRun listed =
      test_support::RunProgram("/usr/bin/env", {"dpkg-query", "--listfiles", package});
  if (listed.exit_status != 0) return std::nullopt;
  std::vector<fs::path> files;
  std::istringstream lines(listed.out);
  for (std::string line; std::getline(lines, line);)
    if (cad_import::FindFormat(line)) files.emplace_back(line);
  if (files.empty()) return std::nullopt;
  return Named(files, CommonFolder(files), package);
}

std::optional<std::vector<ModelFile>> FilesOfFolder(const fs::path& folder, const std::string& name) {
  if (!fs::is_directory(folder)) return std::nullopt;
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) files.push_back(entry.path());
  return Named(files, folder, name);
}

}  // namespace elbowroom::cad_models
