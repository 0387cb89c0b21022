#include "sessions/rig_rows.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"
#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/packing.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

constexpr double kShortestFocalPx = 1e-3, kLongestFocalPx = 1e9;
// No camera of a trial has so many; a mask of so many pixels is 32 MB.
constexpr std::int64_t kMostPixels = std::int64_t{1} << 28U;

int ReadSide(const Statement& row, int column, const std::string& where) {
  const std::int64_t side_px = row.Integer(column);
  if (side_px < 1 || side_px > kMostPixels)
    FailAsDamaged(where, fmt::format("a side of its pictures has {} pixels", side_px));
  return static_cast<int>(side_px);
}

core::CameraModel ReadCamera(const Statement& row, const std::string& path) {
  core::CameraCalibration calibration;
  calibration.name = row.Text(0);
  const std::string where = fmt::format("session '{}', camera '{}'", path, Quotable(calibration.name));
  calibration.image_width_px = ReadSide(row, 1, where);
  calibration.image_height_px = ReadSide(row, 2, where);
  if (std::int64_t{calibration.image_width_px} * calibration.image_height_px > kMostPixels)
    FailAsDamaged(where, fmt::format("its pictures have {} x {} pixels", calibration.image_width_px,
                                     calibration.image_height_px));
  calibration.camera_matrix = MatrixFromJson(row.Text(3), where);
  const std::string model = row.Text(4);
  const auto distortion_model = core::ParseDistortionModel(model);
  if (!distortion_model)
    FailAsDamaged(where, fmt::format("no distortion model is called '{}'", Quotable(model)));
  calibration.distortion_model = *distortion_model;
  calibration.distortion_coefficients = NumbersFromJson(row.Text(5), where);
  calibration.cam_from_world.rotation = MatrixFromJson(row.Text(6), where);
  calibration.cam_from_world.translation_mm =
      Position(VectorFromJson(row.Text(7), where), where, "its position");
  const Eigen::Matrix3d& k = calibration.camera_matrix;
  if (!(k.cwiseAbs().maxCoeff() <= kLongestFocalPx && k(0, 0) >= kShortestFocalPx &&
        k(1, 1) >= kShortestFocalPx)) {
    FailAsDamaged(where, "its camera_matrix is no lens's");
  }
  const std::string name = std::exchange(calibration.name, "of the rig");
  try {
    (void)core::CameraModel(calibration);
  } catch (const core::Error& error) {
    FailAsDamaged(where, Quotable(error.what()));
  }
  calibration.name = name;
  return core::CameraModel(std::move(calibration));
}

}  // namespace

void InsertCameras(Database& database, const std::vector<core::CameraModel>& cameras) {
  Statement insert(database, "INSERT INTO camera VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (core::CameraIndex i = 0; i < cameras.size(); ++i) {
    const core::CameraCalibration& c = cameras[i].calibration();
    insert
        .With(i, c.name, c.image_width_px, c.image_height_px, JsonFrom(c.camera_matrix),
              core::ToString(c.distortion_model), JsonFrom(c.distortion_coefficients),
              JsonFrom(c.cam_from_world.rotation), JsonFrom(c.cam_from_world.translation_mm))
        .Run();
  }
}

std::vector<core::CameraModel> ReadCameras(Database& database) {
  Statement rows(
      database,
      "SELECT name, image_width_px, image_height_px, camera_matrix, distortion_model, "
      "distortion_coefficients, rotation_cam_from_world, translation_cam_from_world_mm, camera_index "
      "FROM camera ORDER BY camera_index");
  std::vector<core::CameraModel> cameras;
  while (rows.Next()) {
    RequireInTurn(rows.Integer(8), cameras.size(), fmt::format("session '{}'", database.path().string()),
                  "camera");
    cameras.push_back(ReadCamera(rows, database.path().string()));
  }
  return cameras;
}

}  // namespace elbowroom::sessions
