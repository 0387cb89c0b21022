// Which pictures the frames took and when, read back from rows.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/session.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// A frame whose cameras have stamps.
struct StampRow {
  core::FrameIndex frame = 0;
  double time_s = 0.0;                                   // of the frame
  std::vector<std::optional<core::CameraStamp>> stamps;  // one a camera; nothing: its picture is missing

  // As FrameRecord::LacksCamera.
  [[nodiscard]] bool LacksCamera() const { return core::LacksCamera(stamps); }
};

// Both throw Error{kDatabase}, or Error{kFormat} where a row is damaged.
// As FrameRecord::stamps: one a camera, or none. `where` names file and frame.
[[nodiscard]] std::vector<std::optional<core::CameraStamp>> ReadStamps(Database& database,
                                                                       std::size_t cameras,
                                                                       core::FrameIndex frame,
                                                                       const std::string& where);
// By number.
[[nodiscard]] std::vector<StampRow> ReadStampRows(Database& database, std::size_t cameras);

}  // namespace elbowroom::sessions
