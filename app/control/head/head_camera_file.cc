// The head camera in HEAD.toml.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <utility>

#include "app/control/head/head_camera_file.h"
#include "app/control/head/head_settings.h"
#include "cad_import/layout/toml_entry.h"
#include "cad_import/layout/toml_lines.h"
#include "core/error.h"
#include "core/system/whole_file.h"
#include "core/units.h"

namespace elbowroom::control {
namespace {

constexpr std::string_view kTable = "head_camera";

Eigen::Vector3d RollPitchYawDeg(const Eigen::Matrix3d& r) {
  return {core::DegreesFromRadians(std::atan2(r(2, 1), r(2, 2))),
          core::DegreesFromRadians(std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2)))),
          core::DegreesFromRadians(std::atan2(r(1, 0), r(0, 0)))};
}

std::vector<std::pair<std::string, std::string>> ValuesOf(const recon::HeadCamera& camera) {
  const Eigen::Vector3d& at = camera.head_from_camera.translation_mm;
  const Eigen::Vector3d turn = RollPitchYawDeg(camera.head_from_camera.rotation);
  return {{"position_mm", fmt::format("[{:.3f}, {:.3f}, {:.3f}]", at.x(), at.y(), at.z())},
          {"rotation_rpy_deg", fmt::format("[{:.5f}, {:.5f}, {:.5f}]", turn.x(), turn.y(), turn.z())},
          {"focal_px", fmt::format("{:.3f}", camera.focal_px)},
          {"size_px", fmt::format("[{}, {}]", camera.width_px, camera.height_px)}};
}

// The text with the values in the place of those of the table, and those that it lacks below its header.
std::string WithValues(std::string text, const std::string& file, const recon::HeadCamera& camera) {
  const toml::table document = cad_import::ParseToml(text, file);
  const cad_import::TomlLines lines(text, document);
  const toml::table* table = document.get_as<toml::table>(kTable);
  const std::string end(lines.EndOfLine());
  std::string missing;
  std::vector<std::pair<toml::source_region, std::string>> replaced;
  for (const auto& [key, value] : ValuesOf(camera)) {
    const toml::node* node = table == nullptr ? nullptr : table->get(key);
    if (node == nullptr) {
      missing += key + " = " + value + end;
    } else {
      replaced.emplace_back(node->source(), value);
    }
  }
  std::vector<std::pair<std::size_t, std::pair<std::size_t, std::string>>> edits;  // from, to, text
  for (const auto& [at, value] : replaced)
    edits.push_back({lines.Offset(at.begin), {lines.Offset(at.end), value}});
  if (table == nullptr) {
    const std::string gap = text.empty() ? "" : (text.ends_with('\n') ? end : end + end);
    edits.push_back({text.size(), {text.size(), gap + "[" + std::string(kTable) + "]" + end + missing}});
  } else if (!missing.empty()) {
    const std::size_t below = lines.Start(static_cast<std::size_t>(table->source().begin.line));
    edits.push_back({below, {below, missing}});
  }
  std::ranges::sort(edits, std::greater(), [](const auto& edit) { return edit.first; });
  for (const auto& [from, rest] : edits) text.replace(from, rest.first - from, rest.second);
  return text;
}

// Whether all but the head camera is as it was.
bool KeepsTheRest(const std::string& before, const std::string& after, const std::string& file) {
  toml::table a = cad_import::ParseToml(before, file), b = cad_import::ParseToml(after, file);
  a.erase(kTable);
  b.erase(kTable);
  return cad_import::SaysTheSame(a, b);
}

}  // namespace

std::optional<recon::HeadCamera> HeadCameraOf(const toml::table& root, const std::string& file) {
  const toml::table* table = root.get_as<toml::table>(kTable);
  if (const toml::node* other = root.get(kTable); other != nullptr && table == nullptr)
    throw core::Error(core::ErrorKind::kFormat, fmt::format("{}:{}: '{}' must be a table: [{}]", file,
                                                            other->source().begin.line, kTable, kTable));
  if (table == nullptr) return std::nullopt;
  const cad_import::TomlEntry entry(*table, file, "[head_camera]",
                                    {"position_mm", "rotation_rpy_deg", "focal_px", "size_px"});
  recon::HeadCamera camera;
  camera.head_from_camera = core::FromPositionAndRollPitchYaw(entry.VectorOrZero("position_mm"),
                                                              entry.VectorOrZero("rotation_rpy_deg"));
  camera.focal_px = entry.NumberOr("focal_px", camera.focal_px);
  const toml::array* size = table->get_as<toml::array>("size_px");
  if (entry.Find("size_px") != nullptr) {
    const auto width =
        size != nullptr && size->size() == 2 ? size->get(0)->value_exact<std::int64_t>() : std::nullopt;
    const auto height = width ? size->get(1)->value_exact<std::int64_t>() : std::nullopt;
    if (!height || *width < 1 || *height < 1 || *width > 16384 || *height > 16384)
      entry.Fail("size_px", "must be the picture's width and height in pixels, as [640, 480]");
    camera.width_px = static_cast<int>(*width);
    camera.height_px = static_cast<int>(*height);
  }
  if (!(camera.focal_px > 0.0 && camera.focal_px <= 1e5))
    entry.Fail("focal_px", "must lie within (0, 100000]");
  return camera;
}

void WriteHeadCamera(const std::filesystem::path& path, const recon::HeadCamera& camera) {
  camera.Validate();
  const std::string file = path.string();
  const std::string before = std::filesystem::exists(path) ? cad_import::ReadTomlText(path, "head file") : "";
  const std::string after = WithValues(before, file, camera);
  if (!KeepsTheRest(before, after, file) || !HeadCameraOf(cad_import::ParseToml(after, file), file))
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format("{}: the head camera can't be written into it: write a table [head_camera]", file));
  core::WriteWholeFile(path, after);
}

}  // namespace elbowroom::control
