#include "app/control/sweep/sweep_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/procedure/simulated.h"
#include "core/procedure/tools_in_use.h"

namespace elbowroom::control {

SweepFrames SweepFramesOf(const sessions::SessionReader& session) {
  std::set<core::FrameIndex> incomplete;
  for (const sessions::StampRow& row : session.stamp_rows())
    if (row.LacksCamera()) incomplete.insert(row.frame);
  std::vector<core::SessionEvent> events = session.events();
  SweepFrames result;
  result.is_simulated = core::IsSimulated(events);
  core::ToolsOfFrames tools(std::move(events));
  const std::vector<sessions::FrameSummary> all = session.frames();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (incomplete.contains(all[i].frame)) {
      ++result.without_camera;
    } else {
      result.frames.push_back({i, tools.At(all[i].frame), all[i].spacing_mm});
    }
  }
  if (!result.frames.empty()) return result;
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("session '{}' has no frames with all cameras; record a trial first",
                                session.path().string()));
}

SweepFrameLoader::SweepFrameLoader(const sessions::SessionReader& session, const SweepFrames& frames,
                                   RecordedMotion::HullKeeper keeper)
    : frames_(frames),
      motion_(
          session.header().rig, session.frames(),
          // Skew counts where a clearance is required.
          session.header().trial.required_clearance_mm > 0.0 ? session.stamp_rows()
                                                             : std::vector<sessions::StampRow>(),
          [&session](core::FrameIndex frame) { return session.ReadFrame(frame); }, std::move(keeper)) {}

review::StudyFrame SweepFrameLoader::Load(std::size_t i) {
  MotionFrame frame = motion_.Load(frames_.frames[i].position);
  return {frame.record.frame, std::move(frame.hull), std::move(frame.record.spacing_mm),
          std::move(frame.skew_errors)};
}

}  // namespace elbowroom::control
