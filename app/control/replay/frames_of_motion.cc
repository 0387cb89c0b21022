#include "app/control/replay/frames_of_motion.h"

#include <algorithm>
#include <set>
#include <vector>

namespace elbowroom::control {
namespace {

// A contour's motion, and the one before, come from the two pictures before.
constexpr std::size_t kPicturesBefore = 2;

}  // namespace

std::size_t FramesOfMotion(std::span<const sessions::StampRow> rows,
                           std::span<const sessions::FrameSummary> frames, std::size_t first) {
  if (rows.empty()) return 0;
  std::vector<std::set<double>> times(rows.front().stamps.size());
  const auto is_known = [&] {
    return std::ranges::all_of(times,
                               [](const auto& of_camera) { return of_camera.size() >= kPicturesBefore; });
  };
  auto row = std::ranges::lower_bound(rows, frames[first].frame, {}, &sessions::StampRow::frame);
  std::size_t back = 0;
  while (back < first && !is_known()) {
    ++back;
    if (row == rows.begin() || std::prev(row)->frame != frames[first - back].frame) continue;
    --row;
    for (core::CameraIndex i = 0; i < times.size(); ++i)
      if (row->stamps[i]) times[i].insert(row->stamps[i]->time_s);
  }
  return back;
}

}  // namespace elbowroom::control
