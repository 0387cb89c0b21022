#include "app/control/replay/replay_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>
#include <variant>

#include "app/control/pairs/ruled_pairs.h"
#include "app/control/procedure/procedure_record.h"
#include "core/error.h"
#include "core/procedure/step_runs.h"
#include "core/system/file_sync.h"
#include "core/system/utc_time.h"
#include "sessions/archive/footage_check.h"
#include "sessions/row_comparison.h"

namespace elbowroom::control {
namespace {

constexpr const char* kReviewer = "elbowroom replay";

}  // namespace

ReplayRecording::ReplayRecording(const sessions::SessionReader& recorded, const ReplayLayout& layout,
                                 std::span<const core::TriangleTree> part_trees,
                                 const core::SessionHeader& header, std::filesystem::path path,
                                 sessions::UnfinishedSession* file, bool judges_pairs)
    : recorded_(recorded),
      layout_(layout),
      tracker_(recorded.header().trial, part_trees),
      events_(recorded.events()),
      next_event_(events_.begin()),
      findings_(recorded.findings()),
      pair_record_(layout.layout()),
      path_(std::move(path)),
      file_(*file),
      writer_(file_.temporary(), header) {
  outcome_.changes = header.origin->changes;
  if (outcome_.changes.empty()) outcome_.compared.emplace();
  if (judges_pairs) pair_judge_.emplace(layout.layout(), RuledPairsOf(layout.layout()));
}

void ReplayRecording::Add(const ReplayedFrame& frame) {
  const core::FrameRecord& recorded = frame.recorded;
  const FrameResult& result = *frame.result;
  TakeEvents(recorded.frame, recorded.time_s);
  JudgePairs(result.record);
  tracker_.Add(result, tools_in_use_.names());
  writer_.Append(result.record);
  if (outcome_.frames++ == 0) checked_.begin_s = recorded.time_s;
  checked_.end_s = recorded.time_s;
  last_frame_ = recorded.frame;
  segmenting_ += frame.segmenting;
  for (const core::PartContact& contact : result.record.contacts)
    outcome_.contact_rows += contact.verdict == core::Verdict::kContact ? 1 : 0;
  outcome_.skipped += result.skipped;
  if (outcome_.compared) Compare(recorded, result.record);
}

ReplayOutcome ReplayRecording::Finish(bool to_the_end) {
  for (; next_event_ != events_.end(); ++next_event_)
    if (to_the_end || IsOfParticipant(next_event_->what)) TakeEvent(*next_event_);
  TellMissing();
  core::SessionOutcome outcome = tracker_.Outcome();
  MatchFindings(findings_, layout_.layout(), &outcome);
  sessions::SessionClosing closing =
      TakeOverReview(findings_, layout_.layout(), checked_, outcome, kReviewer, core::NowUtc());
  closing.footage = Footage();
  outcome_.outcome = outcome;
  outcome_.absent = closing.absent;
  writer_.Finish(std::move(outcome), std::move(closing));
  if (writer_.state() != sessions::RecordingState::kInFile || writer_.path() != file_.temporary())
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("the new session couldn't be written as '{}'; leave its folder alone, and "
                                  "try again",
                                  file_.temporary().string()));
  file_.PutInPlace();
  return std::move(outcome_);
}

// The events up to the frame. Those before the first frame of the replay aren't in it, but for what the
// participant said; the tools in use and the step under way are marked there.
void ReplayRecording::TakeEvents(core::FrameIndex frame, double time_s) {
  for (; next_event_ != events_.end() && next_event_->frame <= frame; ++next_event_) {
    tools_in_use_.Take(*next_event_);
    const bool is_before = outcome_.frames == 0 && next_event_->frame < frame;
    if (!is_before) TakeEvent(*next_event_);
    if (!is_before) continue;
    has_earlier_ = true;
    if (IsOfParticipant(next_event_->what))
      writer_.Append(core::SessionEvent{frame, time_s, next_event_->what});
  }
  if (!std::exchange(has_earlier_, false)) return;
  for (const std::string& tool : tools_in_use_.names())
    writer_.Append(core::SessionEvent{frame, time_s, core::ToolMarked{tool, true}});
  MarkStepUnderWay(frame, time_s);
}

// Those that began before the frame, and don't end with it.
void ReplayRecording::MarkStepUnderWay(core::FrameIndex frame, double time_s) {
  const auto here =
      std::ranges::find_if(events_, [&](const core::SessionEvent& event) { return event.frame > frame; });
  for (const core::StepRun& run : core::StepRunsOf(std::span(events_.begin(), here)))
    if (run.begin_frame < frame && !run.end_frame)
      writer_.Append(core::SessionEvent{frame, time_s, core::StepMarked{run.step, true}});
}

void ReplayRecording::TakeEvent(const core::SessionEvent& event) {
  if (pair_judge_ && IsPairNote(event)) return;
  writer_.Append(layout_.EventFrom(event));
}

void ReplayRecording::JudgePairs(const core::FrameRecord& record) {
  if (!pair_judge_ || pair_judge_->pairs().empty() || judged_mm_ == record.spacing_mm) return;
  judged_mm_ = record.spacing_mm;
  const SharedPairVerdicts verdicts = pair_judge_->Judge({record.frame, record.time_s, record.spacing_mm});
  for (core::SessionEvent& note : pair_record_.Add(*verdicts)) writer_.Append(std::move(note));
}

void ReplayRecording::Compare(const core::FrameRecord& recorded, const core::FrameRecord& replayed) {
  const sessions::RowComparison rows = sessions::CompareRows(recorded, replayed);
  ++outcome_.compared->frames;
  outcome_.compared->rows += rows.rows;
  if (rows.are_equal) return;
  if (outcome_.compared->frames_that_differ++ == 0) outcome_.compared->first_that_differs = recorded.frame;
}

void ReplayRecording::TellMissing() {
  if (segmenting_.missing == 0) return;
  writer_.Append(core::SessionEvent{
      last_frame_, checked_.end_s,
      core::Note{fmt::format("segmented again: {} pictures that were judged aren't in the footage; their "
                             "frames lack that camera",
                             segmenting_.missing)}});
}

// The recording's footage, as seen from the new session.
std::vector<core::FootageFile> ReplayRecording::Footage() const {
  std::vector<core::FootageFile> files = recorded_.footage();
  const std::filesystem::path folder = std::filesystem::absolute(core::FolderOf(path_)).lexically_normal();
  for (core::FootageFile& file : files)
    file.file = std::filesystem::absolute(sessions::FootagePath(recorded_.path(), file))
                    .lexically_normal()
                    .lexically_proximate(folder)
                    .string();
  return files;
}

}  // namespace elbowroom::control
