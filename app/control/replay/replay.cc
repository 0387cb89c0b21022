#include "app/control/replay/replay.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "app/control/replay/replay_judging.h"
#include "app/control/replay/replay_recording.h"
#include "app/control/replay/replay_runs.h"
#include "app/control/silhouette_pipeline.h"
#include "app/control/stopwatch.h"
#include "app/control/trial_rules.h"
#include "app/control/versions.h"
#include "core/error.h"
#include "core/system/utc_time.h"
#include "sessions/unfinished_session.h"

namespace elbowroom::control {
namespace {

// Positions in `frames` of those in the range.
struct Selection {
  std::size_t first = 0;
  std::size_t end = 0;
};

Selection SelectFrames(const sessions::SessionReader& session,
                       const std::vector<sessions::FrameSummary>& frames, const FrameRange& range) {
  const auto position = [&](core::FrameIndex frame) {
    return static_cast<std::size_t>(
        std::ranges::lower_bound(frames, frame, {}, &sessions::FrameSummary::frame) - frames.begin());
  };
  const Selection selected{position(range.first), range.end ? position(*range.end) : frames.size()};
  if (selected.first < selected.end) return selected;
  const std::string what_is_there =
      frames.empty() ? "no frames"
                     : fmt::format("frames {} to {}", frames.front().frame, frames.back().frame);
  throw core::Error(core::ErrorKind::kRange, fmt::format("session '{}' has {}; choose a range within it",
                                                         session.path().string(), what_is_there));
}

std::vector<std::string> ChangesOf(const ReplayLayout& layout,
                                   const std::optional<ReplaySegmentation>& segmentation) {
  std::vector<std::string> changes = layout.changes();
  if (segmentation)
    changes.insert(changes.end(), segmentation->changes().begin(), segmentation->changes().end());
  return changes;
}

core::SessionHeader HeaderOf(const sessions::SessionReader& recorded, const ReplayLayout& layout,
                             const std::optional<ReplaySegmentation>& segmentation) {
  core::SessionHeader header = recorded.header();
  if (segmentation) segmentation->Describe(&header);
  header.layout = layout.layout();
  header.versions = SoftwareVersions();
  header.origin =
      core::SessionOrigin{recorded.path().string(), recorded.recording_id(), recorded.first_recording_id(),
                          core::NowUtc(), ChangesOf(layout, segmentation)};
  return header;
}

// One replay: which frames, judged how.
class Replay {
 public:
  Replay(const sessions::SessionReader& recorded, const ReplayOptions& options,
         const core::Progress& progress, const std::stop_token& stop)
      : recorded_(recorded),
        frames_(recorded.frames()),
        selected_(SelectFrames(recorded, frames_, options.frames)),
        layout_(recorded.header().layout, options.changes),
        path_(options.session),
        file_(path_),
        progress_(progress),
        stop_(stop) {
    if (options.segmenting) segmentation_.emplace(recorded, *options.segmenting, progress, stop);
    header_ = HeaderOf(recorded, layout_, segmentation_);
    review_ = ReviewOptionsOf(header_.trial, header_.rig, header_.rig_quality);
  }

  ReplayOutcome Run() {
    Stopwatch watch;
    ReplayOutcome outcome = GivesWay() ? RunOneByOne() : RunSeveralAtOnce();
    outcome.time_s = watch.LapMs() / 1000.0;
    return outcome;
  }

 private:
  // A part that gives way goes on from where the frame before left it.
  [[nodiscard]] bool GivesWay() const { return !PartReactions(layout_.layout()).is_empty(); }

  // What the recording says of pair rules holds for all of it, as it was.
  [[nodiscard]] bool JudgesPairs() const { return !header_.origin->changes.empty() || selected_.first > 0; }

  [[nodiscard]] ReplayOutcome Finish(ReplayRecording* recording) const {
    ReplayOutcome outcome = recording->Finish(selected_.end == frames_.size());
    if (segmentation_)
      outcome.segmented =
          ReplaySegmented{segmentation_->footage(), recording->segmenting(), segmentation_->warnings()};
    return outcome;
  }

  void Record(const ReplayedFrame& frame, ReplayRecording* recording) const {
    const core::FrameIndex number = frame.recorded.frame;
    if (number >= frames_[selected_.first].frame) recording->Add(frame);
    const auto done = static_cast<std::int64_t>(
        std::ranges::upper_bound(frames_, number, {}, &sessions::FrameSummary::frame) - frames_.begin());
    progress_.Report(done - static_cast<std::int64_t>(selected_.first),
                     static_cast<std::int64_t>(selected_.end - selected_.first), "replaying frame");
  }

  ReplayOutcome RunSeveralAtOnce() {
    ReplayJudging judging(layout_.layout(), review_);
    ReplayRecording recording(recorded_, layout_, judging.part_trees(), header_, path_, &file_,
                              JudgesPairs());
    ReplayRuns runs(recorded_, frames_, layout_, selected_.first, selected_.end,
                    review_.required_clearance_mm > 0.0, segmentation_ ? &*segmentation_ : nullptr, stop_);
    SharedFrameResult last;
    using SharedRun = std::shared_ptr<ReplayRun>;
    const auto read = [&](tbb::flow_control& control) -> SharedRun {
      std::optional<ReplayRun> run;
      if (!stop_.stop_requested()) run = runs.Next();
      if (!run) {
        control.stop();
        return nullptr;
      }
      return std::make_shared<ReplayRun>(*std::move(run));
    };
    const auto judge = [&](SharedRun run) {
      if (!run->goes_on) judging.Judge(nullptr, run.get());
      return run;
    };
    const auto record = [&](const SharedRun& run) {
      if (run->goes_on) judging.Judge(last.get(), run.get());
      for (const ReplayedFrame& frame : run->frames) Record(frame, &recording);
      last = run->frames.back().result;
    };
    constexpr std::size_t kRunsAThread = 4;
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    tbb::parallel_pipeline(kRunsAThread * threads,
                           tbb::make_filter<void, SharedRun>(tbb::filter_mode::serial_in_order, read) &
                               tbb::make_filter<SharedRun, SharedRun>(tbb::filter_mode::parallel, judge) &
                               tbb::make_filter<SharedRun, void>(tbb::filter_mode::serial_in_order, record));
    core::ThrowIfStopped(stop_, "the replay");
    return Finish(&recording);
  }

  using SharedFrame = std::shared_ptr<ReplayedFrame>;

  // Before it is judged.
  [[nodiscard]] SharedFrame ReadFrame(std::size_t i) {
    auto frame = std::make_shared<ReplayedFrame>();
    frame->recorded = recorded_.ReadFrame(frames_[i].frame);
    if (segmentation_) frame->segmenting = segmentation_->Segment(&frame->recorded, stop_);
    return frame;
  }

  // In order from the session's first frame, since what a part did before moves it now; the next frame is
  // read and segmented, and the last one recorded, meanwhile.
  ReplayOutcome RunOneByOne() {
    SilhouettePipeline pipeline(header_.rig, layout_.layout(), review_);
    ReplayRecording recording(recorded_, layout_, pipeline.part_trees(), header_, path_, &file_,
                              JudgesPairs());
    std::size_t next = 0;
    const auto read = [&](tbb::flow_control& control) -> SharedFrame {
      if (!stop_.stop_requested() && next < selected_.end) return ReadFrame(next++);
      control.stop();
      return nullptr;
    };
    const auto judge = [&](SharedFrame frame) {
      const core::FrameRecord& recorded = frame->recorded;
      frame->result =
          pipeline.Process({recorded.frame, recorded.time_s, *recorded.masks, recorded.stamps, {}},
                           layout_.SpacingsFrom(recorded.spacing_mm));
      frame->result->skipped.segmentation = frame->segmenting.stats;
      return frame;
    };
    const auto record = [&](const SharedFrame& frame) { Record(*frame, &recording); };
    constexpr std::size_t kFramesUnderWay = 4;
    tbb::parallel_pipeline(
        kFramesUnderWay,
        tbb::make_filter<void, SharedFrame>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<SharedFrame, SharedFrame>(tbb::filter_mode::serial_in_order, judge) &
            tbb::make_filter<SharedFrame, void>(tbb::filter_mode::serial_in_order, record));
    core::ThrowIfStopped(stop_, "the replay");
    return Finish(&recording);
  }

  const sessions::SessionReader& recorded_;
  const std::vector<sessions::FrameSummary> frames_;
  const Selection selected_;
  const ReplayLayout layout_;
  const std::filesystem::path path_;
  sessions::UnfinishedSession file_;  // refuses a name that is taken before long footage is checked
  std::optional<ReplaySegmentation> segmentation_;
  core::SessionHeader header_;
  review::PartReviewOptions review_;
  const core::Progress& progress_;
  const std::stop_token stop_;
};

}  // namespace

ReplayOutcome RunReplay(const sessions::SessionReader& recorded, const ReplayOptions& options,
                        const core::Progress& progress, const std::stop_token& stop) {
  return Replay(recorded, options, progress, stop).Run();
}

}  // namespace elbowroom::control
