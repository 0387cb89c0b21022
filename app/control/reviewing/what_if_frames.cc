#include "app/control/reviewing/what_if_frames.h"

#include <algorithm>

#include "app/control/replay/replay_changes.h"
#include "app/control/reviewing/what_if_judging.h"
#include "app/control/trial_rules.h"

namespace elbowroom::control {
namespace {

constexpr std::size_t kMostKept = 32;

}  // namespace

WhatIfFrames::WhatIfFrames(std::shared_ptr<const ReviewedSession> session)
    : session_(std::move(session)),
      rebuilder_(session_->header(), session_->path()),
      motion_(MotionOf(*session_)) {}

SharedFrameResult WhatIfFrames::At(std::size_t position, const HeldGaps& held_mm) {
  const SharedFrameResult recorded = Recorded(position);
  return held_mm.empty() ? recorded : Judged(recorded, position, held_mm);
}

SharedFrameResult WhatIfFrames::Recorded(std::size_t position) {
  const auto known = std::ranges::find(kept_, position, &decltype(kept_)::value_type::first);
  if (known != kept_.end()) {
    std::rotate(kept_.begin(), known, std::next(known));
    return kept_.front().second;
  }
  const SharedHull last = kept_.empty() ? nullptr : kept_.front().second->hull;
  SharedFrameResult result =
      rebuilder_.Rebuild(session_->ReadFrame(session_->frames()[position].frame), last);
  kept_.emplace_front(position, result);
  if (kept_.size() > kMostKept) kept_.pop_back();
  return result;
}

SharedFrameResult WhatIfFrames::Judged(const SharedFrameResult& recorded, std::size_t position,
                                       const HeldGaps& held_mm) {
  const core::SessionHeader& header = session_->header();
  const ReplayLayout layout(header.layout, {.held_mm = held_mm});
  auto result = std::make_shared<FrameResult>();
  result->record = recorded->record;
  result->record.contacts.clear();
  result->record.spacing_mm = layout.SpacingsFrom(recorded->record.spacing_mm);
  result->hull = recorded->hull;
  result->layout = recorded->layout;
  result->world_from_parts =
      core::WithMotions(rebuilder_.poses().At(result->record.spacing_mm), result->record.rest_from_parts);
  FrameJudge::KnownAnswers known(header.layout.parts.size(), nullptr);
  for (core::PartIndex i = 0; i < known.size(); ++i)
    if (result->world_from_parts[i] == recorded->world_from_parts[i])
      known[i] = &recorded->record.contacts[i];
  if (motion_.CountsMotion() && std::ranges::find(known, nullptr) != known.end()) {
    // The errors belong to the very hull that they were found with.
    MotionFrame motion = motion_.Load(position);
    result->hull = std::move(motion.hull);
    result->skew_errors = std::move(motion.skew_errors);
  }
  if (!judge_) judge_.emplace(header.layout, ReviewOptionsOf(header.trial, header.rig, header.rig_quality));
  judge_->JudgeOthers(known, result.get());
  return result;
}

}  // namespace elbowroom::control
