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
<<<<<<< HEAD
#include "core/tools_in_use.h"
#include "sessions/row_comparison.h"
#include "sessions/session_writer.h"
=======
>>>>>>> segment24
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

<<<<<<< HEAD
// What becomes of the judged frames, in their order.
class ReplayRecording {
 public:
  ReplayRecording(const sessions::SessionReader& recorded, const ReplayLayout& layout,
                  std::span<const core::TriangleTree> part_trees, const std::filesystem::path& path)
      : recorded_(recorded),
        layout_(layout),
        tracker_(recorded.header().trial, part_trees),
        events_(recorded.events()),
        next_event_(events_.begin()),
        findings_(recorded.findings()),
        file_(path),
        writer_(file_.temporary(), HeaderOf(recorded, layout)) {
    outcome_.changes = layout.changes();
    if (outcome_.changes.empty()) outcome_.compared.emplace();
  }

  void Add(const core::FrameRecord& recorded, const SharedFrameResult& result) {
    TakeEvents(recorded.frame, recorded.time_s);
    tracker_.Add(*result, tools_in_use_.names());
    writer_.Append(result->record);
    if (outcome_.frames++ == 0) checked_.begin_s = recorded.time_s;
    checked_.end_s = recorded.time_s;
    for (const core::PartContact& contact : result->record.contacts)
      outcome_.contact_rows += contact.verdict == core::Verdict::kContact ? 1 : 0;
    outcome_.skipped += result->skipped;
    if (outcome_.compared) Compare(recorded, result->record);
  }

  ReplayOutcome Finish(bool to_the_end) {
    if (to_the_end)
      for (; next_event_ != events_.end(); ++next_event_) writer_.Append(layout_.EventFrom(*next_event_));
    core::SessionOutcome outcome = tracker_.Outcome();
    MatchFindings(findings_, layout_.layout(), &outcome);
    sessions::SessionClosing closing =
        TakeOverReview(findings_, layout_.layout(), checked_, outcome, kReviewer, core::NowUtc());
    closing.footage = recorded_.footage();
    outcome_.outcome = outcome;
    outcome_.absent = closing.absent;
    writer_.Finish(std::move(outcome), std::move(closing));
    if (writer_.state() != sessions::RecordingState::kInFile || writer_.path() != file_.temporary())
      throw core::Error(
          core::ErrorKind::kFile,
          fmt::format("the new session couldn't be written as '{}'; leave its folder alone, and "
                      "try again",
                      file_.temporary().string()));
    file_.PutInPlace();
    return std::move(outcome_);
  }

 private:
  // The events up to the frame. Those before the first frame of the replay aren't in it, but for the tools in
  // use.
  void TakeEvents(core::FrameIndex frame, double time_s) {
    for (; next_event_ != events_.end() && next_event_->frame <= frame; ++next_event_) {
      tools_in_use_.Take(*next_event_);
      const bool is_before = outcome_.frames == 0 && next_event_->frame < frame;
      if (!is_before) writer_.Append(layout_.EventFrom(*next_event_));
      if (is_before) has_earlier_ = true;
    }
    if (!std::exchange(has_earlier_, false)) return;
    for (const std::string& tool : tools_in_use_.names())
      writer_.Append(core::SessionEvent{frame, time_s, core::ToolMarked{tool, true}});
  }

  void Compare(const core::FrameRecord& recorded, const core::FrameRecord& replayed) {
    const sessions::RowComparison rows = sessions::CompareRows(recorded, replayed);
    ++outcome_.compared->frames;
    outcome_.compared->rows += rows.rows;
    if (rows.are_equal) return;
    if (outcome_.compared->frames_that_differ++ == 0) outcome_.compared->first_that_differs = recorded.frame;
  }

  const sessions::SessionReader& recorded_;
  const ReplayLayout& layout_;
  OutcomeTracker tracker_;
  std::vector<core::SessionEvent> events_;
  std::vector<core::SessionEvent>::const_iterator next_event_;
  std::vector<core::Finding> findings_;
  core::ToolsInUse tools_in_use_;
  bool has_earlier_ = false;
  CheckedRange checked_;
  ReplayOutcome outcome_;
  sessions::UnfinishedSession file_;
  sessions::SessionWriter writer_;
};
=======
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
>>>>>>> segment24

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
    ReplayOutcome outcome = GivesWay() || HasOtherSilhouettes() ? RunOneByOne() : RunSeveralAtOnce();
    outcome.time_s = watch.LapMs() / 1000.0;
    return outcome;
  }

 private:
  // A part that gives way goes on from where the frame before left it.
  [[nodiscard]] bool GivesWay() const { return !PartReactions(layout_.layout()).is_empty(); }

  // Then what was found in the frame before, as it is recorded, is no guide.
  [[nodiscard]] bool HasOtherSilhouettes() const {
    return segmentation_ && !segmentation_->changes().empty();
  }

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
    ReplayRecording recording(recorded_, layout_, judging.part_trees(), header_, path_, &file_);
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

  // Where parts give way, all frames from the session's first, since what a part did before moves it now;
  // else from as far before the first that is wanted as the motion of silhouettes has to be known.
  [[nodiscard]] std::size_t BeginOfOrder() const {
    if (GivesWay()) return 0;
    if (!(review_.required_clearance_mm > 0.0)) return selected_.first;
    return selected_.first - FramesOfMotion(recorded_, frames_, selected_.first);
  }

  using SharedFrame = std::shared_ptr<ReplayedFrame>;

  // Before it is judged.
  [[nodiscard]] SharedFrame ReadFrame(std::size_t i) {
    auto frame = std::make_shared<ReplayedFrame>();
    frame->recorded = recorded_.ReadFrame(frames_[i].frame);
    if (segmentation_) frame->segmenting = segmentation_->Segment(&frame->recorded, stop_);
    return frame;
  }

  // In order, each after the one before; the next frame is read and segmented, and the last one recorded,
  // meanwhile.
  ReplayOutcome RunOneByOne() {
    SilhouettePipeline pipeline(header_.rig, layout_.layout(), review_);
    ReplayRecording recording(recorded_, layout_, pipeline.part_trees(), header_, path_, &file_);
    std::size_t next = BeginOfOrder();
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
