#include "app/control/head/head_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "app/control/head/head_camera_file.h"
#include "cad_import/layout/toml_entry.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using cad_import::TomlEntry;
using core::RigidTransform;
using Eigen::Vector3d;

constexpr std::string_view kFrameKeys[] = {"position_mm", "rotation_rpy_deg"};

// A table of its own, with what messages need.
std::optional<TomlEntry> TableOf(const toml::table& root, const std::string& file, std::string_view key,
                                 std::span<const std::string_view> known) {
  const toml::table* table = root.get_as<toml::table>(key);
  if (const toml::node* other = root.get(key); other != nullptr && table == nullptr)
    throw core::Error(core::ErrorKind::kFormat, fmt::format("{}:{}: '{}' must be a table: [{}]", file,
                                                            other->source().begin.line, key, key));
  if (table == nullptr) return std::nullopt;
  return TomlEntry(*table, file, "[" + std::string(key) + "]", known);
}

RigidTransform FrameOf(const toml::table& root, const std::string& file, std::string_view key) {
  const auto entry = TableOf(root, file, key, kFrameKeys);
  if (!entry) return {};
  return core::FromPositionAndRollPitchYaw(entry->VectorOrZero("position_mm"),
                                           entry->VectorOrZero("rotation_rpy_deg"));
}

std::optional<int> WholeNumber(const TomlEntry& entry, std::string_view key, int least, int most) {
  if (entry.Find(key) == nullptr) return std::nullopt;
  const double value = entry.Number(key);
  if (!(value >= least && value <= most && value == std::floor(value)))
    entry.Fail(key, "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return static_cast<int>(value);
}

// The axes whose direction is the other one: inverted = ["yaw", "x"].
ReadingSigns SignsOf(const TomlEntry& entry) {
  constexpr std::string_view kAxes[] = {"x", "y", "z", "yaw", "pitch", "roll"};
  ReadingSigns signs = kNoSignChanged;
  for (const std::string& name : entry.Texts("inverted")) {
    const auto* axis = std::ranges::find(kAxes, name);
    if (axis == std::end(kAxes)) entry.Fail("inverted", "must list some of x, y, z, yaw, pitch, roll");
    signs[static_cast<std::size_t>(axis - kAxes)] = -1.0;
  }
  return signs;
}

recon::HeadsetSpace SpaceOf(const TomlEntry& entry) {
  const std::string text = entry.TextOr("space", "stage");
  if (text == "local") return recon::HeadsetSpace::kLocal;
  if (text != "stage") entry.Fail("space", "must be stage or local");
  return recon::HeadsetSpace::kStage;
}

void ReadFixed(const toml::table& root, const std::string& file, HeadSettings* settings) {
  constexpr std::string_view kKeys[] = {"eyes_mm", "looks_at_mm"};
  const auto entry = TableOf(root, file, "fixed", kKeys);
  if (!entry) return;
  const Vector3d eyes = entry->VectorOrZero("eyes_mm"), target = entry->VectorOrZero("looks_at_mm");
  if ((eyes - target).norm() < 1.0) entry->Fail("looks_at_mm", "must be another place than eyes_mm");
  settings->world_from_fixed_head = HeadSettings::LookingAt(eyes, target);
}

}  // namespace

std::optional<recon::HeadSource> ParseHeadSource(std::string_view text) {
  using recon::HeadSource;
  for (const HeadSource source : {HeadSource::kFixed, HeadSource::kOpenTrack, HeadSource::kFreeD,
                                  HeadSource::kCap, HeadSource::kOpenXr})
    if (text == recon::ToString(source)) return source;
  return std::nullopt;
}

int HeadSettings::port_or_default() const {
  return port.value_or(source == recon::HeadSource::kFreeD ? kFreeDPort : kOpenTrackPort);
}

RigidTransform HeadSettings::WorldFromHead(const TrackerReading& reading) const {
  return world_from_tracker * TrackerFromHead(reading, signs) * sensor_from_head;
}

RigidTransform HeadSettings::LookingAt(const Vector3d& eyes_in_world, const Vector3d& target_in_world) {
  return core::CamFromWorldLookingAt(eyes_in_world, target_in_world).Inverse();
}

HeadSettings ReadHeadFile(const std::filesystem::path& path) {
  const std::string file = path.string();
  const toml::table root = cad_import::ParseTomlFile(path, "head file");
  const TomlEntry entry(root, file, "",
                        {"source", "address", "port", "camera", "inverted", "cap", "space", "tracker",
                         "sensor", "head_camera", "fixed"});
  HeadSettings settings;
  const auto source = ParseHeadSource(entry.TextOr("source", "fixed"));
  if (!source) entry.Fail("source", "must be fixed, opentrack, freed, cap or openxr");
  settings.source = *source;
  settings.address = entry.TextOr("address", settings.address);
  settings.port = WholeNumber(entry, "port", 1, 65535);
  settings.camera = WholeNumber(entry, "camera", 0, 255);
  settings.signs = SignsOf(entry);
  settings.space = SpaceOf(entry);
  settings.world_from_tracker = FrameOf(root, file, "tracker");
  settings.sensor_from_head = FrameOf(root, file, "sensor");
  settings.head_camera = HeadCameraOf(root, file);
  ReadFixed(root, file, &settings);
  if (entry.Find("cap") != nullptr) settings.cap = ReadCapFile(path.parent_path() / entry.Text("cap"));
  return settings;
}

}  // namespace elbowroom::control
