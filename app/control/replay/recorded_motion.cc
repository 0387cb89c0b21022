#include "app/control/replay/recorded_motion.h"

#include <utility>

#include "app/control/replay/frames_of_motion.h"
#include "recon/hull/next_hull.h"

namespace elbowroom::control {

RecordedMotion::RecordedMotion(const core::Rig& rig, std::vector<sessions::FrameSummary> frames,
                               std::vector<sessions::StampRow> stamps, FrameReader read, HullKeeper keeper)
    : rig_(std::make_shared<const core::Rig>(rig)),
      frames_(std::move(frames)),
      stamps_(std::move(stamps)),
      read_(std::move(read)),
      keeper_(std::move(keeper)) {}

MotionFrame RecordedMotion::Load(std::size_t position) {
  if (stamps_.empty()) return Follow(position);
  const std::size_t first = position - FramesOfMotion(stamps_, frames_, position);
  if (next_ < first || next_ > position) {
    motions_ = {};
    next_ = first;
  }
  while (next_ < position) (void)Follow(next_);
  return Follow(position);
}

MotionFrame RecordedMotion::Follow(std::size_t position) {
  MotionFrame frame;
  frame.record = read_(frames_[position].frame);
  // Reading a frame checks that its silhouettes have the sizes of the cameras' pictures, before planes of
  // these sizes are made.
  if (planes_.empty()) planes_ = recon::MakeUndistortedPlanes(*rig_);
  bool is_kept = false;
  const auto give = [&](auto silhouettes) { is_kept = keeper_ && keeper_(silhouettes); };
  SharedHull hull = recon::NextHull(last_, rig_, planes_, *frame.record.masks, give).hull;
  if (hull != last_) ++(is_kept ? hulls_kept_ : hulls_made_);
  last_ = std::move(hull);
  next_ = position + 1;
  frame.hull = last_;
  if (!stamps_.empty()) frame.skew_errors = motions_.Next(*last_, frame.record.stamps, frame.record.time_s);
  return frame;
}

}  // namespace elbowroom::control
