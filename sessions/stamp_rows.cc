#include "sessions/stamp_rows.h"

#include <fmt/format.h>

#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

// From the columns camera_index, picture, taken_at_s.
void AddStamp(const Statement& row, int first_column, const std::string& where,
              std::vector<std::optional<core::CameraStamp>>* stamps) {
  RequireInTurn(row.Integer(first_column), stamps->size(), where, "the stamp of camera");
  if (row.IsNull(first_column + 1)) {
    stamps->emplace_back();
    return;
  }
  core::CameraStamp stamp;
  stamp.picture = static_cast<std::uint64_t>(
      CountFrom(0, row.Integer(first_column + 1), where, "the number of a picture"));
  stamp.time_s = Time_s(row.Real(first_column + 2), where, "a picture's time");
  stamps->emplace_back(stamp);
}

void RequireAllOrNone(std::size_t stamps, std::size_t cameras, const std::string& where) {
  if (stamps != 0 && stamps != cameras) FailAsDamaged(where, "rows of stamps are missing");
}

}  // namespace

std::vector<std::optional<core::CameraStamp>> ReadStamps(Database& database, std::size_t cameras,
                                                         core::FrameIndex frame, const std::string& where) {
  Statement rows(database,
                 "SELECT camera_index, picture, taken_at_s FROM camera_stamp WHERE frame_index = ? "
                 "ORDER BY camera_index");
  std::vector<std::optional<core::CameraStamp>> stamps;
  for (rows.With(frame); rows.Next();) AddStamp(rows, 0, where, &stamps);
  RequireAllOrNone(stamps.size(), cameras, where);
  return stamps;
}

std::vector<StampRow> ReadStampRows(Database& database, std::size_t cameras) {
  Statement rows(database,
                 "SELECT frame_index, time_s, camera_index, picture, taken_at_s FROM camera_stamp "
                 "JOIN frame USING (frame_index) ORDER BY frame_index, camera_index");
  const auto where = [&](core::FrameIndex frame) {
    return fmt::format("session '{}', frame {}", database.path().string(), frame);
  };
  std::vector<StampRow> frames;
  const auto require_whole = [&] {
    if (!frames.empty()) RequireAllOrNone(frames.back().stamps.size(), cameras, where(frames.back().frame));
  };
  while (rows.Next()) {
    const core::FrameIndex frame = rows.Integer(0);
    if (frames.empty() || frames.back().frame != frame) {
      require_whole();
      frames.push_back({frame, Time_s(rows.Real(1), where(frame), "its time"), {}});
    }
    AddStamp(rows, 2, where(frame), &frames.back().stamps);
  }
  require_whole();
  return frames;
}

}  // namespace elbowroom::sessions
