#include "recon/rig_files/source_location.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/spelling.h"

namespace elbowroom::recon {

bool HasImageExtension(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 8> kExtensions{".png",  ".jpg", ".jpeg", ".bmp",
                                                        ".tiff", ".tif", ".pgm",  ".ppm"};
  const std::string extension = core::LowerCase(path.extension().string());
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

SourceKind KindOf(const std::string& location) {
  if (location.starts_with("device:") || location.starts_with("v4l2:")) return SourceKind::kDevice;
  if (location.starts_with("gige:")) return SourceKind::kGenicam;
  if (location.find("://") != std::string::npos) return SourceKind::kUrl;
  if (location.find('%') != std::string::npos) return SourceKind::kSequence;
  std::error_code ignored;
  if (std::filesystem::is_directory(location, ignored)) return SourceKind::kFolder;
  if (location.find_first_of("*?") != std::string::npos && !std::filesystem::exists(location, ignored))
    return SourceKind::kGlob;
  return HasImageExtension(location) ? SourceKind::kImage : SourceKind::kVideo;
}

bool IsLive(const std::string& location) {
  switch (KindOf(location)) {
    case SourceKind::kDevice:
    case SourceKind::kGenicam:
    case SourceKind::kUrl:
      return true;
    case SourceKind::kSequence:
    case SourceKind::kGlob:
    case SourceKind::kFolder:
    case SourceKind::kImage:
    case SourceKind::kVideo:
      break;
  }
  return false;
}

std::string ResolvedLocation(const std::string& location, const std::filesystem::path& folder) {
  if (location.empty() || IsLive(location)) return location;
  return (folder / location).lexically_normal().string();
}

std::string LocationSeenFrom(const std::string& location, const std::filesystem::path& folder) {
  const std::filesystem::path path(location);
  if (!path.is_absolute()) return location;
  const std::filesystem::path relative = path.lexically_relative(folder.lexically_normal());
  return relative.empty() || *relative.begin() == ".." ? location : relative.string();
}

}  // namespace elbowroom::recon
