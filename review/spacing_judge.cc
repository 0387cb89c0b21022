#include "review/spacing_judge.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "core/infinity.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "review/contacts.h"

namespace elbowroom::review {
namespace {

using core::kInfinity;
using Eigen::Vector3d;
using recon::BallAnswer;

// Touching is told from free by clearances whose bounds are as close as the spacing's tolerance divided by
// these, one after the other until the bounds tell.
constexpr std::array kFiner = {4.0, 32.0, 256.0};
// Rounding of a ray's crossings, by which touched stretches are shortened at both ends.
constexpr double kCrossingRoundingMm = 1e-6;

}  // namespace

bool IsIn(std::span<const TouchedSpacings> touched, double spacing_mm) {
  return std::ranges::any_of(touched, [&](const TouchedSpacings& stretch) {
    return stretch.from_mm <= spacing_mm && spacing_mm <= stretch.to_mm;
  });
}

// One part in one frame, asked at one value of the spacing after the other, downwards from the largest. What
// one value shows is used at those below.
class SpacingJudge::PartInFrame {
 public:
  PartInFrame(const SpacingJudge& judge, const StudyFrame& frame, core::PartIndex part,
              const Vector3d& motion_in_world)
      : judge_(judge),
        options_(judge.options_),
        review_(ReviewOf(judge.options_.review, frame)),
        hull_(*frame.hull),
        part_(part),
        tree_(judge.trees_[part]),
        motion_(motion_in_world) {
    known_.steps.resize(judge.steps_mm_.size());
  }

  [[nodiscard]] PartOverSpacing TakeAnswers() { return std::move(known_); }

  void AskStep(std::size_t step, const core::RigidTransform& world_from_part, const PartAtSpacing& so_far,
               std::span<const StudyStep> all_so_far) {
    StepAnswer& answer = known_.steps[step];
    if (step + 1 < known_.steps.size() && !judge_.moves_[part_]) {
      answer = known_.steps[step + 1];
      answer.was_asked = false;
      answer.queries = 0;
      return;
    }
    const double spacing_mm = judge_.steps_mm_[step];
    if (IsIn(known_.touched, spacing_mm)) {
      Touch(&answer);
    } else {
      SetLower(step, &answer);
      if (IsSettled(world_from_part, so_far, &answer)) return;
      AskBalls(step, world_from_part, all_so_far, &answer);
      if (answer.lower_mm > 0.0 && IsSettled(world_from_part, so_far, &answer)) return;
      Ask(spacing_mm, world_from_part, EnoughMm(so_far, AllowedMm(world_from_part)),
          options_.review.tolerance_mm, &answer);
    }
    if (answer.verdict != core::Verdict::kContact) return;
    answer.was_asked = true;
    answer.depth_mm = FindDeeper(hull_, tree_, world_from_part, options_.review.contacts, so_far.deepest_mm,
                                 &answer.queries)
                          .value_or(0.0);
  }

  // Touched, free, or so close that even the narrowest bounds don't tell.
  [[nodiscard]] Freedom AskFreedom(double spacing_mm, const core::RigidTransform& world_from_part,
                                   StudyCount* count) {
    for (const double finer : kFiner) {
      const double tolerance_mm = options_.tolerance_mm / finer;
      StepAnswer answer;
      Ask(spacing_mm, world_from_part, tolerance_mm, tolerance_mm, &answer);
      ++count->asked;
      count->queries += answer.queries;
      if (answer.verdict == core::Verdict::kContact) return Freedom::kTouched;
      if (answer.lower_mm > 0.0) return Freedom::kFree;
    }
    return Freedom::kUndecided;
  }

 private:
  // Distances from here on can change neither a verdict nor the least distance so far.
  [[nodiscard]] double EnoughMm(const PartAtSpacing& so_far, double allowed_mm) const {
    return std::max(options_.review.required_clearance_mm + allowed_mm, so_far.upper_mm);
  }

  [[nodiscard]] static PartReviewOptions ReviewOf(PartReviewOptions review, const StudyFrame& frame) {
    if (frame.skew_errors && !frame.skew_errors->is_still()) review.skew_errors = frame.skew_errors;
    return review;
  }

  // The worst errors of a rig are those of hundreds of frames, the worst skew is a frame's own.
  [[nodiscard]] double AllowedMm(const core::RigidTransform& world_from_part) const {
    if (!review_.skew_errors) return judge_.AllowedMm(part_, world_from_part);
    return review_.WorstBudget(hull_, core::BoxAround(tree_, world_from_part))->ExpandedMm();
  }

  [[nodiscard]] core::Verdict VerdictOf(const Clearance& clearance, double allowed_mm,
                                        const core::RigidTransform& world_from_part) const {
    const core::Verdict verdict = review_.VerdictOf(clearance, allowed_mm);
    if (verdict != core::Verdict::kClear || !review_.skew_errors) return verdict;
    const auto budget = review_.WorstBudget(hull_, core::BoxAround(tree_, world_from_part));
    return review_.StaysClear(hull_, tree_, world_from_part, budget) ? verdict : core::Verdict::kUndecided;
  }

  void Touch(StepAnswer* answer) const {
    answer->verdict = core::Verdict::kContact;
    answer->lower_mm = 0.0;
    answer->upper_mm = tree_.mesh().deviation_mm;
  }

  // What the step above leaves of its lower bound.
  void SetLower(std::size_t step, StepAnswer* answer) const {
    if (step + 1 == known_.steps.size()) return;
    const double moved_mm = judge_.steps_mm_[step + 1] - judge_.steps_mm_[step];
    answer->lower_mm = std::max(known_.steps[step + 1].lower_mm - moved_mm, 0.0);
  }

  // Whether a lower bound, and the distance here of the last search's witness points, leave nothing to ask.
  [[nodiscard]] bool IsSettled(const core::RigidTransform& world_from_part, const PartAtSpacing& so_far,
                               StepAnswer* answer) const {
    if (!(answer->lower_mm > 0.0)) return false;
    Clearance known;
    known.interval.lower_mm = answer->lower_mm;
    if (hint_) {
      const Vector3d witness = world_from_part * hint_->witness_part_in_part;
      known.interval.upper_mm = (witness - hint_->witness_hull_in_world).norm() + tree_.mesh().deviation_mm;
    }
    const double allowed_mm = AllowedMm(world_from_part);
    const core::Verdict verdict = Judge(known, options_.review.required_clearance_mm, allowed_mm);
    if (verdict == core::Verdict::kUndecided || answer->lower_mm < so_far.upper_mm) return false;
    answer->verdict = VerdictOf(known, allowed_mm, world_from_part);
    return true;
  }

  // Tries to settle this step, and all steps below, by one query of a ball around the part: large enough to
  // allow for the part's motion in between. If that fails, half as many steps, and so on.
  void AskBalls(std::size_t step, const core::RigidTransform& world_from_part,
                std::span<const StudyStep> so_far, StepAnswer* answer) const {
    if (tree_.nodes().empty()) return;
    answer->was_asked = true;
    const core::Ball& ball = tree_.nodes()[0].ball;
    const double allowed_mm = AllowedMm(world_from_part);
    for (std::size_t span = step + 1; span > 0; span /= 2) {
      double far_mm = 0.0;
      for (std::size_t i = 0; i < span; ++i)
        far_mm = std::max(far_mm, EnoughMm(so_far[step - i].parts[part_], allowed_mm) +
                                      (judge_.steps_mm_[step] - judge_.steps_mm_[step - i]));
      if (!std::isfinite(far_mm) || !(far_mm > 0.0)) continue;
      ++answer->queries;
      const double reach_mm = ball.radius_mm + tree_.mesh().deviation_mm + far_mm;
      if (hull_.Classify(world_from_part * ball.center, reach_mm) != BallAnswer::kOutside) continue;
      answer->lower_mm = std::max(answer->lower_mm, far_mm);
      return;
    }
  }

  // At the witness points, if there are any: as ReviewPart does.
  [[nodiscard]] double AllowedAt(const Clearance& clearance,
                                 const core::RigidTransform& world_from_part) const {
    if (!clearance.has_witnesses || clearance.meets) return AllowedMm(world_from_part);
    const auto budget = review_.BudgetAt(hull_, clearance.interval.witness_hull_in_world_mm,
                                         clearance.interval.witness_part_in_world_mm);
    return budget ? budget->ExpandedMm() : AllowedMm(world_from_part);
  }

  // Contact is looked for only where no lower bound excludes it.
  void Ask(double spacing_mm, const core::RigidTransform& world_from_part, double enough_mm,
           double tolerance_mm, StepAnswer* answer) {
    answer->was_asked = true;
    if (!(answer->lower_mm > 0.0)) {
      const PartTouch touch =
          FindTouch(hull_, tree_, world_from_part, options_.review.contacts, judge_.InsideOf(part_));
      answer->queries += touch.queries;
      if (touch.surface_in_world_mm) Follow(spacing_mm, *touch.surface_in_world_mm);
      if (touch.touches) return Touch(answer);
    }
    if (enough_mm <= 0.0) return;
    ClearanceOptions clearance_options;
    clearance_options.tolerance_mm = tolerance_mm;
    clearance_options.enough_mm = enough_mm;
    const Clearance clearance = FindClearance(hull_, tree_, world_from_part, clearance_options, hint_);
    answer->queries += clearance.queries;
    answer->lower_mm = std::max(answer->lower_mm, clearance.interval.lower_mm);
    answer->upper_mm = clearance.interval.upper_mm;
    answer->verdict = VerdictOf(clearance, AllowedAt(clearance, world_from_part), world_from_part);
    if (clearance.has_witnesses)
      hint_ = ClearanceHint{world_from_part.Inverse() * clearance.interval.witness_part_in_world_mm,
                            clearance.interval.witness_hull_in_world_mm};
  }

  // Adds the values of the spacing at which this point of the part's surface is in the hull: from the step
  // above to the least one, for at larger ones the part was asked before.
  void Follow(double spacing_mm, const Vector3d& x_in_world) {
    if (!judge_.moves_[part_]) return;
    const std::vector<double>& steps_mm = judge_.steps_mm_;
    const auto above = std::ranges::upper_bound(steps_mm, spacing_mm);
    const double from_mm = above == steps_mm.end() ? spacing_mm : *above;
    const recon::Ray down{x_in_world + (from_mm - spacing_mm) * motion_, -motion_};
    for (const recon::HullInterval& interval :
         recon::IntervalsInHull(hull_, down, {0.0, from_mm - steps_mm.front()})) {
      const TouchedSpacings touched{from_mm - interval.to_mm + kCrossingRoundingMm,
                                    from_mm - interval.from_mm - kCrossingRoundingMm};
      if (touched.from_mm <= touched.to_mm) known_.touched.push_back(touched);
    }
  }

  const SpacingJudge& judge_;
  const SpacingStudyOptions& options_;
  PartReviewOptions review_;  // with this frame's skew
  const recon::VisualHull& hull_;
  core::PartIndex part_;
  const core::TriangleTree& tree_;
  Vector3d motion_;  // of the part while the spacing grows by 1 mm
  std::optional<ClearanceHint> hint_;
  PartOverSpacing known_;
};

// The insides of all parts, one list a thread. They save work and change no answer.
class SpacingJudge::InsideOfThreads {
 public:
  explicit InsideOfThreads(const std::vector<core::TriangleTree>& parts)
      : cells_([&parts] {
          std::vector<InsideCells> cells;
          for (const core::TriangleTree& part : parts) cells.emplace_back(part);
          return cells;
        }) {}

  [[nodiscard]] InsideCells* Of(core::PartIndex part) { return &cells_.local()[part]; }

 private:
  tbb::enumerable_thread_specific<std::vector<InsideCells>> cells_;
};

// The worst errors near the parts in their poses: hundreds of frames share a few poses.
class SpacingJudge::WorstErrors {
 public:
  WorstErrors(const std::vector<core::TriangleTree>& parts, std::shared_ptr<const recon::HullErrors> errors)
      : parts_(parts), errors_(std::move(errors)) {}

  [[nodiscard]] double Of(core::PartIndex part, const core::RigidTransform& world_from_part) {
    Key key;
    key[0] = static_cast<double>(part);
    Eigen::Map<Vector3d>(key.data() + 1) = world_from_part.translation_mm;
    Eigen::Map<Eigen::Matrix3d>(key.data() + 4) = world_from_part.rotation;
    const std::lock_guard lock(mutex_);
    const auto [at, is_new] = known_mm_.try_emplace(key, 0.0);
    if (is_new) at->second = errors_->WorstIn(core::BoxAround(parts_[part], world_from_part)).ExpandedMm();
    return at->second;
  }

 private:
  using Key = std::array<double, 13>;
  const std::vector<core::TriangleTree>& parts_;
  std::shared_ptr<const recon::HullErrors> errors_;
  std::mutex mutex_;
  std::map<Key, double> known_mm_;
};

SpacingJudge::SpacingJudge(const core::Layout& layout, const SpacingStudyOptions& options)
    : layout_(layout),
      options_(options),
      steps_mm_(options.Steps()),
      inside_(std::make_unique<InsideOfThreads>(trees_)),
      worst_(std::make_unique<WorstErrors>(trees_, options.review.hull_errors)) {
  for (const core::Part& part : layout.parts) trees_.emplace_back(part.mesh);
  // The parts that the spacing moves are those whose poses differ between any two values.
  const auto here = PosesAt(layout.InitialSpacings(), 0.0), there = PosesAt(layout.InitialSpacings(), 1.0);
  for (core::PartIndex i = 0; i < trees_.size(); ++i) moves_.push_back(!(here[i] == there[i]));
}

SpacingJudge::~SpacingJudge() = default;

std::vector<core::RigidTransform> SpacingJudge::PosesAt(std::vector<double> spacing_mm,
                                                        double studied_mm) const {
  spacing_mm[options_.spacing] = studied_mm;
  return core::PosesAt(layout_, spacing_mm);
}

InsideCells* SpacingJudge::InsideOf(core::PartIndex part) const { return inside_->Of(part); }

double SpacingJudge::AllowedMm(core::PartIndex part, const core::RigidTransform& world_from_part) const {
  if (!options_.review.hull_errors) return options_.review.uncertainty_mm;
  return worst_->Of(part, world_from_part);
}

std::vector<PartOverSpacing> SpacingJudge::AskSteps(const StudyFrame& frame,
                                                    std::span<const StudyStep> so_far) const {
  const auto here = PosesAt(frame.spacing_mm, 0.0), there = PosesAt(frame.spacing_mm, 1.0);
  std::vector<PartInFrame> parts;
  for (core::PartIndex i = 0; i < trees_.size(); ++i)
    parts.emplace_back(*this, frame, i, (there[i].translation_mm - here[i].translation_mm).normalized());
  for (std::size_t step = steps_mm_.size(); step-- > 0;) {
    const auto poses = PosesAt(frame.spacing_mm, steps_mm_[step]);
    for (core::PartIndex i = 0; i < trees_.size(); ++i)
      parts[i].AskStep(step, poses[i], so_far[step].parts[i], so_far);
  }
  std::vector<PartOverSpacing> answers;
  for (PartInFrame& part : parts) answers.push_back(part.TakeAnswers());
  return answers;
}

Freedom SpacingJudge::AskFreedom(const StudyFrame& frame, double spacing_mm, StudyCount* count) const {
  const auto here = PosesAt(frame.spacing_mm, 0.0), there = PosesAt(frame.spacing_mm, 1.0);
  const auto poses = PosesAt(frame.spacing_mm, spacing_mm);
  Freedom freedom = Freedom::kFree;
  for (core::PartIndex i = 0; i < trees_.size(); ++i) {
    if (!moves_[i]) continue;
    PartInFrame part(*this, frame, i, (there[i].translation_mm - here[i].translation_mm).normalized());
    const Freedom of_part = part.AskFreedom(spacing_mm, poses[i], count);
    if (of_part == Freedom::kTouched) return of_part;
    if (of_part == Freedom::kUndecided) freedom = of_part;
  }
  return freedom;
}

}  // namespace elbowroom::review
