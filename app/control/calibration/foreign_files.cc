#include "app/control/calibration/foreign_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "app/control/calibration/foreign_toml.h"
#include "core/error.h"
#include "core/system/configuration_file.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;
using recon::ForeignFormat;

bool IsToml(const std::filesystem::path& file, std::optional<ForeignFormat> format) {
  return format == ForeignFormat::kAnipose || format == ForeignFormat::kCaliscope ||
         (!format && file.extension() == ".toml");
}

recon::ForeignRig ReadOne(const std::filesystem::path& file, std::optional<ForeignFormat> format) {
  const std::string who = fmt::format("calibration '{}'", file.string());
  const std::string text = core::ReadConfiguration(file, who, "calibration file");
  recon::ForeignRig rig;
  if (IsToml(file, format)) {
    rig = ParseForeignToml(text, file.string());
    if (format) rig.format = *format;
    return rig;
  }
  if (!format) format = recon::FormatOf(text, who);
  return recon::ParseForeignRig(text, *format, who, file.stem().string());
}

std::string NamesOf(const recon::ForeignRig& rig) {
  std::string names;
  for (const recon::ForeignCamera& camera : rig.cameras)
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", camera.name);
  return names;
}

// Messages of core::CameraModel name the camera, not its file. A size of 1 x 1 stands in for one that the
// file doesn't say.
void RequireLens(const core::CameraCalibration& lens, const std::filesystem::path& file) {
  core::CameraCalibration sized = lens;
  if (sized.image_width_px == 0) sized.image_width_px = sized.image_height_px = 1;
  try {
    (void)core::CameraModel(sized);
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("lens file '{}': {}", file.string(), error.what()));
  }
}

}  // namespace

recon::ForeignRig ReadForeignFiles(std::span<const std::filesystem::path> files,
                                   std::optional<ForeignFormat> format) {
  std::vector<recon::ForeignRig> rigs;
  for (const std::filesystem::path& file : files) rigs.push_back(ReadOne(file, format));
  return recon::Joined(std::move(rigs));
}

core::CameraCalibration ReadLensFile(const std::filesystem::path& file, const std::string& name) {
  const recon::ForeignRig rig = ReadOne(file, std::nullopt);
  if (rig.format == ForeignFormat::kProjection)
    throw Error(ErrorKind::kFormat,
                fmt::format("lens file '{}': holds 3 x 4 matrices or is no calibration; give a file with a "
                            "camera matrix and a lens",
                            file.string()));
  const auto found = std::ranges::find_if(rig.cameras, [&](const recon::ForeignCamera& camera) {
    return recon::IsSameCamera(camera.name, name) || recon::IsSameCamera(camera.alias, name);
  });
  if (found == rig.cameras.end() && rig.cameras.size() != 1)
    throw Error(ErrorKind::kCamera,
                fmt::format("lens file '{}': has no camera '{}', only {}; name the camera as there",
                            file.string(), name, rig.cameras.empty() ? "a pose" : NamesOf(rig)));
  core::CameraCalibration lens = found == rig.cameras.end() ? rig.cameras.front().lens : found->lens;
  lens.name = name;
  RequireLens(lens, file);
  return lens;
}

}  // namespace elbowroom::control
