#include "sessions/rig_rows.h"

#include <fmt/format.h>

#include "core/error.h"
#include "sessions/packing.h"
#include "sessions/statement.h"

namespace elbowroom::sessions {
namespace {

core::CameraModel ReadCamera(const Statement& row, const std::string& path) {
  core::CameraCalibration calibration;
  calibration.name = row.Text(0);
  const std::string where = fmt::format("session '{}', camera '{}'", path, calibration.name);
  calibration.image_width_px = static_cast<int>(row.Integer(1));
  calibration.image_height_px = static_cast<int>(row.Integer(2));
  calibration.camera_matrix = MatrixFromJson(row.Text(3), where);
  const std::string model = row.Text(4);
  const auto distortion_model = core::ParseDistortionModel(model);
  if (!distortion_model) {
    throw core::Error(core::ErrorKind::kFormat,
                      fmt::format("{}: no distortion model is called '{}'; restore the file "
                                  "from a copy",
                                  where, model));
  }
  calibration.distortion_model = *distortion_model;
  calibration.distortion_coefficients = NumbersFromJson(row.Text(5), where);
  calibration.cam_from_world.rotation = MatrixFromJson(row.Text(6), where);
  calibration.cam_from_world.translation_mm = VectorFromJson(row.Text(7), where);
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
  Statement rows(database,
                 "SELECT name, image_width_px, image_height_px, camera_matrix, distortion_model, "
                 "distortion_coefficients, rotation_cam_from_world, translation_cam_from_world_mm "
                 "FROM camera ORDER BY camera_index");
  std::vector<core::CameraModel> cameras;
  while (rows.Next()) cameras.push_back(ReadCamera(rows, database.path().string()));
  return cameras;
}

}  // namespace elbowroom::sessions
