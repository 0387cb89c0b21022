#include <fmt/format.h>

#include <Eigen/Core>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/system/configuration_file.h"
#include "core/system/whole_file.h"
#include "recon/rig_files/rig_file.h"
#include "recon/rig_files/source_location.h"
#include "recon/rig_files/yaml_text.h"

namespace elbowroom::recon {
namespace {

// The shortest text that reads back as the same double, with a point: a bare 5000000000 would be read as an
// int.
std::string Number(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string NumberList(std::span<const double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + Number(value);
  return "[ " + text + " ]";
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string MatrixText(const char* key, int rows, int cols, std::span<const double> values) {
  return fmt::format(
      "      {}: !!opencv-matrix\n         rows: {}\n         cols: {}\n         dt: d\n         data: {}\n",
      key, rows, cols, NumberList(values));
}

std::string Matrix3Text(const char* key, const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_rows = matrix;
  return MatrixText(key, 3, 3, {by_rows.data(), 9});
}

std::string CameraText(const core::CameraCalibration& c, bool is_calibrated) {
  const std::vector<double>& d = c.distortion_coefficients;
  // An empty !!opencv-matrix can't be read back; no distortion is a list of zeros.
  const std::vector<double> coefficients = d.empty() ? std::vector<double>(4, 0.0) : d;
  const std::string size =
      fmt::format("   -\n      name: {}\n      image_width: {}\n      image_height: {}\n", Quoted(c.name),
                  c.image_width_px, c.image_height_px);
  if (!is_calibrated) return size;
  return size + Matrix3Text("camera_matrix", c.camera_matrix) +
         fmt::format("      distortion_model: \"{}\"\n", core::ToString(c.distortion_model)) +
         MatrixText("distortion_coefficients", 1, static_cast<int>(coefficients.size()), coefficients) +
         Matrix3Text("rotation_cam_from_world", c.cam_from_world.rotation) +
         MatrixText("translation_cam_from_world_mm", 3, 1, {c.cam_from_world.translation_mm.data(), 3});
}

// Empty where the camera keeps all of its own settings.
std::string CaptureText(const CaptureSettings& settings) {
  std::string text;
  const auto add = [&](const char* key, const std::string& value) {
    text += fmt::format("         {}: {}\n", key, value);
  };
  const auto add_number = [&](const char* key, const std::optional<double>& value) {
    if (value) add(key, Number(*value));
  };
  add_number("rate_hz", settings.rate_hz);
  add_number("exposure_us", settings.exposure_us);
  add_number("gain_db", settings.gain_db);
  add_number("white_balance_k", settings.white_balance_k);
  if (settings.trigger != CaptureTrigger::kFree)
    add("trigger", Quoted(std::string(ToString(settings.trigger))));
  if (!settings.pixel_format.empty()) add("pixel_format", Quoted(settings.pixel_format));
  if (settings.packet_bytes) add("packet_bytes", fmt::format("{}", *settings.packet_bytes));
  return text.empty() ? text : "      capture:\n" + text;
}

// Nine digits are plenty for a variance, and keep a large rig's file small.
std::string CalibrationText(const RigCalibration& calibration) {
  std::string text =
      fmt::format("calibration:\n   made: {}\n   board: {}\n   rms_px: {}\n", Quoted(calibration.made),
                  Quoted(calibration.board), Number(calibration.rms_px));
  if (calibration.held_out_rms_px)
    text += fmt::format("   held_out_rms_px: {}\n", Number(*calibration.held_out_rms_px));
  text += fmt::format("   noise_px: {}\n", Number(calibration.noise_px));
  if (calibration.covariance.size() == 0) return text;
  text +=
      "   # The lower triangle, row by row; for each camera fx fy cx cy, the lens, a turn, a shift, the time "
      "offset.\n";
  text += "   covariance: [";
  for (Eigen::Index row = 0; row < calibration.covariance.rows(); ++row) {
    text += row > 0 ? ",\n      " : " ";
    for (Eigen::Index column = 0; column <= row; ++column)
      text += fmt::format("{}{:.9e}", column > 0 ? ", " : "", calibration.covariance(row, column));
  }
  return text + " ]\n";
}

std::string GaugeText(const core::RigGauge& gauge) {
  return fmt::format(
      "gauge:\n   made: {}\n   true_diameter_mm: {}\n   diameter_mm: {}\n   error_mm: {}\n   bound_mm: {}\n"
      "   places: {}\n   passed: {}\n",
      Quoted(gauge.made), Number(gauge.true_diameter_mm), Number(gauge.diameter_mm), Number(gauge.error_mm),
      Number(gauge.bound_mm), gauge.places, gauge.passed);
}

// The text without its block `gauge:`, with the new one at the end.
std::string WithGauge(const std::string& text, const core::RigGauge& gauge) {
  std::istringstream lines(text);
  std::string kept, line;
  bool is_gauge = false;
  while (std::getline(lines, line)) {
    const bool is_top =
        !line.empty() && std::string_view(" \t#\r").find(line.front()) == std::string_view::npos;
    if (is_top) is_gauge = line.starts_with("gauge:");
    if (!is_gauge) kept += line + "\n";
  }
  return kept + GaugeText(gauge);
}

// Whether the changed text is the same document with that gauge.
bool SaysTheSame(const YamlNode& before, const std::string& changed, const core::RigGauge& gauge) {
  try {
    const YamlNode after = ParseYaml(changed, "");
    const std::string alone = "%YAML:1.0\n---\n" + GaugeText(gauge);
    const YamlNode gauge_alone = ParseYaml(alone, "");
    std::vector<std::string> keys = before.keys;
    std::erase(keys, "gauge");
    keys.emplace_back("gauge");
    return after.keys == keys && after.items.back().keys == gauge_alone.items.back().keys;
  } catch (const core::Error&) {
    return false;  // as of a document in braces, after which nothing may stand
  }
}

}  // namespace

void WriteRigFile(const RigFile& rig_file, const std::filesystem::path& path) {
  const core::Rig& rig = rig_file.rig;
  core::Require(rig_file.sources.size() == rig.cameras.size(), "a rig file has sources for every camera");
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const Eigen::Vector3d low = rig.workspace_mm.min(), high = rig.workspace_mm.max();
  const double workspace[] = {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()};
  std::string text = fmt::format("%YAML:1.0\n---\nrig_name: {}\n", Quoted(rig.name));
  if (rig_file.is_calibrated) text += fmt::format("workspace_mm: {}\n", NumberList(workspace));
  text += fmt::format("unseen: \"{}\"\ncameras:\n",
                      rig.unseen == core::UnseenPolicy::kAbstain ? "abstain" : "outside");
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    text += CameraText(rig.cameras[i].calibration(), rig_file.is_calibrated);
    const auto add = [&](const char* key, const std::string& location) {
      if (!location.empty())
        text += fmt::format("      {}: {}\n", key, Quoted(LocationSeenFrom(location, folder)));
    };
    add("frames", rig_file.sources[i].frames);
    add("background", rig_file.sources[i].background);
    add("masks", rig_file.sources[i].masks);
    add("timestamps", rig_file.sources[i].timestamps);
    if (rig_file.sources[i].time_offset_s != 0.0)
      text += fmt::format("      time_offset_s: {}\n", Number(rig_file.sources[i].time_offset_s));
    text += CaptureText(rig_file.sources[i].capture);
  }
  if (rig_file.calibration) text += CalibrationText(*rig_file.calibration);
  if (rig_file.gauge) text += GaugeText(*rig_file.gauge);
  core::WriteWholeFile(path, text);
}

void SaveGauge(const core::RigGauge& gauge, const std::filesystem::path& path) {
  RigFile rig_file = ReadRigFile(path);
  const std::string who = fmt::format("rig file '{}'", path.string());
  const std::string text = core::ReadConfiguration(path, who, "rig file");
  const std::string changed = WithGauge(text, gauge);
  if (SaysTheSame(ParseYaml(text, who), changed, gauge)) {
    core::WriteWholeFile(path, changed);
    return;
  }
  rig_file.gauge = gauge;
  WriteRigFile(rig_file, path);
}

}  // namespace elbowroom::recon
