// How RIG.yml says where pictures come from.
#pragma once

#include <filesystem>
#include <string>

namespace elbowroom::recon {

enum class SourceKind {
  kDevice,    // "v4l2:/dev/video0", or "device:0" for the same
  kGenicam,   // "gige:NAME": a GigE Vision or USB3 Vision camera by its name, serial number or address
  kUrl,       // "rtsp://..."
  kSequence,  // "cam1/%04d.png"
  kGlob,      // "photos/*.jpg": every image whose name fits, by name
  kFolder,    // every image in it, by name
  kImage,     // "cam1/background.png"
  kVideo,     // any other file
};

[[nodiscard]] SourceKind KindOf(const std::string& location);

// Pictures come as they are taken, without an end.
[[nodiscard]] bool IsLive(const std::string& location);

// Paths that are relative are taken from `folder`; absolute paths, devices, URLs and "" stay.
[[nodiscard]] std::string ResolvedLocation(const std::string& location, const std::filesystem::path& folder);

// The reverse: files below `folder` become relative to it.
[[nodiscard]] std::string LocationSeenFrom(const std::string& location, const std::filesystem::path& folder);

// ".png", ".JPG" and the like.
[[nodiscard]] bool HasImageExtension(const std::filesystem::path& path);

}  // namespace elbowroom::recon
