#include "recon/capture/live_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "recon/footage/background_reader.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::recon {
namespace {

using core::CameraIndex;
using core::LossReason;
using core::PictureLoss;

AssemblerOptions AssemblerOptionsOf(const RigFile& rig_file) {
  AssemblerOptions options;
  for (const CameraSources& sources : rig_file.sources) {
    options.time_offset_s.push_back(sources.time_offset_s);
    if (sources.capture.rate_hz) options.period_s = 1.0 / *sources.capture.rate_hz;
  }
  return options;
}

DeviceRequest RequestFor(const CameraSources& sources, const core::CameraModel& camera) {
  return {sources.frames, camera.width_px(), camera.height_px(), sources.capture};
}

}  // namespace

LiveRig::LiveRig(RigFile rig_file, LiveTaps taps, const std::stop_token& stop)
    : rig_file_(std::move(rig_file)),
      taps_(std::move(taps)),
      assembler_(rig_file_.rig.cameras.size(), AssemblerOptionsOf(rig_file_),
                 [this](CameraIndex camera, const CapturedPicture& picture) {
                   losses_.push_back({camera, picture.number, picture.number, LossReason::kUnpaired});
                 }),
      states_(rig_file_.rig.cameras.size()),
      lost_(rig_file_.rig.cameras.size(), 0) {
  core::Require(rig_file_.sources.size() == rig_file_.rig.cameras.size(),
                "a rig file has sources for every camera");
  for (const CameraSources& sources : rig_file_.sources)
    core::Require(IsLive(sources.frames), "every camera of a live rig is live");
  rig_file_.rig.Validate();
  for (CameraIndex i = 0; i < states_.size(); ++i) StartCamera(i);
  WaitUntilStarted(stop);
  decider_ = std::jthread([this](const std::stop_token& end) { Decide(end); });
}

LiveRig::~LiveRig() = default;

void LiveRig::StartCamera(CameraIndex camera) {
  CaptureHandlers handlers;
  handlers.on_picture = [this, camera](CapturedPicture picture) {
    if (taps_.on_picture) taps_.on_picture(camera, picture);
    {
      const std::lock_guard lock(mutex_);
      assembler_.Add(camera, std::move(picture));
      ++arrivals_;
    }
    came_.notify_all();
  };
  handlers.on_loss = [this, camera](PictureLoss loss) {
    loss.camera = camera;
    if (taps_.on_loss) taps_.on_loss(loss);
    const std::lock_guard lock(mutex_);
    losses_.push_back(loss);
  };
  handlers.on_state = [this, camera](const CameraState& state) {
    {
      const std::lock_guard lock(mutex_);
      states_[camera] = state;
      assembler_.SetGone(camera, state.presence == CameraPresence::kGone);
      ++arrivals_;
    }
    came_.notify_all();
    if (taps_.on_state) taps_.on_state(camera, state);
  };
  links_.push_back(std::make_unique<CameraLink>(
      RequestFor(rig_file_.sources[camera], rig_file_.rig.cameras[camera]), std::move(handlers)));
}

void LiveRig::WaitUntilStarted(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto is = [](CameraPresence presence) {
    return [presence](const CameraState& state) { return state.presence == presence; };
  };
  came_.wait(lock, stop, [&] {
    return std::ranges::any_of(states_, is(CameraPresence::kGone)) ||
           std::ranges::all_of(states_, is(CameraPresence::kRunning));
  });
  const auto gone = std::ranges::find_if(states_, is(CameraPresence::kGone));
  if (gone != states_.end()) {
    const auto camera = static_cast<CameraIndex>(gone - states_.begin());
    const std::string message =
        fmt::format("camera '{}': {}", rig_file_.rig.cameras[camera].name(), gone->trouble);
    lock.unlock();  // the links' threads may need it to end
    throw core::Error(core::ErrorKind::kCamera, message);
  }
  core::ThrowIfStopped(stop, "starting the cameras");
}

std::vector<DecidedSet> LiveRig::TakeDecided() {
  std::vector<DecidedSet> decided;
  const CaptureClock::time_point now = CaptureClock::now();
  while (std::optional<PictureSet> set = assembler_.TryTake(now)) {
    for (const PictureLoss& loss : losses_)
      if (has_reader_ && loss.reason != LossReason::kUnpaired) lost_[loss.camera] += loss.count();
    decided.push_back({std::move(*set), now, std::exchange(losses_, {})});
  }
  return decided;
}

void LiveRig::Decide(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::vector<DecidedSet> decided;
    {
      std::unique_lock lock(mutex_);
      decided = TakeDecided();
      for (const DecidedSet& set : decided) Offer(set);
      if (decided.empty()) {
        const auto has_news = [this, seen = arrivals_] { return arrivals_ != seen; };
        if (const auto deadline = assembler_.Deadline()) {
          came_.wait_until(lock, stop, *deadline, has_news);
        } else {
          came_.wait(lock, stop, has_news);
        }
        continue;
      }
    }
    ready_.notify_all();
    if (!taps_.on_set) continue;
    for (const DecidedSet& set : decided) taps_.on_set(set);
  }
}

void LiveRig::Offer(const DecidedSet& set) {
  sets_.push_back(set);
  if (!has_reader_) {
    if (sets_.size() > 1) sets_.pop_front();
    return;
  }
  if (sets_.size() <= kMostReady) return;
  const DecidedSet& old = sets_.front();
  unread_.insert(unread_.end(), old.losses.begin(), old.losses.end());
  for (CameraIndex i = 0; i < old.set.pictures.size(); ++i) {
    if (!old.set.pictures[i]) continue;
    const std::uint64_t number = old.set.pictures[i]->number;
    unread_.push_back({i, number, number, LossReason::kPassedOver});
    ++lost_[i];
  }
  sets_.pop_front();
}

FrameSet LiveRig::FrameSetOf(DecidedSet decided, core::FrameIndex index) {
  if (!first_at_) first_at_ = decided.set.taken_at;
  const auto seconds = [&](CaptureClock::time_point at) {
    return std::chrono::duration<double>(at - *first_at_).count();
  };
  FrameSet frames{index, seconds(decided.set.taken_at), {}};
  frames.taken_at = decided.set.taken_at;
  frames.losses = std::move(decided.losses);
  for (CameraIndex i = 0; i < decided.set.pictures.size(); ++i) {
    std::optional<CapturedPicture>& picture = decided.set.pictures[i];
    CameraFrame frame;
    if (picture) {
      frame.image_bgr = std::move(picture->image_bgr);
      frame.stamp =
          core::CameraStamp{picture->number, seconds(picture->taken_at) + rig_file_.sources[i].time_offset_s};
    }
    frames.cameras.push_back(std::move(frame));
  }
  return frames;
}

std::optional<FrameSet> LiveRig::TryRead(core::FrameIndex index, std::stop_token stop) {
  core::Require(index >= 0, "frames count from 0");
  std::unique_lock lock(mutex_);
  has_reader_ = true;
  ready_.wait(lock, stop, [this] { return !sets_.empty(); });
  core::ThrowIfStopped(stop, "waiting for the cameras");
  DecidedSet decided = std::move(sets_.front());
  sets_.pop_front();
  decided.losses.insert(decided.losses.begin(), unread_.begin(), unread_.end());
  unread_.clear();
  return FrameSetOf(std::move(decided), index);
}

std::vector<std::string> LiveRig::Warnings() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> warnings;
  for (CameraIndex i = 0; i < states_.size(); ++i) {
    const std::string& name = rig_file_.rig.cameras[i].name();
    for (const std::string& warning : states_[i].report.warnings)
      warnings.push_back(fmt::format("camera '{}': {}", name, warning));
    if (lost_[i] > 0)
      warnings.push_back(fmt::format("camera '{}': {} {} lost", name, lost_[i],
                                     lost_[i] == 1 ? "picture was" : "pictures were"));
  }
  return warnings;
}

std::vector<std::string> LiveRig::CameraTroubles() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> troubles;
  for (const CameraState& state : states_)
    troubles.push_back(state.presence == CameraPresence::kGone ? state.trouble : std::string());
  return troubles;
}

std::vector<BackgroundReference> LiveRig::ReadBackgrounds(const core::Progress& progress,
                                                          std::stop_token stop) {
  return ReadBackgroundReferences(rig_file_, progress, std::move(stop));
}

std::vector<CameraState> LiveRig::states() const {
  const std::lock_guard lock(mutex_);
  return states_;
}

}  // namespace elbowroom::recon
