// One recorded frame judged against a layout at all values of a spacing: what the study of all frames is made
// of.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/ids.h"
#include "core/layout.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/clearance.h"
#include "review/inside_cells.h"
#include "review/spacing_study.h"

namespace elbowroom::review {

// The answer for one part in one frame at one step.
struct StepAnswer {
  core::Verdict verdict = core::Verdict::kClear;
  double depth_mm = 0.0;  // only if it is more than the step's largest so far; else 0
  double lower_mm = 0.0;
  double upper_mm = std::numeric_limits<double>::infinity();
  double beyond_mm = 0.0;  // the ball around the part is at least so far from the hull
  std::int64_t queries = 0;
  bool was_asked = false;
};

// Values of the spacing at which a point of a part's surface is in the hull.
struct TouchedSpacings {
  double from_mm = 0.0;
  double to_mm = 0.0;
  Eigen::Vector3d point_in_part_mm = Eigen::Vector3d::Zero();
};

[[nodiscard]] bool IsIn(std::span<const TouchedSpacings> touched, double spacing_mm);

// What is known of one part in one frame.
struct PartOverSpacing {
  std::vector<StepAnswer> steps;
  std::vector<TouchedSpacings> touched;  // certain, but not all there are
};

enum class Freedom { kTouched, kFree, kUndecided };

class SpacingJudge {
 public:
  // `layout` and `options` must outlive it.
  SpacingJudge(const core::Layout& layout, const SpacingStudyOptions& options);
  ~SpacingJudge();
  SpacingJudge(const SpacingJudge&) = delete;
  SpacingJudge& operator=(const SpacingJudge&) = delete;

  [[nodiscard]] const std::vector<double>& steps_mm() const { return steps_mm_; }
  [[nodiscard]] std::size_t part_count() const { return trees_.size(); }
  [[nodiscard]] bool Moves(core::PartIndex part) const { return moves_[part]; }

  // The answers for all parts. `so_far` has what other frames have shown at each step: what can change
  // neither a verdict nor a largest depth nor a least distance isn't asked. Thread: any.
  [[nodiscard]] std::vector<PartOverSpacing> AskSteps(const StudyFrame& frame,
                                                      std::span<const StudyStep> so_far) const;

  // Whether a moved part is in the hull at this value. Thread: any.
  [[nodiscard]] Freedom AskFreedom(const StudyFrame& frame, double spacing_mm, StudyCount* count) const;

 private:
  class PartInFrame;
  class InsideOfThreads;
  class WorstErrors;

  [[nodiscard]] std::vector<core::RigidTransform> PosesAt(std::vector<double> spacing_mm,
                                                          double studied_mm) const;
  [[nodiscard]] InsideCells* InsideOf(core::PartIndex part) const;
  // What a verdict allows for where no witness points tell.
  [[nodiscard]] double AllowedMm(core::PartIndex part, const core::RigidTransform& world_from_part) const;

  const core::SpacingPoses poses_;
  const SpacingStudyOptions& options_;
  const std::vector<double> steps_mm_;
  std::vector<core::TriangleTree> trees_;
  std::vector<bool> moves_;
  std::unique_ptr<InsideOfThreads> inside_;
  std::unique_ptr<WorstErrors> worst_;
};

}  // namespace elbowroom::review
