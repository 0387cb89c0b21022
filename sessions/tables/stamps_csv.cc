#include "sessions/tables/stamps_csv.h"

#include <fmt/format.h>

#include "sessions/tables/csv_text.h"

namespace elbowroom::sessions {

std::string StampsCsv(const core::Rig& rig, std::span<const StampRow> frames) {
  std::string csv = "frame,time_s,camera,picture,taken_at_s,skew_ms\n";
  for (const StampRow& frame : frames) {
    for (core::CameraIndex i = 0; i < frame.stamps.size(); ++i) {
      csv += fmt::format("{},{},{},", frame.frame, frame.time_s, Quoted(rig.cameras[i].name()));
      if (const std::optional<core::CameraStamp>& stamp = frame.stamps[i]) {
        csv += fmt::format("{},{},{}", stamp->picture, stamp->time_s, 1e3 * (stamp->time_s - frame.time_s));
      } else {
        csv += ",,";
      }
      csv += '\n';
    }
  }
  return csv;
}

}  // namespace elbowroom::sessions
