#include "recon/rig_files/rig_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file_limits.h"
#include "recon/rig_files/source_location.h"
#include "recon/rig_files/yaml_section.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

constexpr const char* kDistortionModels = "\"plumb_bob\", \"rational_polynomial\" or \"fisheye\"";

constexpr const char* kPixels = "a whole number of pixels";

constexpr std::string_view kRigKeys[] = {"rig_name", "workspace_mm", "unseen",
                                         "cameras",  "calibration",  "gauge"};
constexpr std::string_view kCalibrationKeys[] = {"made",     "board",     "rms_px", "held_out_rms_px",
                                                 "noise_px", "covariance"};
constexpr std::string_view kGaugeKeys[] = {"made",     "true_diameter_mm", "diameter_mm", "error_mm",
                                           "bound_mm", "places",           "passed"};
constexpr std::string_view kCameraKeys[] = {"name",
                                            "image_width",
                                            "image_height",
                                            "camera_matrix",
                                            "distortion_model",
                                            "distortion_coefficients",
                                            "rotation_cam_from_world",
                                            "translation_cam_from_world_mm",
                                            "frames",
                                            "background",
                                            "masks",
                                            "timestamps",
                                            "time_offset_s",
                                            "capture"};
constexpr std::string_view kCaptureKeys[] = {"width",       "height",       "rate_hz",
                                             "exposure_us", "gain_db",      "white_balance_k",
                                             "trigger",     "pixel_format", "packet_bytes"};
constexpr std::string_view kViewKeys[] = {"name",
                                          "image_width",
                                          "image_height",
                                          "camera_matrix",
                                          "distortion_model",
                                          "distortion_coefficients",
                                          "rotation_cam_from_world",
                                          "translation_cam_from_world_mm",
                                          "projection",
                                          "camera",
                                          "cameras"};

Eigen::Matrix3d Matrix3(const YamlSection& section, const char* key) {
  const std::vector<double> n = section.Numbers(key, 3, 9, "a 3 x 3 matrix, row by row");
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(n.data());
}

core::DistortionModel ParseModel(const YamlSection& section, const std::string& model) {
  const auto parsed = core::ParseDistortionModel(model);
  if (!parsed)
    section.Fail(fmt::format("distortion_model '{}' is unknown; it must be {}", model, kDistortionModels));
  return *parsed;
}

void ReadLens(const YamlSection& section, core::CameraCalibration* calibration) {
  (void)section.Get("distortion_model", kDistortionModels);
  calibration->distortion_model = ParseModel(section, section.TextOr("distortion_model", ""));
  calibration->distortion_coefficients = section.Numbers("distortion_coefficients", 1, 0, "a 1 x N matrix");
}

// `count` lengths, each of at most core::kLongestLengthMm.
std::vector<double> Lengths(const YamlSection& section, const char* key, int rows, std::size_t count,
                            const char* shape, ErrorKind kind) {
  std::vector<double> lengths_mm = section.Numbers(key, rows, count, shape);
  for (const double length_mm : lengths_mm) {
    if (std::abs(length_mm) > core::kLongestLengthMm)
      section.Fail(fmt::format("{} holds {}, which is beyond {} mm; check its unit", key, length_mm,
                               core::kLongestLengthMm),
                   kind);
  }
  return lengths_mm;
}

// A camera without a lens needs no keys that describe one.
core::CameraModel ReadCamera(const YamlSection& section, const std::string& name, bool has_lens) {
  core::CameraCalibration calibration;
  calibration.name = name;
  calibration.image_width_px = section.Integer("image_width", kPixels);
  calibration.image_height_px = section.Integer("image_height", kPixels);
  calibration.camera_matrix = Matrix3(section, "camera_matrix");
  if (has_lens) ReadLens(section, &calibration);
  calibration.cam_from_world.rotation = Matrix3(section, "rotation_cam_from_world");
  const std::vector<double> t = Lengths(section, "translation_cam_from_world_mm", 3, 3,
                                        "a 3 x 1 matrix in millimetres", ErrorKind::kCamera);
  calibration.cam_from_world.translation_mm = {t[0], t[1], t[2]};
  try {
    return core::CameraModel(std::move(calibration));
  } catch (const Error& error) {
    YamlSection{section.node, section.file}.Fail(error.what(), error.kind());  // the message names the camera
  }
}

constexpr const char* kPoseKeys[] = {"camera_matrix", "rotation_cam_from_world",
                                     "translation_cam_from_world_mm"};

bool SaysNothingOfCalibration(const YamlSection& section) {
  return std::ranges::none_of(kPoseKeys, [&](const char* key) { return section.Find(key) != nullptr; });
}

core::CameraModel ReadUncalibrated(const YamlSection& section, const std::string& name) {
  try {
    return PlaceholderCamera(name, section.Integer("image_width", kPixels),
                             section.Integer("image_height", kPixels));
  } catch (const Error& error) {
    YamlSection{section.node, section.file}.Fail(error.what(), error.kind());  // the message names the camera
  }
}

Eigen::AlignedBox3d ReadWorkspace(const YamlSection& section) {
  constexpr const char* kShape = "[x0,y0,z0,x1,y1,z1] in millimetres";
  const std::vector<double> n = Lengths(section, "workspace_mm", 0, 6, kShape, ErrorKind::kRange);
  return {Eigen::Vector3d(n[0], n[1], n[2]), Eigen::Vector3d(n[3], n[4], n[5])};
}

core::UnseenPolicy ReadUnseen(const YamlSection& section) {
  const std::string text = section.TextOr("unseen", "outside");
  if (text == "outside") return core::UnseenPolicy::kOutside;
  if (text == "abstain") return core::UnseenPolicy::kAbstain;
  section.Fail(fmt::format("unseen is '{}'; say \"outside\" or \"abstain\"", text));
}

struct Allowed {
  double least = 0.0;
  double most = 0.0;
};

std::optional<double> ReadSetting(const YamlSection& section, const char* key, Allowed allowed) {
  if (section.Find(key) == nullptr) return std::nullopt;
  const double value = section.NumberOr(key, 0.0);
  if (!(value >= allowed.least && value <= allowed.most))
    section.Fail(fmt::format("{} is {}; it must be {} to {}", key, value, allowed.least, allowed.most),
                 ErrorKind::kRange);
  return value;
}

// A calibration holds for one size of picture, so the camera is set to that.
void RequireCalibratedSize(const YamlSection& section, const char* key, int calibrated_px) {
  if (section.Find(key) == nullptr) return;
  if (const int size_px = section.Integer(key, kPixels); size_px != calibrated_px)
    section.Fail(
        fmt::format("{} is {}, but the camera was calibrated with {}; leave it out, or calibrate again", key,
                    size_px, calibrated_px));
}

CaptureSettings ReadCapture(const YamlSection& camera, const core::CameraModel& model) {
  const YamlNode* node = camera.Find("capture");
  if (node == nullptr) return {};
  if (node->kind != YamlKind::kMap) camera.Fail("key 'capture' must be a map");
  const YamlSection section{node, camera.file, fmt::format("{}, capture", camera.title)};
  section.RefuseMisspelt(kCaptureKeys);
  RequireCalibratedSize(section, "width", model.width_px());
  RequireCalibratedSize(section, "height", model.height_px());
  constexpr double kTiny = 1e-3;
  CaptureSettings settings;
  settings.rate_hz = ReadSetting(section, "rate_hz", {kTiny, 1000.0});
  settings.exposure_us = ReadSetting(section, "exposure_us", {kTiny, 1e6});
  settings.gain_db = ReadSetting(section, "gain_db", {-20.0, 100.0});
  settings.white_balance_k = ReadSetting(section, "white_balance_k", {1000.0, 20'000.0});
  const std::string trigger = section.TextOr("trigger", "free");
  const auto parsed = ParseCaptureTrigger(trigger);
  if (!parsed)
    section.Fail(fmt::format("trigger is '{}'; say \"free\", \"software\" or \"hardware\"", trigger));
  settings.trigger = *parsed;
  settings.pixel_format = section.TextOr("pixel_format", "");
  if (const auto bytes = ReadSetting(section, "packet_bytes", {576.0, 16'000.0}))
    settings.packet_bytes = static_cast<int>(*bytes);
  return settings;
}

void AddCamera(const YamlNode& node, const std::string& file, const std::filesystem::path& folder, RigUse use,
               RigFile& rig_file) {
  YamlSection section{&node, file, fmt::format("camera number {}", rig_file.sources.size() + 1)};
  if (node.kind != YamlKind::kMap) section.Fail("must be a map of keys such as name and camera_matrix");
  const std::string name = section.TextOr("name", "");
  if (name.empty())
    section.Fail("key 'name' is missing or empty; give the camera a name that no other bears");
  section.title = fmt::format("camera '{}'", name);
  if (name.find('/') != std::string::npos || name == "." || name == "..")
    section.Fail("this name can't be part of a file's name; choose one without '/'");
  section.RefuseMisspelt(kCameraKeys);
  for (const core::CameraModel& other : rig_file.rig.cameras) {
    if (other.name() == name) section.Fail("this name occurs twice; give every camera its own");
  }
  if (SaysNothingOfCalibration(section)) {
    if (use == RigUse::kMeasure)
      section.Fail("not calibrated yet (no camera_matrix, no pose); 'elbowroom calibrate' does it");
    rig_file.is_calibrated = false;
  }
  rig_file.rig.cameras.push_back(SaysNothingOfCalibration(section) ? ReadUncalibrated(section, name)
                                                                   : ReadCamera(section, name, true));
  rig_file.sources.push_back({ResolvedLocation(section.TextOr("frames", ""), folder),
                              ResolvedLocation(section.TextOr("background", ""), folder),
                              ResolvedLocation(section.TextOr("masks", ""), folder),
                              ResolvedLocation(section.TextOr("timestamps", ""), folder),
                              section.NumberOr("time_offset_s", 0.0),
                              ReadCapture(section, rig_file.rig.cameras.back())});
}

// A symmetric matrix, of which the file has the lower triangle, row by row.
Eigen::MatrixXd ReadCovariance(const YamlSection& section, const core::Rig& rig) {
  std::size_t size = 0;
  for (const core::CameraModel& camera : rig.cameras)
    size += 11 + camera.calibration().distortion_coefficients.size();
  const std::vector<double> numbers =
      section.Numbers("covariance", 0, size * (size + 1) / 2,
                      fmt::format("the lower triangle of a matrix of {0} x {0}", size).c_str());
  Eigen::MatrixXd covariance(size, size);
  std::size_t next = 0;
  for (Eigen::Index row = 0; row < covariance.rows(); ++row) {
    for (Eigen::Index column = 0; column <= row; ++column)
      covariance(row, column) = covariance(column, row) = numbers[next++];
    if (covariance(row, row) < 0.0) section.Fail("covariance has a negative variance");
  }
  return covariance;
}

std::optional<RigCalibration> ReadCalibration(const YamlSection& root, const core::Rig& rig) {
  const YamlNode* node = root.Find("calibration");
  if (node == nullptr) return std::nullopt;
  if (node->kind != YamlKind::kMap) root.Fail("key 'calibration' must be a map");
  const YamlSection section{node, root.file, "calibration"};
  section.RefuseMisspelt(kCalibrationKeys);
  RigCalibration calibration;
  calibration.made = section.TextOr("made", "");
  calibration.board = section.TextOr("board", "");
  calibration.rms_px = section.NumberOr("rms_px", 0.0);
  if (section.Find("held_out_rms_px") != nullptr)
    calibration.held_out_rms_px = section.NumberOr("held_out_rms_px", 0.0);
  calibration.noise_px = section.NumberOr("noise_px", 0.0);
  if (section.Find("covariance") != nullptr) calibration.covariance = ReadCovariance(section, rig);
  return calibration;
}

bool ReadPassed(const YamlSection& section) {
  (void)section.Get("passed", "true or false");
  const std::string text = section.TextOr("passed", "");
  if (text != "true" && text != "false")
    section.Fail(fmt::format("passed is '{}'; it must be true or false", text));
  return text == "true";
}

// Verdicts depend on a gauge, so nothing in it is guessed.
std::optional<core::RigGauge> ReadGauge(const YamlSection& root) {
  const YamlNode* node = root.Find("gauge");
  if (node == nullptr) return std::nullopt;
  if (node->kind != YamlKind::kMap) root.Fail("key 'gauge' must be a map");
  const YamlSection section{node, root.file, "gauge"};
  section.RefuseMisspelt(kGaugeKeys);
  const auto number = [&](const char* key) {
    (void)section.Get(key, "a number of millimetres");
    return section.NumberOr(key, 0.0);
  };
  core::RigGauge gauge;
  gauge.made = section.TextOr("made", "");
  gauge.true_diameter_mm = number("true_diameter_mm");
  gauge.diameter_mm = number("diameter_mm");
  gauge.error_mm = number("error_mm");
  gauge.bound_mm = number("bound_mm");
  gauge.places = section.Integer("places", "a whole number of places");
  gauge.passed = ReadPassed(section);
  return gauge;
}

// Where a view file has its camera's keys.
YamlSection ViewSection(const YamlSection& root) {
  const YamlNode *camera = root.Find("camera"), *cameras = root.Find("cameras");
  root.RefuseMisspelt(kViewKeys);
  if (camera == nullptr && cameras == nullptr) return root;
  if (camera != nullptr && cameras != nullptr) root.Fail("has both 'camera' and 'cameras'; keep one");
  if (camera == nullptr && (cameras->kind != YamlKind::kList || cameras->items.size() != 1))
    root.Fail("'cameras' must list exactly one camera");
  YamlSection section{camera == nullptr ? &cameras->items.front() : camera, root.file};
  if (section.node->kind != YamlKind::kMap)
    section.Fail("the camera must be a map of keys such as camera_matrix");
  if (root.Find("projection") != nullptr) root.Fail("'projection' must stand among the camera's keys");
  return section;
}

bool ReadIsOrthographic(const YamlSection& section) {
  const std::string text = section.TextOr("projection", "perspective");
  if (text != "perspective" && text != "orthographic")
    section.Fail(fmt::format("projection is '{}'; say \"perspective\" or \"orthographic\"", text));
  return text == "orthographic";
}

// The program draws this picture with one ray a pixel and holds all of it in memory.
void RequireModestPicture(const YamlSection& section, const core::CameraModel& camera) {
  constexpr std::int64_t kMostPixels = 40'000'000;  // 8K has 33 million
  if (std::int64_t{camera.width_px()} * camera.height_px() <= kMostPixels) return;
  section.Fail(
      fmt::format("a picture of {} x {} px is too large to be drawn; choose one of at most {} pixels",
                  camera.width_px(), camera.height_px(), kMostPixels));
}

}  // namespace

core::RigQuality QualityOf(const RigFile& rig_file) {
  core::RigQuality quality{std::nullopt, rig_file.gauge};
  if (rig_file.calibration && rig_file.calibration->covariance.size() > 0)
    quality.errors = core::RigErrors{rig_file.calibration->covariance};
  return quality;
}

core::CameraModel PlaceholderCamera(const std::string& name, int width_px, int height_px) {
  core::CameraCalibration calibration;
  calibration.name = name;
  calibration.image_width_px = width_px;
  calibration.image_height_px = height_px;
  calibration.camera_matrix << width_px, 0.0, 0.5 * width_px, 0.0, width_px, 0.5 * height_px, 0.0, 0.0, 1.0;
  return core::CameraModel(std::move(calibration));
}

RigFile ReadRigFile(const std::filesystem::path& path, RigUse use) {
  const std::string file = fmt::format("rig file '{}'", path.string());
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const YamlNode document = ReadYamlFile(path, file, "rig file");
  const YamlSection root{&document, file};
  root.RefuseMisspelt(kRigKeys);
  RigFile rig_file;
  rig_file.rig.name = root.TextOr("rig_name", path.stem().string());
  rig_file.rig.unseen = ReadUnseen(root);
  const YamlNode& cameras = root.Get("cameras", "a list with one entry a camera");
  if (cameras.kind != YamlKind::kList) root.Fail("key 'cameras' must be a list with one entry a camera");
  if (cameras.items.size() > core::kMostCameras)
    root.Fail(fmt::format("{} cameras are more than can be used; list at most {}", cameras.items.size(),
                          core::kMostCameras));
  for (const YamlNode& camera : cameras.items) AddCamera(camera, file, folder, use, rig_file);
  if (rig_file.is_calibrated || root.Find("workspace_mm") != nullptr)
    rig_file.rig.workspace_mm = ReadWorkspace(root);
  else
    rig_file.rig.workspace_mm = {Eigen::Vector3d::Constant(-1.0), Eigen::Vector3d::Constant(1.0)};
  try {
    rig_file.rig.Validate();
  } catch (const Error& error) {
    throw Error(error.kind(), file + ": " + error.what());
  }
  if (rig_file.is_calibrated) rig_file.calibration = ReadCalibration(root, rig_file.rig);
  rig_file.gauge = ReadGauge(root);
  return rig_file;
}

ViewFile ReadViewFile(const std::filesystem::path& path) {
  const std::string file = fmt::format("view file '{}'", path.string());
  const YamlNode document = ReadYamlFile(path, file, "view file");
  YamlSection section = ViewSection({&document, file});
  section.RefuseMisspelt(kViewKeys);
  const std::string name = section.TextOr("name", "view");
  section.title = fmt::format("camera '{}'", name);
  const bool is_orthographic = ReadIsOrthographic(section);
  const bool has_lens = !is_orthographic || section.Find("distortion_model") != nullptr ||
                        section.Find("distortion_coefficients") != nullptr;
  ViewFile view{ReadCamera(section, name, has_lens), is_orthographic};
  RequireModestPicture(section, view.camera);
  if (view.is_orthographic && !view.camera.is_ideal()) {
    section.Fail(
        "an orthographic view has no lens; leave out distortion_model and "
        "distortion_coefficients");
  }
  return view;
}

}  // namespace elbowroom::recon
