#include "app/control/sweep/sweep_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/control/replay/frames_of_motion.h"
#include "core/error.h"
#include "core/tools_in_use.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {

SweepFrames SweepFramesOf(const sessions::SessionReader& session) {
  std::set<core::FrameIndex> incomplete;
  for (const sessions::StampRow& row : session.stamp_rows())
    if (row.LacksCamera()) incomplete.insert(row.frame);
  core::ToolsOfFrames tools(session.events());
  SweepFrames result;
  const std::vector<sessions::FrameSummary> all = session.frames();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (incomplete.contains(all[i].frame)) {
      ++result.without_camera;
    } else {
      result.frames.push_back({i, tools.At(all[i].frame)});
    }
  }
  if (!result.frames.empty()) return result;
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("session '{}' has no frames with all cameras; record a trial first",
                                session.path().string()));
}

SweepFrameLoader::SweepFrameLoader(const sessions::SessionReader& session, const SweepFrames& frames)
    : session_(session),
      frames_(frames),
      all_(session.frames()),
      rig_(std::make_shared<const core::Rig>(session.header().rig)) {
  // Reading a frame checks that its silhouettes have the sizes of the cameras' pictures, before planes of
  // these sizes are made.
  (void)session.ReadFrame(all_[frames.frames.front().position].frame);
  // Skew counts where a clearance is required.
  if (session.header().trial.required_clearance_mm > 0.0) stamps_ = session.stamp_rows();
  planes_ = recon::MakeUndistortedPlanes(*rig_);
}

review::StudyFrame SweepFrameLoader::Load(std::size_t i) {
  const std::size_t position = frames_.frames[i].position;
  if (stamps_.empty()) return Follow(position);
  const std::size_t first = position - FramesOfMotion(stamps_, all_, position);
  if (next_ < first || next_ > position) {
    motions_ = {};
    next_ = first;
  }
  while (next_ < position) (void)Follow(next_);
  return Follow(position);
}

review::StudyFrame SweepFrameLoader::Follow(std::size_t position) {
  const core::FrameRecord record = session_.ReadFrame(all_[position].frame);
  last_ = recon::NextHull(last_, rig_, planes_, *record.masks).hull;
  next_ = position + 1;
  review::StudyFrame frame{record.frame, last_, record.spacing_mm};
  if (!stamps_.empty()) frame.skew_errors = motions_.Next(*last_, record.stamps, record.time_s);
  return frame;
}

}  // namespace elbowroom::control
