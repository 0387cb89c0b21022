// The files of OpenCV, ROS, Kalibr, and 3 x 4 matrices.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/error.h"
#include "core/file_limits.h"
#include "recon/rig_files/foreign_rig.h"
#include "recon/rig_files/yaml_section.h"

namespace elbowroom::recon {
namespace {

using core::DistortionModel;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
using RowMajor4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

// The first of several spellings that the file has; null: none.
const char* SpellingIn(const YamlSection& section, std::initializer_list<const char*> spellings) {
  const auto found =
      std::ranges::find_if(spellings, [&](const char* key) { return section.Find(key) != nullptr; });
  return found == spellings.end() ? nullptr : *found;
}

std::vector<double> FiniteIn(const YamlSection& section, const char* key, std::size_t count,
                             const char* shape) {
  std::vector<double> numbers = section.Numbers(key, 0, count, shape);
  for (const double number : numbers)
    if (!(std::abs(number) <= core::kLongestLengthMm))
      section.Fail(fmt::format("{} holds {}; correct it", key, number));
  return numbers;
}

Eigen::Matrix3d MatrixIn(const YamlSection& section, const char* key) {
  const std::vector<double> numbers = FiniteIn(section, key, 9, "a 3 x 3 matrix");
  return Eigen::Map<const RowMajor3>(numbers.data());
}

// A matrix, or a rotation vector (Rodrigues).
Eigen::Matrix3d RotationIn(const YamlSection& section, const char* key) {
  const std::vector<double> numbers = FiniteIn(section, key, 0, "a 3 x 3 matrix or a rotation vector");
  if (numbers.size() == 9) return Eigen::Map<const RowMajor3>(numbers.data());
  if (numbers.size() != 3) section.Fail(fmt::format("{} must hold 9 or 3 numbers", key));
  return RotationFromRodrigues({numbers[0], numbers[1], numbers[2]});
}

Eigen::Vector3d VectorIn(const YamlSection& section, const char* key) {
  const std::vector<double> numbers = FiniteIn(section, key, 3, "3 numbers");
  return {numbers[0], numbers[1], numbers[2]};
}

// A name may look like a number.
std::string NameIn(const YamlSection& section, const char* key, const std::string& otherwise) {
  const YamlNode* found = section.Find(key);
  return found == nullptr || found->text.empty() ? otherwise : found->text;
}

void PutSize(const YamlSection& section, core::CameraCalibration* lens) {
  const char* width = SpellingIn(section, {"image_width", "image_Width", "width", "img_width"});
  const char* height = SpellingIn(section, {"image_height", "image_Height", "height", "img_height"});
  if ((width == nullptr) != (height == nullptr)) section.Fail("gives only one of image_width, image_height");
  if (width == nullptr) return;
  lens->image_width_px = section.Integer(width, "a whole number of pixels");
  lens->image_height_px = section.Integer(height, "a whole number of pixels");
}

// OpenCV's own files name no model: theirs is plumb_bob, or rational_polynomial from six coefficients on.
void PutDistortion(const YamlSection& section, const char* key, core::CameraCalibration* lens) {
  if (key != nullptr) lens->distortion_coefficients = FiniteIn(section, key, 0, "a 1 x N matrix");
  const YamlNode* is_fisheye = section.Find("fisheye_model");
  std::string model = section.TextOr(
      "distortion_model", lens->distortion_coefficients.size() > 5 ? "rational_polynomial" : "plumb_bob");
  if (is_fisheye != nullptr && is_fisheye->IsNumber() && is_fisheye->number != 0.0) model = "fisheye";
  const auto parsed = core::ParseDistortionModel(model == "equidistant" ? "fisheye" : model);
  if (!parsed)
    section.Fail(
        fmt::format("distortion_model '{}' is unknown here; it must be plumb_bob, "
                    "rational_polynomial, equidistant or fisheye",
                    model));
  lens->distortion_model = *parsed;
  DropTilt(lens);
}

// --- OpenCV

// Cameras in files of one camera, or in a list.
constexpr std::initializer_list<const char*> kMatrixKeys = {"camera_matrix", "Camera_Matrix", "cameraMatrix",
                                                            "K"};

std::optional<StatedPose> PoseIn(const YamlSection& section) {
  const char* rotation = SpellingIn(section, {"rotation_cam_from_world", "R", "rvec", "rotation"});
  const char* translation =
      SpellingIn(section, {"translation_cam_from_world_mm", "T", "tvec", "t", "translation"});
  if (rotation == nullptr || translation == nullptr) return std::nullopt;
  return StatedPose{RotationIn(section, rotation), VectorIn(section, translation)};
}

ForeignCamera OpenCvCamera(const YamlSection& section, const std::string& name) {
  ForeignCamera camera;
  camera.name = NameIn(section, "name", NameIn(section, "camera_name", name));
  PutSize(section, &camera.lens);
  const char* matrix = SpellingIn(section, kMatrixKeys);
  if (matrix == nullptr)
    section.Fail("key 'camera_matrix' is missing; give a file with a camera's calibration");
  camera.lens.camera_matrix = MatrixIn(section, matrix);
  PutDistortion(section,
                SpellingIn(section, {"distortion_coefficients", "Distortion_Coefficients", "distCoeffs",
                                     "dist_coeffs", "distortion", "D"}),
                &camera.lens);
  camera.stated = PoseIn(section);
  return camera;
}

// What the stereo sample and its relatives write: M1, D1, M2, D2.
std::vector<ForeignCamera> StereoCameras(const YamlSection& root) {
  std::vector<ForeignCamera> cameras;
  for (int i = 1; i <= 2; ++i) {
    const std::string m = fmt::format("M{}", i), k = fmt::format("K{}", i),
                      c = fmt::format("cameraMatrix{}", i), d = fmt::format("D{}", i),
                      dist = fmt::format("distCoeffs{}", i);
    const char* matrix = SpellingIn(root, {m.c_str(), k.c_str(), c.c_str()});
    if (matrix == nullptr) return {};
    ForeignCamera camera;
    camera.name = fmt::format("cam{}", i);
    PutSize(root, &camera.lens);
    camera.lens.camera_matrix = MatrixIn(root, matrix);
    PutDistortion(root, SpellingIn(root, {d.c_str(), dist.c_str()}), &camera.lens);
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

ForeignRig ParseOpenCv(const YamlSection& root, const std::string& name) {
  ForeignRig rig;
  const YamlNode *list = root.Find("cameras"), *one = root.Find("camera");
  if (list != nullptr && list->kind == YamlKind::kList) {
    for (const YamlNode& item : list->items) {
      if (item.kind != YamlKind::kMap) root.Fail("'cameras' must list maps, one a camera");
      rig.cameras.push_back(OpenCvCamera({&item, root.file}, fmt::format("cam{}", rig.cameras.size() + 1)));
    }
  } else if (one != nullptr && one->kind == YamlKind::kMap) {
    rig.cameras.push_back(OpenCvCamera({one, root.file}, name));
  } else if (SpellingIn(root, kMatrixKeys) != nullptr) {
    rig.cameras.push_back(OpenCvCamera(root, name));
  } else {
    rig.cameras = StereoCameras(root);
    rig.second_from_first = PoseIn(root);
    if (rig.cameras.empty() && !rig.second_from_first)
      root.Fail("holds no camera: neither camera_matrix, nor M1 and M2, nor R and T of a stereo pair");
  }
  return rig;
}

// --- ROS

// A file's projection matrix maps a point in the rectified frame, which the cameras of a stereo pair share:
// x_rectified_cam = X + P3^-1 p4 and x_cam = R_rect^T x_rectified_cam (REP 104).
ForeignRig ParseRos(const YamlSection& root, const std::string& name) {
  ForeignCamera camera;
  camera.name = NameIn(root, "camera_name", name);
  PutSize(root, &camera.lens);
  camera.lens.camera_matrix = MatrixIn(root, "camera_matrix");
  PutDistortion(root, "distortion_coefficients", &camera.lens);
  if (root.Find("projection_matrix") != nullptr) {
    const std::vector<double> numbers = FiniteIn(root, "projection_matrix", 12, "a 3 x 4 matrix");
    const Eigen::Matrix<double, 3, 4> p = Eigen::Map<const RowMajor34>(numbers.data());
    const Eigen::Matrix3d rectification = root.Find("rectification_matrix") == nullptr
                                              ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                              : MatrixIn(root, "rectification_matrix");
    const Eigen::FullPivLU<Eigen::Matrix3d> left(p.leftCols<3>());
    if (left.isInvertible())
      camera.stated = StatedPose{rectification.transpose(), rectification.transpose() * left.solve(p.col(3))};
  }
  ForeignRig rig;
  rig.cameras.push_back(std::move(camera));
  return rig;
}

// --- Kalibr

DistortionModel KalibrModel(const YamlSection& section) {
  const std::string camera_model = section.TextOr("camera_model", "pinhole");
  if (camera_model != "pinhole")
    section.Fail(fmt::format("camera_model '{}' has no equal here; calibrate it as pinhole", camera_model));
  const std::string model = section.TextOr("distortion_model", "none");
  if (model == "radtan" || model == "none") return DistortionModel::kPlumbBob;
  if (model == "equidistant" || model == "equi") return DistortionModel::kFisheye;
  section.Fail(
      fmt::format("distortion_model '{}' has no equal here; it must be radtan, equidistant or none", model));
}

ForeignCamera KalibrCamera(const YamlSection& section, const std::string& name) {
  ForeignCamera camera;
  camera.name = name;
  const std::string topic = section.TextOr("rostopic", "");
  const std::size_t begin = topic.find_first_not_of('/');
  if (begin != std::string::npos) camera.alias = topic.substr(begin, topic.find('/', begin) - begin);
  camera.lens.distortion_model = KalibrModel(section);
  const std::vector<double> f = FiniteIn(section, "intrinsics", 4, "[fu, fv, pu, pv] in pixels");
  camera.lens.camera_matrix << f[0], 0.0, f[2], 0.0, f[1], f[3], 0.0, 0.0, 1.0;
  if (section.Find("distortion_coeffs") != nullptr)
    camera.lens.distortion_coefficients = FiniteIn(section, "distortion_coeffs", 0, "a list of numbers");
  const std::vector<double> size = FiniteIn(section, "resolution", 2, "[width, height] in pixels");
  for (const double pixels : size)
    if (!(pixels >= 1.0 && pixels <= 1e6)) section.Fail("resolution must be [width, height] in pixels");
  camera.lens.image_width_px = static_cast<int>(size[0]);
  camera.lens.image_height_px = static_cast<int>(size[1]);
  if (section.Find("T_cn_cnm1") == nullptr) return camera;
  const std::vector<double> numbers = FiniteIn(section, "T_cn_cnm1", 16, "a 4 x 4 matrix");
  const Eigen::Matrix4d matrix = Eigen::Map<const RowMajor4>(numbers.data());
  camera.stated = StatedPose{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
  return camera;
}

// "cam10" is 10; the file's order is that of the alphabet.
int NumberAtEnd(const std::string& name) {
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  int number = 0;
  std::from_chars(name.data() + digits, name.data() + name.size(), number);
  return number;
}

ForeignRig ParseKalibr(const YamlSection& root) {
  ForeignRig rig;
  for (std::size_t i = 0; i < root.node->keys.size(); ++i) {
    const YamlNode& item = root.node->items[i];
    const std::string& key = root.node->keys[i];
    if (item.kind == YamlKind::kMap && item.Find("intrinsics") != nullptr)
      rig.cameras.push_back(KalibrCamera({&item, root.file, fmt::format("camera '{}'", key)}, key));
  }
  if (rig.cameras.empty()) root.Fail("holds no camera: no 'cam0' with 'intrinsics'");
  std::ranges::stable_sort(rig.cameras, {}, [](const ForeignCamera& c) { return NumberAtEnd(c.name); });
  rig.is_chain = rig.cameras.size() > 1;
  for (std::size_t i = 1; i < rig.cameras.size(); ++i)
    if (!rig.cameras[i].stated) rig.is_chain = false;
  if (rig.is_chain) rig.cameras[0].stated = StatedPose{};
  return rig;
}

// --- 3 x 4 matrices

std::optional<double> NumberIn(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_whole = error == std::errc() && end == word.data() + word.size();
  return is_whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::vector<std::string_view> WordsOf(std::string_view line) {
  constexpr std::string_view kBetween = " \t\r,;[]";
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBetween); at != std::string_view::npos;
       at = line.find_first_not_of(kBetween, at)) {
    const std::size_t end = std::min(line.find_first_of(kBetween, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

ForeignCamera CameraOf(std::span<const double> numbers, const std::string& name, const std::string& who) {
  ForeignCamera camera;
  camera.name = name;
  const Eigen::Matrix<double, 3, 4> projection = Eigen::Map<const RowMajor34>(numbers.data());
  const auto split = SplitOf(projection);
  if (!split) {
    throw core::Error(core::ErrorKind::kFormat,
                      fmt::format("{}: the 3 x 4 matrix of camera '{}' is no projection (its left 3 x 3 part "
                                  "is singular); correct it",
                                  who, name));
  }
  camera.projection = projection;
  camera.lens.camera_matrix = split->camera_matrix;
  camera.stated = split->cam_from_world;
  return camera;
}

// A line is numbers, or a name and perhaps numbers after it. PMVS begins each matrix with "CONTOUR".
ForeignRig ParseProjections(std::string_view text, const std::string& who, const std::string& name) {
  std::vector<double> numbers;
  std::vector<std::string> names;
  int line_number = 0;
  const auto fail = [&](const std::string& what) {
    throw core::Error(core::ErrorKind::kFormat, fmt::format("{}, line {}: {}", who, line_number, what));
  };
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::vector<std::string_view> words = WordsOf(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::optional<double> number = NumberIn(words[i]);
      if (!number && (i > 0 || numbers.size() % 12 != 0))
        fail(fmt::format("'{}' must be a number; a camera has 12 of them", words[i]));
      if (number) {
        numbers.push_back(*number);
      } else if (words[i] != "CONTOUR") {
        names.resize(numbers.size() / 12);
        names.emplace_back(words[i]);
      }
      if (numbers.size() > 12 * core::kMostCameras) fail("more numbers than cameras can have");
    }
  }
  if (numbers.empty() || numbers.size() % 12 != 0)
    fail(fmt::format("{} numbers are no 3 x 4 matrices; give 12 a camera, row by row", numbers.size()));
  names.resize(numbers.size() / 12);
  ForeignRig rig;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string otherwise = names.size() == 1 ? name : fmt::format("cam{}", i + 1);
    rig.cameras.push_back(
        CameraOf(std::span(numbers).subspan(12 * i, 12), names[i].empty() ? otherwise : names[i], who));
  }
  return rig;
}

}  // namespace

Eigen::Matrix3d RotationFromRodrigues(const Eigen::Vector3d& vector) {
  const double angle_rad = vector.norm();
  if (!(angle_rad > 0.0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_rad, vector / angle_rad).toRotationMatrix();
}

void DropTilt(core::CameraCalibration* lens) {
  std::vector<double>& c = lens->distortion_coefficients;
  if (c.size() == 14 && c[12] == 0.0 && c[13] == 0.0) c.resize(12);
}

std::optional<ForeignFormat> FormatOf(std::string_view text, const std::string& who) {
  if (text.find_first_of(":<{") == std::string_view::npos) return ForeignFormat::kProjection;
  const YamlNode root = ParseStorage(text, who);
  const bool is_kalibr = std::ranges::any_of(root.items, [](const YamlNode& item) {
    return item.kind == YamlKind::kMap && item.Find("intrinsics") != nullptr;
  });
  if (is_kalibr) return ForeignFormat::kKalibr;
  if (root.Find("projection_matrix") != nullptr || root.Find("rectification_matrix") != nullptr)
    return ForeignFormat::kRos;
  return ForeignFormat::kOpenCv;
}

ForeignRig ParseForeignRig(std::string_view text, ForeignFormat format, const std::string& who,
                           const std::string& name) {
  ForeignRig rig;
  if (format == ForeignFormat::kProjection) {
    rig = ParseProjections(text, who, name);
  } else {
    const YamlNode document = ParseStorage(text, who);
    const YamlSection root{&document, who};
    core::Require(format != ForeignFormat::kAnipose && format != ForeignFormat::kCaliscope,
                  "TOML is read elsewhere");
    if (format == ForeignFormat::kKalibr) {
      rig = ParseKalibr(root);
    } else {
      rig = format == ForeignFormat::kRos ? ParseRos(root, name) : ParseOpenCv(root, name);
    }
  }
  rig.format = format;
  return rig;
}

}  // namespace elbowroom::recon
