#include "app/control/reviewing/what_if.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "app/control/part_reactions.h"
#include "app/control/replay/finding_matches.h"
#include "app/control/reviewing/what_if_judging.h"
#include "app/control/silhouette_pipeline.h"
#include "app/control/stopwatch.h"
#include "app/control/trial_rules.h"
#include "core/procedure/tools_in_use.h"
#include "review/contact_tracker.h"

namespace elbowroom::control {
namespace {

constexpr std::size_t kPiece = 16;  // frames

// Takes the judged frames, in order.
class WhatIfTally {
 public:
  WhatIfTally(const ReviewedSession& session, const WhatIfRequest& request)
      : session_(session),
        request_(request),
        tracker_(TrackerOptionsOf(session.header().trial)),
        tools_(session.events()),
        poses_(session.header().layout) {
    what_if_.held_mm = request.held_mm;
    what_if_.parts.resize(session.header().layout.parts.size());
  }

  void Add(const FrameResult& result, const std::vector<double>& recorded_mm) {
    const core::FrameRecord& record = result.record;
    tracker_.Add({record, result.world_from_parts, tools_.At(record.frame)});
    ++what_if_.frames;
    what_if_.frames_without_camera += record.LacksCamera() ? 1 : 0;
    what_if_.answers += std::ssize(record.contacts);
    what_if_.answers_kept += result.skipped.unchanged_parts;
    TakeMoves(record.spacing_mm, recorded_mm);
    if (!record.LacksCamera())
      for (const core::PartContact& contact : record.contacts) Take(contact, &what_if_.parts[contact.part]);
    if (request_.on_frame) request_.on_frame(result);
  }

  [[nodiscard]] WhatIf Finish() && {
    what_if_.outcome = {tracker_.Episodes(), tracker_.NearMisses(), {}};
    const std::vector<core::Finding> findings = session_.findings();
    MatchFindings(findings, session_.header().layout, &what_if_.outcome);
    for (const core::ContactEpisode& touch : what_if_.outcome.episodes) ++what_if_.parts[touch.part].touches;
    for (const core::NearMiss& miss : what_if_.outcome.near_misses) ++what_if_.parts[miss.part].near_misses;
    for (const core::Finding& finding : findings) {
      if (finding.presence != core::FindingPresence::kHere) continue;
      const bool is_touch = IsAmong(what_if_.outcome.episodes, finding.id);
      const bool is_miss = IsAmong(what_if_.outcome.near_misses, finding.id);
      if (!is_touch && !is_miss) what_if_.vanished.push_back(finding.id);
      if (is_miss && finding.kind == core::FindingKind::kTouch) what_if_.eased.push_back(finding.id);
    }
    return std::move(what_if_);
  }

 private:
  void TakeMoves(const std::vector<double>& held_mm, const std::vector<double>& recorded_mm) {
    if (held_mm == recorded_mm || (held_mm == last_held_mm_ && recorded_mm == last_recorded_mm_)) return;
    last_held_mm_ = held_mm;
    last_recorded_mm_ = recorded_mm;
    const std::vector<bool> moved = PartsMoved(poses_.At(recorded_mm), poses_.At(held_mm));
    for (core::PartIndex i = 0; i < moved.size(); ++i)
      what_if_.parts[i].is_moved = what_if_.parts[i].is_moved || moved[i];
  }

  static void Take(const core::PartContact& contact, WhatIfPart* part) {
    switch (contact.verdict) {
      case core::Verdict::kContact:
        ++part->frames_in_contact;
        break;
      case core::Verdict::kNear:
        ++part->frames_near;
        break;
      case core::Verdict::kUndecided:
        ++part->frames_undecided;
        break;
      case core::Verdict::kClear:
        ++part->frames_clear;
        break;
    }
    if (contact.deepest) part->deepest_mm = std::max(part->deepest_mm, contact.deepest->depth_mm);
    if (!contact.clearance) return;
    const double lower_mm =
        contact.verdict == core::Verdict::kContact ? 0.0 : contact.clearance->interval.lower_mm;
    part->clearance_mm = std::min(part->clearance_mm.value_or(lower_mm), lower_mm);
  }

  static bool IsAmong(const auto& findings, const core::FindingId& id) {
    return std::ranges::any_of(findings, [&](const auto& each) { return each.finding_id == id; });
  }

  const ReviewedSession& session_;
  const WhatIfRequest& request_;
  review::ContactTracker tracker_;
  core::ToolsOfFrames tools_;
  const core::SpacingPoses poses_;
  std::vector<double> last_held_mm_, last_recorded_mm_;
  WhatIf what_if_;
};

void TellProgress(const core::Progress& progress, std::size_t done, std::size_t all) {
  progress.Report(static_cast<std::int64_t>(done), static_cast<std::int64_t>(all),
                  "judging the motion again, frame");
}

void JudgeSeveralAtOnce(const ReviewedSession& session, const ReplayLayout& layout, WhatIfTally* tally,
                        const core::Progress& progress, const std::stop_token& stop) {
  using SharedPiece = std::shared_ptr<WhatIfPiece>;
  const std::size_t all = session.frames().size();
  WhatIfJudging judging(session, layout);
  std::size_t read_to = 0, tallied = 0;
  const auto read = [&](tbb::flow_control& control) -> SharedPiece {
    if (read_to == all || stop.stop_requested()) {
      control.stop();
      return nullptr;
    }
    const std::size_t first = std::exchange(read_to, std::min(read_to + kPiece, all));
    return judging.Read(first, read_to);
  };
  const auto judge = [&](SharedPiece piece) {
    if (!stop.stop_requested()) judging.Judge(piece.get());
    return piece;
  };
  const auto add = [&](const SharedPiece& piece) {
    if (stop.stop_requested()) return;
    for (const WhatIfPiece::Frame& frame : piece->frames)
      tally->Add(*frame.result, frame.recorded.record.spacing_mm);
    tallied += piece->frames.size();
    TellProgress(progress, tallied, all);
  };
  constexpr std::size_t kPiecesAThread = 2;
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  tbb::parallel_pipeline(kPiecesAThread * threads,
                         tbb::make_filter<void, SharedPiece>(tbb::filter_mode::serial_in_order, read) &
                             tbb::make_filter<SharedPiece, SharedPiece>(tbb::filter_mode::parallel, judge) &
                             tbb::make_filter<SharedPiece, void>(tbb::filter_mode::serial_in_order, add));
}

// In order from the session's first frame, since what a part did before moves it now.
void JudgeOneByOne(const ReviewedSession& session, const ReplayLayout& layout, WhatIfTally* tally,
                   const core::Progress& progress, const std::stop_token& stop) {
  const core::SessionHeader& header = session.header();
  SilhouettePipeline pipeline(header.rig, layout.layout(),
                              ReviewOptionsOf(header.trial, header.rig, header.rig_quality));
  for (std::size_t i = 0; i < session.frames().size() && !stop.stop_requested(); ++i) {
    const core::FrameRecord recorded = session.ReadFrame(session.frames()[i].frame);
    const auto result =
        pipeline.Process({recorded.frame, recorded.time_s, *recorded.masks, recorded.stamps, {}},
                         layout.SpacingsFrom(recorded.spacing_mm));
    tally->Add(*result, recorded.spacing_mm);
    TellProgress(progress, i + 1, session.frames().size());
  }
}

}  // namespace

core::Verdict WhatIfPart::verdict() const {
  if (frames_in_contact > 0) return core::Verdict::kContact;
  if (frames_near > 0) return core::Verdict::kNear;
  return frames_undecided > 0 ? core::Verdict::kUndecided : core::Verdict::kClear;
}

double WhatIf::DeepestMm() const {
  double deepest_mm = 0.0;
  for (const WhatIfPart& part : parts) deepest_mm = std::max(deepest_mm, part.deepest_mm);
  return deepest_mm;
}

std::optional<double> WhatIf::ClearanceMm() const {
  std::optional<double> least_mm;
  for (const WhatIfPart& part : parts)
    if (part.clearance_mm) least_mm = std::min(least_mm.value_or(*part.clearance_mm), *part.clearance_mm);
  return least_mm;
}

WhatIf JudgeMotionAt(const ReviewedSession& session, const WhatIfRequest& request,
                     const core::Progress& progress, const std::stop_token& stop) {
  Stopwatch watch;
  const ReplayLayout layout(session.header().layout, {.held_mm = request.held_mm});
  WhatIfTally tally(session, request);
  if (PartReactions(layout.layout()).is_empty()) {
    JudgeSeveralAtOnce(session, layout, &tally, progress, stop);
  } else {
    JudgeOneByOne(session, layout, &tally, progress, stop);
  }
  core::ThrowIfStopped(stop, "judging the motion again");
  WhatIf what_if = std::move(tally).Finish();
  what_if.time_s = watch.LapMs() / 1000.0;
  return what_if;
}

}  // namespace elbowroom::control
