#include "recon/footage/image_sequence.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;
namespace fs = std::filesystem;

// "mask_%04d.png" is {"mask_", 4, ".png"}.
struct NamePattern {
  std::string before;
  std::size_t digits = 0;
  std::string after;

  [[nodiscard]] std::string Name(long number) const {
    return fmt::format("{}{:0{}d}{}", before, number, std::max<std::size_t>(digits, 1), after);
  }
  // The number of a file of this pattern.
  [[nodiscard]] std::optional<long> NumberOf(const std::string& name) const {
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) {
      return std::nullopt;
    }
    const std::string middle = name.substr(before.size(), name.size() - before.size() - after.size());
    long number = 0;
    const auto [end, error] = std::from_chars(middle.data(), middle.data() + middle.size(), number);
    const bool is_number = error == std::errc() && end == middle.data() + middle.size() && number >= 0;
    return is_number && Name(number) == name ? std::optional(number) : std::nullopt;
  }
};

NamePattern ParsePattern(const fs::path& location, const std::string& who) {
  const auto fail = [&] {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: image pattern '{}' must have one %d or %0Nd, in the file's name "
                            "and not in a folder's",
                            who, location.string()));
  };
  const std::string name = location.filename().string();
  const std::size_t percent = name.find('%');
  if (percent == std::string::npos || location.parent_path().string().find('%') != std::string::npos) fail();
  std::size_t at = percent + 1, digits = 0;
  while (at < name.size() && std::isdigit(static_cast<unsigned char>(name[at])) != 0 && at < percent + 3) {
    digits = digits * 10 + static_cast<std::size_t>(name[at++] - '0');
  }
  if (at >= name.size() || name[at] != 'd' || (digits > 0 && name[percent + 1] != '0')) fail();
  NamePattern pattern{name.substr(0, percent), digits, name.substr(at + 1)};
  if (pattern.after.find('%') != std::string::npos) fail();
  return pattern;
}

std::vector<fs::path> FindNumbered(const fs::path& location, const std::string& who) {
  const NamePattern pattern = ParsePattern(location, who);
  std::error_code ignored;
  std::map<long, fs::path> found;
  for (const auto& entry : fs::directory_iterator(location.parent_path(), ignored)) {
    if (const auto number = pattern.NumberOf(entry.path().filename().string())) found[*number] = entry.path();
  }
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorKind::kFile, fmt::format("{}: image sequence '{}' {}", who, location.string(), what));
  };
  if (found.empty()) fail("has no files; check the path and the pattern");
  const long first = found.begin()->first;
  if (first > 1) fail(fmt::format("begins at number {}; it must begin at 0 or 1: renumber the files", first));
  std::vector<fs::path> files;
  for (const auto& [number, path] : found) {
    const long expected = first + static_cast<long>(files.size());
    if (number != expected) {
      fail(fmt::format("has a gap: '{}' is missing, '{}' is there; restore the missing files",
                       pattern.Name(expected), pattern.Name(number)));
    }
    files.push_back(path);
  }
  return files;
}

std::vector<fs::path> FindFitting(const fs::path& location, const std::string& who) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(location.parent_path(), ignored)) {
    const bool fits =
        ::fnmatch(location.filename().c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0;
    if (fits && HasImageExtension(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    throw Error(ErrorKind::kFile, fmt::format("{}: no image fits '{}'; check the path and the pattern", who,
                                              location.string()));
  }
  return files;
}

std::vector<fs::path> FindInFolder(const fs::path& folder, const std::string& who) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (HasImageExtension(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    throw Error(ErrorKind::kFile,
                fmt::format("{}: folder '{}' has no images; check the path", who, folder.string()));
  }
  return files;
}

}  // namespace

std::vector<fs::path> FindImageFiles(const std::string& location, const std::string& who) {
  const SourceKind kind = KindOf(location);
  if (kind == SourceKind::kSequence) return FindNumbered(location, who);
  if (kind == SourceKind::kGlob) return FindFitting(location, who);
  if (kind == SourceKind::kFolder) return FindInFolder(location, who);
  std::error_code ignored;
  if (!fs::exists(location, ignored)) {
    throw Error(ErrorKind::kFile,
                fmt::format("{}: image '{}' does not exist; check the path", who, location));
  }
  return {location};
}

}  // namespace elbowroom::recon
