#include "app/control/reviewing/needed_gap.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "app/control/reviewing/what_if_judging.h"
#include "app/control/trial_rules.h"
#include "core/error.h"
#include "review/spacing_study.h"

namespace elbowroom::control {
namespace {

review::SpacingStudyOptions StudyOf(const core::SessionHeader& header, const std::string& spacing) {
  review::SpacingStudyOptions options;
  options.spacing = core::RequireSpacing(header.layout, spacing);
  const core::Spacing& studied = header.layout.spacings[options.spacing];
  options.from_mm = studied.min_mm;
  options.to_mm = studied.max_mm;
  options.step_mm = std::max(kNeededGapStepMm, (studied.max_mm - studied.min_mm) / 100.0);
  options.review = ReviewOptionsOf(header.trial, header.rig, header.rig_quality);
  return options;
}

}  // namespace

NeededGap FindNeededGap(const ReviewedSession& session, const std::string& spacing,
                        const core::Progress& progress, const std::stop_token& stop) {
  const core::SessionHeader& header = session.header();
  const review::SpacingStudyOptions options = StudyOf(header, spacing);
  RecordedMotion motion = MotionOf(session);
  const std::vector<std::size_t> positions = session.PositionsWithAllCameras();
  if (positions.empty())
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("session '{}' has no frames with all cameras; record a trial first",
                                  session.path().string()));
  const auto load = [&](std::size_t i) {
    MotionFrame frame = motion.Load(positions[i]);
    return review::StudyFrame{frame.record.frame, std::move(frame.hull), std::move(frame.record.spacing_mm),
                              std::move(frame.skew_errors)};
  };
  const review::SpacingStudy study =
      review::StudySpacing(header.layout, {positions.size(), load}, options, progress, stop);
  const review::SpacingCurve& curve = study.curves.front();
  NeededGap needed{curve.largest_touched_mm, curve.smallest_free_mm, std::nullopt};
  if (header.trial.required_clearance_mm > 0.0) needed.clear_mm = review::SmallestClearMm(curve, study.moved);
  return needed;
}

}  // namespace elbowroom::control
