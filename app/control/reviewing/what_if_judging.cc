#include "app/control/reviewing/what_if_judging.h"

#include <algorithm>
#include <utility>

#include "app/control/trial_rules.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {
namespace {

// What is known of a frame's parts before it is judged.
// `was`: the parts' poses as recorded.
FrameJudge::KnownAnswers KnownOf(const std::vector<core::RigidTransform>& was,
                                 const WhatIfPiece::Frame& frame, const WhatIfPiece::Frame* before) {
  const FrameResult& result = *frame.result;
  const MotionFrame& recorded = frame.recorded;
  // Motion of contours goes into a verdict, and differs from frame to frame.
  const bool is_like_before = before != nullptr && recorded.hull != nullptr &&
                              before->recorded.hull == recorded.hull && !recorded.skew_errors &&
                              !before->recorded.skew_errors &&
                              before->recorded.record.LacksCamera() == recorded.record.LacksCamera();
  FrameJudge::KnownAnswers known(was.size(), nullptr);
  for (core::PartIndex i = 0; i < known.size(); ++i) {
    const core::RigidTransform& pose = result.world_from_parts[i];
    if (was[i] == pose) {
      known[i] = &recorded.record.contacts[i];
    } else if (is_like_before && before->result->world_from_parts[i] == pose) {
      known[i] = &before->result->record.contacts[i];
    }
  }
  return known;
}

}  // namespace

RecordedMotion MotionOf(const ReviewedSession& session) {
  return {session.header().rig, session.frames(), session.motion_stamps(),
          [&session](core::FrameIndex frame) { return session.ReadFrame(frame); }};
}

std::vector<bool> PartsMoved(const std::vector<core::RigidTransform>& recorded,
                             const std::vector<core::RigidTransform>& held) {
  std::vector<bool> moved;
  for (std::size_t i = 0; i < recorded.size(); ++i) moved.push_back(recorded[i] != held[i]);
  return moved;
}

WhatIfJudging::WhatIfJudging(const ReviewedSession& session, const ReplayLayout& layout)
    : session_(session),
      layout_(layout),
      shared_layout_(std::make_shared<const core::Layout>(layout.layout())),
      poses_(*shared_layout_),
      motion_(MotionOf(session)),
      judges_(layout_.layout(),
              ReviewOptionsOf(session.header().trial, session.header().rig, session.header().rig_quality)) {}

std::shared_ptr<WhatIfPiece> WhatIfJudging::Read(std::size_t first, std::size_t end) {
  auto piece = std::make_shared<WhatIfPiece>();
  for (std::size_t i = first; i < end; ++i) {
    const sessions::FrameSummary& summary = session_.frames()[i];
    WhatIfPiece::Frame frame;
    frame.result = results_.Take();
    FrameResult& result = *frame.result;
    result.record.spacing_mm = layout_.SpacingsFrom(summary.spacing_mm);
    result.world_from_parts = poses_.At(result.record.spacing_mm);
    if (motion_.CountsMotion() || result.world_from_parts != poses_.At(summary.spacing_mm)) {
      frame.recorded = motion_.Load(i);
    } else {
      frame.recorded.record = session_.ReadFrame(summary.frame);
    }
    result.record.frame = summary.frame;
    result.record.time_s = summary.time_s;
    result.record.masks = frame.recorded.record.masks;
    result.record.stamps = frame.recorded.record.stamps;
    result.hull = frame.recorded.hull;
    result.skew_errors = frame.recorded.skew_errors;
    result.layout = shared_layout_;
    piece->frames.push_back(std::move(frame));
  }
  return piece;
}

void WhatIfJudging::Judge(WhatIfPiece* piece) {
  std::unique_ptr<FrameJudge> judge = judges_.Take();
  const WhatIfPiece::Frame* before = nullptr;
  for (WhatIfPiece::Frame& frame : piece->frames) {
    judge->JudgeOthers(KnownOf(poses_.At(frame.recorded.record.spacing_mm), frame, before),
                       frame.result.get());
    before = &frame;
  }
  judges_.PutBack(std::move(judge));
}

}  // namespace elbowroom::control
