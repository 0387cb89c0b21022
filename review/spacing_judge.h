// One recorded frame judged against parts of layouts at all values of a spacing: what the study of all frames
// is made of.
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

// A part that is asked: its place among those of all layouts.
using AskedIndex = std::size_t;

// What is known of one part in one frame.
struct PartOverSpacing {
  std::vector<StepAnswer> steps;
  std::vector<TouchedSpacings> touched;  // certain, but not all there are
};

enum class Freedom { kTouched, kFree, kUndecided };

class SpacingJudge {
 public:
  // `layouts` and `options` must outlive it.
  SpacingJudge(std::span<const StudyLayout> layouts, const SpacingStudyOptions& options);
  ~SpacingJudge();
  SpacingJudge(const SpacingJudge&) = delete;
  SpacingJudge& operator=(const SpacingJudge&) = delete;

  [[nodiscard]] const std::vector<double>& steps_mm() const { return steps_mm_; }
  [[nodiscard]] std::size_t part_count() const { return trees_.size(); }
  [[nodiscard]] bool Moves(AskedIndex part) const { return moves_[part]; }

  // The answers for all parts that are asked. `so_far` has what other frames have shown of them at each step:
  // what can change neither a verdict nor a largest depth nor a least distance isn't asked. Thread: any.
  [[nodiscard]] std::vector<PartOverSpacing> AskSteps(const StudyFrame& frame,
                                                      std::span<const StudyStep> so_far) const;

  // Whether the part is in the hull at this value. Thread: any.
  [[nodiscard]] Freedom AskFreedom(const StudyFrame& frame, AskedIndex part, double spacing_mm,
                                   StudyCount* count) const;

 private:
  class PartInFrame;
  class InsideOfThreads;
  class WorstErrors;

  // A layout's parts stand one after the other from `first` on.
  struct PlacedLayout {
    const StudyLayout& study;
    core::SpacingPoses poses;
    AskedIndex first = 0;

    // Of the parts that are asked, while the studied spacing has this value.
    [[nodiscard]] std::vector<core::RigidTransform> PosesAt(const StudyFrame& frame, double studied_mm) const;
  };

  // Of all parts that are asked.
  [[nodiscard]] std::vector<core::RigidTransform> PosesAt(const StudyFrame& frame, double studied_mm) const;
  [[nodiscard]] const PlacedLayout& LayoutOf(AskedIndex part) const;
  [[nodiscard]] InsideCells* InsideOf(AskedIndex part) const;
  // What a verdict allows for where no witness points tell.
  [[nodiscard]] double AllowedMm(AskedIndex part, const core::RigidTransform& world_from_part) const;

  std::vector<PlacedLayout> layouts_;
  const SpacingStudyOptions& options_;
  const std::vector<double> steps_mm_;
  std::vector<core::TriangleTree> trees_;
  std::vector<bool> moves_;
  std::unique_ptr<InsideOfThreads> inside_;
  std::unique_ptr<WorstErrors> worst_;
};

}  // namespace elbowroom::review
