#include "app/control/calibration/foreign_toml.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <vector>

#include "cad_import/layout/toml_entry.h"
#include "core/error.h"
#include "core/file_limits.h"

namespace elbowroom::control {
namespace {

using recon::ForeignCamera;
using recon::ForeignFormat;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// One camera's table, with what messages need.
struct TomlCamera {
  const toml::table* table = nullptr;
  std::string file;
  std::string title;  // "[cam_0]"

  [[noreturn]] void Fail(std::string_view key, const std::string& what) const {
    const toml::node* node = table->get(key);
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format("{}:{}: {}: key '{}' {}", file,
                    (node != nullptr ? node : static_cast<const toml::node*>(table))->source().begin.line,
                    title, key, what));
  }
  [[nodiscard]] bool Has(std::string_view key) const { return table->contains(key); }
  [[nodiscard]] bool Flag(std::string_view key) const { return (*table)[key].value_or(false); }

  // The numbers of a list, or of lists in it.
  [[nodiscard]] std::vector<double> Numbers(std::string_view key, const char* shape) const {
    std::vector<double> numbers;
    const toml::node* node = table->get(key);
    if (node == nullptr) Fail(key, fmt::format("is missing; it must be {}", shape));
    if (!node->is_array() || !Append(*node->as_array(), &numbers))
      Fail(key, fmt::format("must be {}", shape));
    return numbers;
  }

 private:
  static bool Append(const toml::array& array, std::vector<double>* numbers) {
    for (const toml::node& item : array) {
      if (const toml::array* inner = item.as_array()) {
        if (!Append(*inner, numbers)) return false;
        continue;
      }
      const auto number = item.value<double>();
      if (!number || !(std::abs(*number) <= core::kLongestLengthMm)) return false;
      numbers->push_back(*number);
    }
    return true;
  }
};

void PutTomlSize(const TomlCamera& camera, core::CameraCalibration* lens) {
  constexpr double kMostPixels = 1e6;
  const std::vector<double> size = camera.Numbers("size", "[width, height] in pixels");
  const bool is_size = size.size() == 2 && size[0] >= 1.0 && size[1] >= 1.0 && size[0] <= kMostPixels &&
                       size[1] <= kMostPixels;
  if (!is_size) camera.Fail("size", "must be [width, height] in pixels");
  lens->image_width_px = static_cast<int>(size[0]);
  lens->image_height_px = static_cast<int>(size[1]);
}

void PutTomlLens(const TomlCamera& camera, core::CameraCalibration* lens) {
  const std::vector<double> matrix = camera.Numbers("matrix", "a 3 x 3 matrix, row by row");
  if (matrix.size() != 9) camera.Fail("matrix", "must be a 3 x 3 matrix, row by row");
  lens->camera_matrix = Eigen::Map<const RowMajor3>(matrix.data());
  lens->distortion_coefficients = camera.Numbers("distortions", "a list of numbers");
  recon::DropTilt(lens);
  if (camera.Flag("fisheye")) {
    lens->distortion_model = core::DistortionModel::kFisheye;
  } else if (lens->distortion_coefficients.size() > 5) {
    lens->distortion_model = core::DistortionModel::kRationalPolynomial;
  }
}

std::optional<recon::StatedPose> PoseOf(const TomlCamera& camera) {
  if (!camera.Has("rotation") || !camera.Has("translation")) return std::nullopt;
  const std::vector<double> r = camera.Numbers("rotation", "a rotation vector, or a 3 x 3 matrix");
  const std::vector<double> t = camera.Numbers("translation", "3 numbers");
  if (r.size() != 3 && r.size() != 9) camera.Fail("rotation", "must be a rotation vector, or a 3 x 3 matrix");
  if (t.size() != 3) camera.Fail("translation", "must be 3 numbers");
  const Eigen::Matrix3d rotation = r.size() == 9 ? Eigen::Matrix3d(Eigen::Map<const RowMajor3>(r.data()))
                                                 : recon::RotationFromRodrigues({r[0], r[1], r[2]});
  return recon::StatedPose{rotation, {t[0], t[1], t[2]}};
}

void AddCameraOf(const TomlCamera& table, const std::string& key, recon::ForeignRig* rig) {
  ForeignCamera camera;
  const bool is_number = key.find_first_not_of("0123456789") == std::string::npos;
  const std::string keyed = is_number ? "cam_" + key : key;
  camera.name = (*table.table)["name"].value_or(keyed);
  if (camera.name != keyed) camera.alias = keyed;
  if (table.Flag("ignore")) {
    rig->warnings.push_back(fmt::format("camera '{}' is marked as ignored, and left out", camera.name));
    return;
  }
  PutTomlSize(table, &camera.lens);
  PutTomlLens(table, &camera.lens);
  camera.stated = PoseOf(table);
  if ((*table.table)["rotation_count"].value_or(0) % 4 != 0)
    rig->warnings.push_back(
        fmt::format("camera '{}': Caliscope shows its pictures turned (rotation_count); the calibration is "
                    "of the pictures as "
                    "they were recorded, if the check says so",
                    camera.name));
  rig->cameras.push_back(std::move(camera));
}

// Caliscope keeps its cameras below `cameras`, or in tables with its own keys.
bool IsOfCaliscope(const toml::table& table) {
  return table.contains("cam_id") || table.contains("port") || table.contains("rotation_count");
}

}  // namespace

recon::ForeignRig ParseForeignToml(std::string_view text, const std::string& file) {
  const toml::table root = cad_import::ParseToml(text, file);
  recon::ForeignRig rig;
  rig.format = ForeignFormat::kAnipose;
  const toml::table* cameras = root.get_as<toml::table>("cameras");
  const toml::table& tables = cameras != nullptr ? *cameras : root;
  if (cameras != nullptr) rig.format = ForeignFormat::kCaliscope;
  for (const auto& [key, node] : tables) {
    const toml::table* table = node.as_table();
    if (table == nullptr || !table->contains("matrix")) continue;
    if (IsOfCaliscope(*table)) rig.format = ForeignFormat::kCaliscope;
    AddCameraOf({table, file, fmt::format("[{}{}]", cameras != nullptr ? "cameras." : "", key.str())},
                std::string(key.str()), &rig);
  }
  if (rig.cameras.empty())
    throw core::Error(core::ErrorKind::kFormat,
                      fmt::format("{}: holds no camera: no table such as [cam_0] with a 'matrix'", file));
  if (rig.cameras.size() > core::kMostCameras)
    throw core::Error(core::ErrorKind::kFormat,
                      fmt::format("{}: {} cameras are more than can be used", file, rig.cameras.size()));
  return rig;
}

}  // namespace elbowroom::control
