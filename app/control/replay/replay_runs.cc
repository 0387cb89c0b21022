#include "app/control/replay/replay_runs.h"

#include <algorithm>
#include <utility>

#include "app/control/replay/frames_of_motion.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {
namespace {

// Of a run: frames that wait to be judged keep their contacts in memory.
constexpr std::size_t kLongestPiece = 32;

}  // namespace

ReplayRuns::ReplayRuns(const sessions::SessionReader& session, std::span<const sessions::FrameSummary> frames,
                       const ReplayLayout& layout, std::size_t first, std::size_t end, bool asks_clearance,
                       ReplaySegmentation* segmentation, std::stop_token stop)
    : session_(session),
      frames_(frames),
      layout_(layout),
      shared_layout_(std::make_shared<const core::Layout>(layout.layout())),
      poses_(*shared_layout_),
      rig_(std::make_shared<const core::Rig>(session.header().rig)),
      end_(end),
      asks_clearance_(asks_clearance),
      segmentation_(segmentation),
      stop_(std::move(stop)) {
  // Reading a frame, as is done here, checks that its silhouettes have the sizes of the cameras' pictures,
  // before planes of these sizes are made.
  const std::size_t begin = BeginOfRun(first);
  planes_ = recon::MakeUndistortedPlanes(*rig_);
  next_ = begin;
  if (asks_clearance_) next_ = std::min(next_, first - FramesOfMotion(session_.stamp_rows(), frames_, first));
  while (next_ < begin) (void)Load(next_);
}

std::size_t ReplayRuns::BeginOfRun(std::size_t first) const {
  core::SharedMasks masks = session_.ReadFrame(frames_[first].frame).masks;
  std::size_t begin = first;
  while (begin > 0 && *session_.ReadFrame(frames_[begin - 1].frame).masks == *masks) --begin;
  return begin;
}

std::optional<ReplayRun> ReplayRuns::Next() {
  if (!pending_ && next_ < end_) pending_ = Load(next_);
  if (!pending_) return std::nullopt;
  ReplayRun run;
  run.goes_on = goes_on_;
  const SharedHull hull = pending_->hull;
  goes_on_ = false;
  while (pending_) {
    run.frames.push_back(FrameFrom(*std::exchange(pending_, std::nullopt)));
    if (next_ == end_) break;
    pending_ = Load(next_);
    if (pending_->hull != hull) break;
    goes_on_ = run.frames.size() == kLongestPiece;
    if (goes_on_) break;
  }
  return run;
}

ReplayRuns::Loaded ReplayRuns::Load(std::size_t i) {
  Loaded loaded;
  loaded.record = session_.ReadFrame(frames_[i].frame);
  if (segmentation_ != nullptr) loaded.segmenting = segmentation_->Segment(&loaded.record, stop_);
  loaded.hull = recon::NextHull(last_hull_, rig_, planes_, *loaded.record.masks).hull;
  if (asks_clearance_)
    loaded.skew_errors = motions_.Next(*loaded.hull, loaded.record.stamps, loaded.record.time_s);
  last_hull_ = loaded.hull;
  next_ = i + 1;
  return loaded;
}

ReplayedFrame ReplayRuns::FrameFrom(Loaded loaded) {
  ReplayedFrame frame{std::move(loaded.record), results_.Take(), loaded.segmenting};
  FrameResult& result = *frame.result;
  result.record.frame = frame.recorded.frame;
  result.record.time_s = frame.recorded.time_s;
  result.record.masks = frame.recorded.masks;
  result.record.stamps = frame.recorded.stamps;
  result.record.spacing_mm = layout_.SpacingsFrom(frame.recorded.spacing_mm);
  result.hull = std::move(loaded.hull);
  result.skew_errors = std::move(loaded.skew_errors);
  result.layout = shared_layout_;
  result.world_from_parts = poses_.At(result.record.spacing_mm);
  return frame;
}

}  // namespace elbowroom::control
