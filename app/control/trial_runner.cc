#include "app/control/trial_runner.h"

#include <fmt/format.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <utility>
#include <variant>

#include "app/control/footage_files.h"
#include "app/control/frame_pipeline.h"
#include "app/control/light/trial_light.h"
#include "app/control/outcome_tracker.h"
#include "app/control/pairs/pair_watch.h"
#include "app/control/procedure/procedure_record.h"
#include "app/control/segmentation/segmentation_settings.h"
#include "app/control/trial_rules.h"
#include "app/control/versions.h"
#include "core/error.h"
#include "core/procedure/tools_in_use.h"
#include "core/system/utc_time.h"
#include "sessions/session_writer.h"

namespace elbowroom::control {
namespace {

using Clock = std::chrono::steady_clock;

core::SessionHeader HeaderOf(const TrialSetup& setup) {
  core::SessionHeader header;
  header.trial = setup.info;
  header.rig = setup.source->rig();
  header.rig_quality = setup.rig_quality;
  header.layout = setup.layout;
  header.started_at_utc = core::NowUtc();
  header.settings = SettingsOf(setup.segmentation);
  header.versions = SoftwareVersions();
  return header;
}

sessions::SessionWriterOptions WriterOptionsOf(const TrialOptions& options) {
  sessions::SessionWriterOptions writer;
  writer.on_news = options.on_recording;
  return writer;
}

// Refuses a range that the files promise no frames for.
void RequireInRange(const TrialSetup& setup, const FrameRange& range) {
  const std::optional<core::FrameIndex> promised = setup.source->frame_count();
  const std::string asked =
      fmt::format("frames {}:{}", range.first, range.end ? std::to_string(*range.end) : std::string());
  if (range.first < 0 || range.first >= range.end.value_or(range.first + 1)) {
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("{}: no frame is in that range; A:B counts from 0 and B is not included", asked));
  }
  if (promised && std::max(range.first + 1, range.end.value_or(0)) > *promised) {
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("{}: the footage has {} frames (0:{}); choose a range within it", asked,
                                  *promised, *promised));
  }
}

// Waits for the time at which a frame was taken; wakes early on a stop.
class Pace {
 public:
  void WaitFor(double time_s, const std::stop_token& stop) {
    if (!begin_) {
      begin_ =
          Clock::now() - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
    }
    std::unique_lock lock(mutex_);
    const auto due =
        *begin_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
    wakes_.wait_until(lock, stop, due, [] { return false; });
  }

 private:
  std::optional<Clock::time_point> begin_;
  std::mutex mutex_;
  std::condition_variable_any wakes_;
};

// Losses of live pictures as notes of the session: those that follow each other in number are one.
class LossNotes {
 public:
  explicit LossNotes(const core::Rig& rig) : rig_(rig), open_(rig.cameras.size()) {}

  // The notes that nothing more can be added to.
  [[nodiscard]] std::vector<std::string> Add(const core::PictureLoss& loss) {
    std::optional<core::PictureLoss>& open = open_.at(loss.camera);
    if (open && open->reason == loss.reason && open->last + 1 == loss.first) {
      open->last = loss.last;
      return {};
    }
    std::vector<std::string> notes;
    if (open) notes.push_back(TextOf(*open));
    open = loss;
    return notes;
  }

  [[nodiscard]] std::vector<std::string> Rest() const {
    std::vector<std::string> notes;
    for (const auto& open : open_)
      if (open) notes.push_back(TextOf(*open));
    return notes;
  }

 private:
  [[nodiscard]] std::string TextOf(const core::PictureLoss& loss) const {
    return core::TextOf(loss, rig_.cameras[loss.camera].name());
  }

  const core::Rig& rig_;
  std::vector<std::optional<core::PictureLoss>> open_;  // by camera
};

// One trial under way: what is recorded and what is counted.
class Recording {
 public:
  Recording(const TrialSetup& setup, const TrialOptions& options, TrialControls& controls)
      : setup_(setup),
        options_(options),
        controls_(controls),
        loss_notes_(setup.source->rig()),
        knock_watch_(setup.source->rig()),
        pair_watch_(setup.layout),
        pair_record_(setup.layout),
        writer_(options.session, HeaderOf(setup), WriterOptionsOf(options)),
        procedure_(setup.info.steps) {
    spacing_mm_ = setup.layout.InitialSpacings();
    outcome_.frames_in_contact.assign(setup.layout.parts.size(), 0);
    outcome_.largest_budgets.resize(setup.layout.parts.size());
    outcome_.pictures_lost.assign(setup.source->rig().cameras.size(), 0);
  }

  void Run(const std::stop_token& stop) {
    if (setup_.footage) {
      const std::filesystem::path folder = FootageFolderOf(options_.session);
      setup_.footage->Begin(folder);
      footage_from_ = Clock::now();
      is_recording_footage_ = true;
      KeepIgnoredPixels(setup_.segmentation, setup_.source->rig(), folder);
    }
    backgrounds_ = setup_.source->ReadBackgrounds(options_.progress, stop);
    pipeline_.emplace(setup_.source->rig(), setup_.layout, backgrounds_, setup_.segmentation,
                      ReviewOptionsOf(setup_.info, setup_.source->rig(), setup_.rig_quality));
    tracker_.emplace(setup_.info, pipeline_->part_trees());
    const core::FrameIndex first = options_.frames.first;
    const core::FrameIndex end = options_.frames.end.value_or(std::numeric_limits<core::FrameIndex>::max());
    for (core::FrameIndex frame = first; frame < end && !stop.stop_requested(); ++frame) {
      std::optional<recon::FrameSet> frames = setup_.source->TryRead(frame, stop);
      while (frames && IsBeforeFootage(*frames)) frames = setup_.source->TryRead(frame, stop);
      if (!frames) return EndWithFootage(frame);
      const std::optional<Clock::time_point> taken_at = frames->taken_at;  // a live frame comes when it comes
      if (options_.at_capture_rate && !taken_at) pace_.WaitFor(frames->time_s, stop);
      ApplyChanges(frame, frames->time_s);
      const Clock::time_point begin = Clock::now();
      pair_watch_.Ask(frame, frames->time_s, spacing_mm_);
      const std::shared_ptr<FrameResult> result =
          pipeline_->Process(std::move(*frames), spacing_mm_, options_.on_hull);
      TakePairs(options_.at_capture_rate || taken_at ? std::optional(kPairPatience) : std::nullopt);
      AddPairs(result.get());
      result->step = procedure_.under_way();
      outcome_.frame_times.Add(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
      if (taken_at)
        outcome_.latencies.Add(std::chrono::duration<double, std::milli>(Clock::now() - *taken_at).count());
      Record(result);
      WatchLight(*result);
      const RecordedFrames recorded{outcome_.frames, writer_.frames_committed()};
      if (options_.on_frame) options_.on_frame(result, recorded);
      const core::FrameIndex expected = std::min(end, setup_.source->frame_count().value_or(first));
      options_.progress.Report(frame + 1 - first, expected - first,
                               fmt::format("{} on disk, frame", recorded.committed));
    }
  }

  TrialOutcome Finish(const std::string& end_note) {
    outcome_.end_note = end_note;
    TakePairs(std::nullopt);
    outcome_.pairs = pair_record_.Totals(last_time_s_);
    EndFootage();
    TakeLastWords();
    BeginStep("", last_frame_, last_time_s_);
    for (const std::string& note : loss_notes_.Rest()) Append(note);
    for (const std::string& note : setup_.source->Warnings()) Append(note);
    FinishLight();
    if (!end_note.empty()) Append(end_note);
    outcome_so_far_.wait();
    TellOfKnock();
    outcome_.knocks = knock_watch_.report();
    if (tracker_ && options_.heat != nullptr) tracker_->TellHeat(options_.heat);
    core::SessionOutcome outcome = tracker_ ? tracker_->Outcome() : core::SessionOutcome();
    outcome_.episodes = outcome.episodes;
    outcome_.near_misses = outcome.near_misses;
    writer_.Finish(std::move(outcome), std::move(closing_));
    outcome_.session = writer_.path();
    outcome_.frames_committed = writer_.frames_committed();
    outcome_.recording = writer_.state();
    return outcome_;
  }

  // Ends the session because of `failure`, and throws it with what is kept.
  [[noreturn]] void EndAfter(const core::Error& failure) {
    if (!HasFrames()) {
      Abandon();
      throw core::Error(failure.kind(), failure.what());
    }
    try {
      (void)Finish(fmt::format("ended by a failure: {}", failure.what()));
    } catch (const core::Error&) {
      // The session file itself fails: the frames that are in it are counted below.
    }
    ThrowWithWhatIsKept(failure);
  }

  [[noreturn]] void ThrowWithWhatIsKept(const core::Error& failure) const {
    const std::int64_t kept = writer_.frames_committed();
    const std::string what_is_kept = kept == 0 ? "no frame was recorded"
                                               : fmt::format("{} of {} frames are kept in '{}'", kept,
                                                             outcome_.frames, writer_.path().string());
    throw core::Error(failure.kind(), fmt::format("{}; {}", failure.what(), what_is_kept));
  }

  void Abandon() {
    writer_.Abandon();
    AbandonFootage();
  }

  [[nodiscard]] bool HasFrames() const { return outcome_.frames > 0; }

 private:
  // The files may have promised more frames than can be decoded.
  void EndWithFootage(core::FrameIndex end) const {
    if (end > options_.frames.first && end >= options_.frames.end.value_or(0)) return;
    const core::FrameIndex frames = setup_.source->frame_count().value_or(end);
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("frames {}:{}: the footage has {} frames (0:{}); it ended with {}", options_.frames.first,
                    options_.frames.end ? std::to_string(*options_.frames.end) : std::string(), frames,
                    frames, setup_.source->WhatEndsIt()));
  }

  void ApplyChanges(core::FrameIndex frame, double time_s) {
    if (frame == options_.frames.first) OpenProcedure(frame, time_s);
    for (const ScriptedChange& change : setup_.script) {
      if (change.frame != frame) continue;
      std::visit([&](const auto& request) { Apply(frame, time_s, request); }, change.what);
    }
    const TrialControls::Requests requests = controls_.Take();
    for (const SpacingRequest& request : requests.spacings) Apply(frame, time_s, request);
    for (const ToolRequest& request : requests.tools) Apply(frame, time_s, request);
    for (const std::string& note : requests.notes)
      writer_.Append(core::SessionEvent{frame, time_s, core::Note{note}});
    for (const auto& moment : requests.moments) {
      if (const auto* step = std::get_if<StepRequest>(&moment)) BeginStep(step->step, frame, time_s);
      if (const auto* bookmark = std::get_if<core::Bookmark>(&moment))
        writer_.Append(core::SessionEvent{frame, time_s, *bookmark});
    }
  }

  // Said after the last frame, for example while the cameras were gone. A gap, a tool or a step would have
  // held from the next frame on, which didn't come.
  void TakeLastWords() {
    const TrialControls::Requests requests = controls_.Take();
    for (const std::string& note : requests.notes) Append(note);
    for (const auto& moment : requests.moments)
      if (const auto* bookmark = std::get_if<core::Bookmark>(&moment))
        writer_.Append(core::SessionEvent{last_frame_, last_time_s_, *bookmark});
  }

  void OpenProcedure(core::FrameIndex frame, double time_s) {
    for (const core::EventContent& what : setup_.opening)
      writer_.Append(core::SessionEvent{frame, time_s, what});
    if (!setup_.first_step.empty()) BeginStep(setup_.first_step, frame, time_s);
  }

  void BeginStep(const std::string& step, core::FrameIndex frame, double time_s) {
    for (core::SessionEvent& event : procedure_.Begin(step, frame, time_s)) writer_.Append(std::move(event));
  }

  void Apply(core::FrameIndex frame, double time_s, const StepRequest& request) {
    BeginStep(request.step, frame, time_s);
  }

  void Apply(core::FrameIndex frame, double time_s, const ToolRequest& request) {
    const core::ToolMarked mark{request.tool, request.in_use};
    tools_in_use_.Take(mark);
    writer_.Append(core::SessionEvent{frame, time_s, mark});
  }

  void Apply(core::FrameIndex frame, double time_s, const SpacingRequest& request) {
    const std::optional<core::SpacingIndex> index = setup_.layout.FindSpacing(request.spacing);
    if (!index) {
      const std::string note = fmt::format("no spacing is named '{}'", request.spacing);
      writer_.Append(core::SessionEvent{frame, time_s, core::Note{note}});
      return;
    }
    const core::Spacing& spacing = setup_.layout.spacings[*index];
    const double allowed_mm = std::clamp(request.to_mm, spacing.min_mm, spacing.max_mm);
    const double from_mm = std::exchange(spacing_mm_[*index], allowed_mm);
    if (from_mm == allowed_mm) return;
    writer_.Append(
        core::SessionEvent{frame, time_s, core::SpacingChanged{request.spacing, from_mm, allowed_mm}});
  }

  // What became known of pair rules: for the session, and for the frames from here on.
  void TakePairs(std::optional<std::chrono::milliseconds> patience) {
    for (SharedPairVerdicts& verdicts : pair_watch_.Take(patience)) {
      for (core::SessionEvent& note : pair_record_.Add(*verdicts)) writer_.Append(std::move(note));
      new_pair_count_ += verdicts->count;
      pairs_ = std::move(verdicts);
    }
  }

  void AddPairs(FrameResult* result) {
    result->pairs = pairs_;
    result->skipped.pairs = std::exchange(new_pair_count_, {});
    if (result->skipped.pairs.pairs > 0) return;
    result->skipped.pairs.pairs = static_cast<std::int64_t>(pair_watch_.pairs().size());
    result->skipped.pairs.unchanged = result->skipped.pairs.pairs;
  }

  // Live cameras run before the trial does, and a set may wait of which a picture came before the footage
  // began: the trial begins with the first one that is in the footage.
  [[nodiscard]] bool IsBeforeFootage(const recon::FrameSet& frames) const {
    if (!is_recording_footage_ || !frames.taken_at || HasFrames()) return false;
    return std::ranges::any_of(frames.cameras, [&](const recon::CameraFrame& camera) {
      if (!camera.stamp) return false;
      const std::chrono::duration<double> from_middle(camera.stamp->time_s - frames.time_s);
      return *frames.taken_at + std::chrono::duration_cast<Clock::duration>(from_middle) < footage_from_;
    });
  }

  // Trouble with it is noted; the session is worth more than its footage.
  void EndFootage() {
    if (!std::exchange(is_recording_footage_, false)) return;
    try {
      outcome_.footage = setup_.footage->End();
      for (const std::string& trouble : outcome_.footage->Troubles()) Append("footage: " + trouble);
      for (const recon::CameraRecording& camera : outcome_.footage->cameras)
        if (camera.unwritten > 0)
          Append(fmt::format("footage: {} pictures of camera '{}' weren't written", camera.unwritten,
                             camera.name));
      closing_.footage = FootageFilesIn(FootageFolderOf(options_.session), options_.progress);
    } catch (const core::Error& error) {
      Append(fmt::format("footage: {}", error.what()));
    }
  }

  // Of a trial without a frame nothing stays.
  void AbandonFootage() {
    if (!is_recording_footage_) return;
    EndFootage();
    std::error_code ignored;
    std::filesystem::remove_all(FootageFolderOf(options_.session), ignored);
  }

  void Append(const std::string& note) {
    writer_.Append(core::SessionEvent{last_frame_, last_time_s_, core::Note{note}});
  }

  // When nothing of a frame is under way.
  void TellOfKnock() {
    const std::optional<std::string> advice = std::exchange(knock_advice_, std::nullopt);
    if (!advice) return;
    Append(*advice);
    if (options_.on_knock) options_.on_knock(knock_watch_.report());
  }

  // Touches, heat maps and the watch are brought up to date while the next frame is judged.
  void Record(const SharedFrameResult& shared) {
    const FrameResult& result = *shared;
    last_frame_ = result.record.frame;
    last_time_s_ = result.record.time_s;
    outcome_so_far_.wait();
    TellOfKnock();
    outcome_so_far_.run([this, shared, tools = tools_in_use_.names()] {
      tracker_->Add(*shared, tools);
      if (options_.heat != nullptr && options_.heat->TakesMaps()) tracker_->TellHeat(options_.heat);
    });
    outcome_so_far_.run([this, shared] { knock_advice_ = knock_watch_.Add(shared->record); });
    writer_.Append(result.record);
    ++outcome_.frames;
    for (const core::PartContact& contact : result.record.contacts) {
      outcome_.frames_in_contact[contact.part] += contact.verdict == core::Verdict::kContact ? 1 : 0;
      if (!contact.clearance || !contact.clearance->budget) continue;
      const core::ErrorBudget& budget = *contact.clearance->budget;
      std::optional<core::ErrorBudget>& largest = outcome_.largest_budgets[contact.part];
      if (!largest || budget.CombinedMm() > largest->CombinedMm()) largest = budget;
    }
    outcome_.skipped += result.skipped;
    outcome_.frames_without_camera += result.record.LacksCamera() ? 1 : 0;
    for (const core::PictureLoss& loss : result.record.losses) {
      if (loss.reason != core::LossReason::kUnpaired)
        outcome_.pictures_lost[loss.camera] += static_cast<std::int64_t>(loss.count());
      for (const std::string& note : loss_notes_.Add(loss)) Append(note);
    }
  }

  // Of live cameras, while the next frame is judged: a recording's light can't be put right any more.
  void WatchLight(const FrameResult& result) {
    std::vector<recon::BackgroundReference> backgrounds = std::exchange(backgrounds_, {});
    if (!result.camera_frames->taken_at) return;
    if (!light_)
      light_.emplace(setup_.source->rig(), std::move(backgrounds), setup_.segmentation, options_.on_light);
    light_->Offer(result.camera_frames, result.record.masks);
    for (const std::string& note : light_->TakeNotes()) Append(note);
  }

  void FinishLight() {
    if (!light_) return;
    light_->Finish();
    for (const std::string& note : light_->TakeNotes()) Append(note);
    outcome_.light = light_->reports();
    outcome_.light_advice = light_->advice();
  }

  const TrialSetup& setup_;
  const TrialOptions& options_;
  TrialControls& controls_;
  LossNotes loss_notes_;
  KnockWatch knock_watch_;
  std::optional<std::string> knock_advice_;  // of the frame before
  PairWatch pair_watch_;
  PairRecord pair_record_;
  SharedPairVerdicts pairs_;           // the latest
  review::ClashCount new_pair_count_;  // of the verdicts since the frame before
  sessions::SessionWriter writer_;
  std::vector<recon::BackgroundReference> backgrounds_;  // until the first frame
  std::optional<TrialLight> light_;                      // of live cameras
  std::optional<FramePipeline> pipeline_;
  std::optional<OutcomeTracker> tracker_;  // refers to the pipeline's part trees
  tbb::task_group outcome_so_far_;         // adds one frame at a time to tracker and watch
  core::ToolsInUse tools_in_use_;
  ProcedureRecord procedure_;
  Pace pace_;
  std::vector<double> spacing_mm_;
  TrialOutcome outcome_;
  bool is_recording_footage_ = false;
  Clock::time_point footage_from_;
  sessions::SessionClosing closing_;
  core::FrameIndex last_frame_ = 0;
  double last_time_s_ = 0.0;
};

std::string EndNote(const TrialSetup& setup, const FrameRange& range, const std::stop_token& stop) {
  if (stop.stop_requested()) return "stopped by the experimenter";
  if (range.end && setup.source->frame_count() != range.end)
    return fmt::format("ended at frame {} as asked", *range.end);
  return fmt::format("ended with {}", setup.source->WhatEndsIt());
}

}  // namespace

std::filesystem::path FootageFolderOf(const std::filesystem::path& session) {
  std::filesystem::path folder = session;
  return folder.replace_extension(".footage");
}

TrialOutcome RunTrial(const TrialSetup& setup, const TrialOptions& options, TrialControls& controls,
                      std::stop_token stop) {
  RequireInRange(setup, options.frames);
  if (setup.footage) recon::RequireEmptyFolder(FootageFolderOf(options.session));
  Recording recording(setup, options, controls);
  try {
    recording.Run(stop);
  } catch (const core::Error& error) {
    // A stop while the backgrounds were measured ends the trial in order.
    if (error.kind() != core::ErrorKind::kCancelled) recording.EndAfter(error);
  } catch (...) {
    if (!recording.HasFrames()) recording.Abandon();
    throw;
  }
  if (!recording.HasFrames()) {
    recording.Abandon();
    throw core::Error(core::ErrorKind::kCancelled,
                      "the trial was stopped before its first frame; nothing was recorded");
  }
  try {
    return recording.Finish(EndNote(setup, options.frames, stop));
  } catch (const core::Error& error) {
    recording.ThrowWithWhatIsKept(error);
  }
}

}  // namespace elbowroom::control
