#include "recon/rig_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/spelling.h"
#include "recon/quiet_opencv.h"
#include "recon/source_location.h"
#include "recon/sweep_rays.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;

constexpr const char* kDistortionModels = "\"plumb_bob\", \"rational_polynomial\" or \"fisheye\"";

// A map in the file, and what to call it in a message: "rig.yml" or "rig.yml: camera 'cam1'".
struct Section {
  cv::FileNode node;
  std::string who;

  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(ErrorKind::kFormat, who + ": " + what);
  }

  [[nodiscard]] cv::FileNode Find(const char* key) const { return node[key]; }
  cv::FileNode Get(const char* key, const char* shape) const {
    const cv::FileNode found = Find(key);
    if (found.empty()) Fail(fmt::format("key '{}' is missing; add it: {}", key, shape));
    return found;
  }

  // An unknown key is nobody's business unless it looks like a slip: `unsen` would change the hull unseen.
  void RefuseMisspelt(std::span<const std::string_view> known) const {
    for (const std::string& key : node.keys()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      if (const auto meant = core::NearestWord(key, known)) {
        Fail(fmt::format("unknown key '{}'; did you mean '{}'?", key, *meant));
      }
    }
  }
};

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

// Appends every number of a list or of lists in it; false if something else is among them.
bool AppendNumbers(const cv::FileNode& node, std::vector<double>& numbers) {
  if (node.isInt() || node.isReal()) {
    numbers.push_back(static_cast<double>(node));
    return true;
  }
  if (!node.isSeq()) return false;
  for (const cv::FileNode& element : node) {
    if (!AppendNumbers(element, numbers)) return false;
  }
  return true;
}

// `count` numbers, or any count for 0; an !!opencv-matrix must have `rows` rows where rows > 0.
std::vector<double> Numbers(const Section& section, const char* key, int rows, std::size_t count,
                            const char* shape) {
  const cv::FileNode node = section.Get(key, shape);
  std::vector<double> numbers;
  const bool is_matrix = node.isMap();
  if (!AppendNumbers(is_matrix ? node["data"] : node, numbers)) {
    section.Fail(fmt::format("key '{}' must hold numbers: {}", key, shape));
  }
  const auto declared = [&](const char* size) {
    return node[size].isInt() ? static_cast<int>(node[size]) : -1;
  };
  const bool is_shaped = !is_matrix || (rows == 0 || declared("rows") == rows || declared("cols") == rows);
  const bool is_filled = !is_matrix || static_cast<std::size_t>(std::max(0, declared("rows"))) *
                                               static_cast<std::size_t>(std::max(0, declared("cols"))) ==
                                           numbers.size();
  if (!is_shaped || !is_filled || (count != 0 && numbers.size() != count)) {
    const std::string size =
        is_matrix ? fmt::format("{} x {}", declared("rows"), declared("cols")) : std::string("a list");
    section.Fail(fmt::format("key '{}' has the wrong size ({}, {} numbers); it must be {}", key, size,
                             numbers.size(), shape));
  }
  return numbers;
}

Eigen::Matrix3d Matrix3(const Section& section, const char* key) {
  const std::vector<double> n = Numbers(section, key, 3, 9, "a 3 x 3 matrix, row by row");
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(n.data());
}

std::string Text(const Section& section, const char* key, const std::string& otherwise) {
  const cv::FileNode node = section.Find(key);
  if (node.empty()) return otherwise;
  if (!node.isString()) section.Fail(fmt::format("key '{}' must be text in quotes", key));
  return static_cast<std::string>(node);
}

int Pixels(const Section& section, const char* key) {
  const cv::FileNode node = section.Get(key, "a whole number of pixels");
  if (!node.isInt()) section.Fail(fmt::format("key '{}' must be a whole number of pixels", key));
  return static_cast<int>(node);
}

void ReadLens(const Section& section, core::CameraCalibration* calibration) {
  section.Get("distortion_model", kDistortionModels);
  const std::string model = Text(section, "distortion_model", "");
  const auto parsed = core::ParseDistortionModel(model);
  if (!parsed) {
    section.Fail(fmt::format("distortion_model '{}' is unknown; it must be {}", model, kDistortionModels));
  }
  calibration->distortion_model = *parsed;
  calibration->distortion_coefficients = Numbers(section, "distortion_coefficients", 1, 0, "a 1 x N matrix");
}

// A camera without a lens needs no keys that describe one.
core::CameraModel ReadCamera(const Section& section, const std::string& name, const std::string& file,
                             bool has_lens) {
  core::CameraCalibration calibration;
  calibration.name = name;
  calibration.image_width_px = Pixels(section, "image_width");
  calibration.image_height_px = Pixels(section, "image_height");
  calibration.camera_matrix = Matrix3(section, "camera_matrix");
  if (has_lens) ReadLens(section, &calibration);
  calibration.cam_from_world.rotation = Matrix3(section, "rotation_cam_from_world");
  const std::vector<double> t =
      Numbers(section, "translation_cam_from_world_mm", 3, 3, "a 3 x 1 matrix in millimetres");
  calibration.cam_from_world.translation_mm = {t[0], t[1], t[2]};
  try {
    return core::CameraModel(std::move(calibration));
  } catch (const Error& error) {
    throw Error(error.kind(), file + ": " + error.what());
  }
}

Eigen::AlignedBox3d ReadWorkspace(const Section& section) {
  constexpr const char* kShape = "[x0,y0,z0,x1,y1,z1] in millimetres";
  const std::vector<double> n = Numbers(section, "workspace_mm", 0, 6, kShape);
  return {Eigen::Vector3d(n[0], n[1], n[2]), Eigen::Vector3d(n[3], n[4], n[5])};
}

core::UnseenPolicy ReadUnseen(const Section& section) {
  const std::string text = Text(section, "unseen", "outside");
  if (text == "outside") return core::UnseenPolicy::kOutside;
  if (text == "abstain") return core::UnseenPolicy::kAbstain;
  section.Fail(fmt::format("unseen is '{}'; say \"outside\" or \"abstain\"", text));
}

cv::FileStorage OpenStorage(const std::filesystem::path& path, const std::string& file) {
  SilenceOpenCv();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw Error(ErrorKind::kFile, file + ": does not exist; check the path");
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(ErrorKind::kFile, file + ": is not a file; name the rig's YAML file");
  if (!std::ifstream(path)) throw Error(ErrorKind::kFile, file + ": can't be read; check its permissions");
  try {
    cv::FileStorage storage(path.string(), cv::FileStorage::READ);
    if (storage.isOpened() && storage.root().isMap()) return storage;
  } catch (const cv::Exception&) {
    // Falls through to the same message: OpenCV's own names its source line, not the file's.
  }
  throw Error(ErrorKind::kFormat, file +
                                      ": is not an OpenCV YAML file; it must begin with '%YAML:1.0' and hold "
                                      "key: value lines, indented by spaces");
}

// cv::Exception never leaves; an element read as what it is not is a defect of the file.
template <typename Read>
auto Guarded(const std::string& file, Read read) {
  try {
    return read();
  } catch (const cv::Exception&) {
    throw Error(ErrorKind::kFormat, file + ": can't be understood; check its YAML");
  }
}

void AddCamera(const cv::FileNode& node, const std::string& file, const std::filesystem::path& folder,
               RigFile& rig_file) {
  Section section{node, fmt::format("{}: camera number {}", file, rig_file.sources.size() + 1)};
  if (!node.isMap()) section.Fail("must be a map of keys such as name and camera_matrix");
  const std::string name = Text(section, "name", "");
  if (name.empty())
    section.Fail("key 'name' is missing or empty; give the camera a name that no other bears");
  section.who = fmt::format("{}: camera '{}'", file, name);
  if (name.find('/') != std::string::npos || name == "." || name == "..")
    section.Fail("this name can't be part of a file's name; choose one without '/'");
  section.RefuseMisspelt(kCameraKeys);
  for (const core::CameraModel& other : rig_file.rig.cameras) {
    if (other.name() == name) section.Fail("this name occurs twice; give every camera its own");
  }
  rig_file.rig.cameras.push_back(ReadCamera(section, name, file, true));
  rig_file.sources.push_back({ResolvedLocation(Text(section, "frames", ""), folder),
                              ResolvedLocation(Text(section, "background", ""), folder),
                              ResolvedLocation(Text(section, "masks", ""), folder)});
}

// Where a view file has its camera's keys.
Section ViewSection(const Section& root) {
  const cv::FileNode camera = root.Find("camera"), cameras = root.Find("cameras");
  root.RefuseMisspelt(kViewKeys);
  if (camera.empty() && cameras.empty()) return root;
  if (!camera.empty() && !cameras.empty()) root.Fail("has both 'camera' and 'cameras'; keep one");
  if (camera.empty() && (!cameras.isSeq() || cameras.size() != 1))
    root.Fail("'cameras' must list exactly one camera");
  const Section section{camera.empty() ? *cameras.begin() : camera, root.who};
  if (!section.node.isMap()) section.Fail("the camera must be a map of keys such as camera_matrix");
  if (!root.Find("projection").empty()) root.Fail("'projection' must stand among the camera's keys");
  return section;
}

bool ReadIsOrthographic(const Section& section) {
  const std::string text = Text(section, "projection", "perspective");
  if (text != "perspective" && text != "orthographic")
    section.Fail(fmt::format("projection is '{}'; say \"perspective\" or \"orthographic\"", text));
  return text == "orthographic";
}

}  // namespace

RigFile ReadRigFile(const std::filesystem::path& path) {
  const std::string file = fmt::format("rig file '{}'", path.string());
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  return Guarded(file, [&] {
    const cv::FileStorage storage = OpenStorage(path, file);
    const Section root{storage.root(), file};
    root.RefuseMisspelt(kRigKeys);
    RigFile rig_file;
    rig_file.rig.name = Text(root, "rig_name", path.stem().string());
    rig_file.rig.workspace_mm = ReadWorkspace(root);
    rig_file.rig.unseen = ReadUnseen(root);
    const cv::FileNode cameras = root.Get("cameras", "a list with one entry a camera");
    if (!cameras.isSeq()) root.Fail("key 'cameras' must be a list with one entry a camera");
    for (const cv::FileNode& camera : cameras) AddCamera(camera, file, folder, rig_file);
    try {
      rig_file.rig.Validate();
    } catch (const Error& error) {
      throw Error(error.kind(), file + ": " + error.what());
    }
    return rig_file;
  });
}

ViewFile ReadViewFile(const std::filesystem::path& path) {
  const std::string file = fmt::format("view file '{}'", path.string());
  return Guarded(file, [&] {
    const cv::FileStorage storage = OpenStorage(path, file);
    Section section = ViewSection({storage.root(), file});
    section.RefuseMisspelt(kViewKeys);
    const std::string name = Text(section, "name", "view");
    section.who = fmt::format("{}: camera '{}'", file, name);
    const bool is_orthographic = ReadIsOrthographic(section);
    const bool has_lens = !is_orthographic || !section.Find("distortion_model").empty() ||
                          !section.Find("distortion_coefficients").empty();
    const ViewFile view{ReadCamera(section, name, file, has_lens), is_orthographic};
    if (view.is_orthographic && !view.camera.is_ideal()) {
      section.Fail(
          "an orthographic view has no lens; leave out distortion_model and "
          "distortion_coefficients");
    }
    return view;
  });
}

}  // namespace elbowroom::recon
