#include "recon/rig_files/source_location.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace elbowroom::recon {

bool HasImageExtension(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 8> kExtensions{".png",  ".jpg", ".jpeg", ".bmp",
                                                        ".tiff", ".tif", ".pgm",  ".ppm"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

SourceKind KindOf(const std::string& location) {
  if (location.starts_with("device:")) return SourceKind::kDevice;
  if (location.find("://") != std::string::npos) return SourceKind::kUrl;
  if (location.find('%') != std::string::npos) return SourceKind::kSequence;
  std::error_code ignored;
  if (std::filesystem::is_directory(location, ignored)) return SourceKind::kFolder;
  if (location.find_first_of("*?") != std::string::npos && !std::filesystem::exists(location, ignored))
    return SourceKind::kGlob;
  return HasImageExtension(location) ? SourceKind::kImage : SourceKind::kVideo;
}

std::string ResolvedLocation(const std::string& location, const std::filesystem::path& folder) {
  if (location.empty()) return location;
  const SourceKind kind = KindOf(location);
  if (kind == SourceKind::kDevice || kind == SourceKind::kUrl) return location;
  return (folder / location).lexically_normal().string();
}

std::string LocationSeenFrom(const std::string& location, const std::filesystem::path& folder) {
  const std::filesystem::path path(location);
  if (!path.is_absolute()) return location;
  const std::filesystem::path relative = path.lexically_relative(folder.lexically_normal());
  return relative.empty() || *relative.begin() == ".." ? location : relative.string();
}

}  // namespace elbowroom::recon
