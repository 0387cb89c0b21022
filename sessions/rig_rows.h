// The rig's cameras as rows.
#pragma once

#include <vector>

#include "core/camera_model.h"
#include "core/ids.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

void InsertCameras(Database& database, const std::vector<core::CameraModel>& cameras);

// Throws: Error{kFormat} naming file and camera where a row is damaged or is no camera.
[[nodiscard]] std::vector<core::CameraModel> ReadCameras(Database& database);

}  // namespace elbowroom::sessions
