#include "recon/rig_files/rig_file.h"

#include <fmt/format.h>

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

constexpr std::string_view kRigKeys[] = {"rig_name", "workspace_mm", "unseen", "cameras"};
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
                                            "masks"};
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

void ReadLens(const YamlSection& section, core::CameraCalibration* calibration) {
  (void)section.Get("distortion_model", kDistortionModels);
  const std::string model = section.TextOr("distortion_model", "");
  const auto parsed = core::ParseDistortionModel(model);
  if (!parsed) {
    section.Fail(fmt::format("distortion_model '{}' is unknown; it must be {}", model, kDistortionModels));
  }
  calibration->distortion_model = *parsed;
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

void AddCamera(const YamlNode& node, const std::string& file, const std::filesystem::path& folder,
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
  rig_file.rig.cameras.push_back(ReadCamera(section, name, true));
  rig_file.sources.push_back({ResolvedLocation(section.TextOr("frames", ""), folder),
                              ResolvedLocation(section.TextOr("background", ""), folder),
                              ResolvedLocation(section.TextOr("masks", ""), folder)});
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

RigFile ReadRigFile(const std::filesystem::path& path) {
  const std::string file = fmt::format("rig file '{}'", path.string());
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const YamlNode document = ReadYamlFile(path, file, "rig file");
  const YamlSection root{&document, file};
  root.RefuseMisspelt(kRigKeys);
  RigFile rig_file;
  rig_file.rig.name = root.TextOr("rig_name", path.stem().string());
  rig_file.rig.workspace_mm = ReadWorkspace(root);
  rig_file.rig.unseen = ReadUnseen(root);
  const YamlNode& cameras = root.Get("cameras", "a list with one entry a camera");
  if (cameras.kind != YamlKind::kList) root.Fail("key 'cameras' must be a list with one entry a camera");
  if (cameras.items.size() > core::kMostCameras)
    root.Fail(fmt::format("{} cameras are more than can be used; list at most {}", cameras.items.size(),
                          core::kMostCameras));
  for (const YamlNode& camera : cameras.items) AddCamera(camera, file, folder, rig_file);
  try {
    rig_file.rig.Validate();
  } catch (const Error& error) {
    throw Error(error.kind(), file + ": " + error.what());
  }
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
