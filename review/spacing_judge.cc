#include "review/spacing_judge.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
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
// A point of a part that is so many of the contacts' resolutions within the hull is on a piece of surface
// whose centre is in the hull, too.
constexpr double kSurelyFound = 1.0;
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
  // Its poses give the direction in which it moves while the spacing grows.
  PartInFrame(const SpacingJudge& judge, const StudyFrame& frame, AskedIndex part,
              const core::RigidTransform& at_0, const core::RigidTransform& at_1)
      : judge_(judge),
        options_(judge.options_),
        review_(ReviewOf(judge.options_.review, frame)),
        hull_(*frame.hull),
        part_(part),
        tree_(judge.trees_[part]),
        motion_((at_1.translation_mm - at_0.translation_mm).normalized()) {
    known_.steps.resize(judge.steps_mm_.size());
  }

  [[nodiscard]] PartOverSpacing TakeAnswers() { return std::move(known_); }

  // What ReviewPart says at this step; bounds of the distance where they may be the least ones.
  void AskStep(std::size_t step, const core::RigidTransform& world_from_part, const PartAtSpacing& so_far,
               std::span<const StudyStep> all_so_far) {
    StepAnswer& answer = known_.steps[step];
    allowed_mm_.reset();
    if (step + 1 < known_.steps.size() && !judge_.moves_[part_]) {
      answer = known_.steps[step + 1];
      answer.was_asked = false;
      answer.queries = 0;
      return;
    }
    const double spacing_mm = judge_.steps_mm_[step];
    if (IsIn(known_.touched, spacing_mm) && IsSurelyFound(spacing_mm, world_from_part, &answer)) {
      Touch(&answer);
    } else {
      SetLower(step, &answer);
      if (IsSettled(world_from_part, so_far, &answer)) return;
      AskBalls(step, world_from_part, all_so_far, &answer);
      if (IsSettled(world_from_part, so_far, &answer)) return;
      AskAll(spacing_mm, world_from_part, so_far, &answer);
    }
    answer.was_asked = true;
    if (answer.verdict != core::Verdict::kContact) return;
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
      const bool touches = LookForTouch(spacing_mm, world_from_part, &answer) ||
                           Narrow(world_from_part, tolerance_mm, tolerance_mm, &answer);
      ++count->asked;
      count->queries += answer.queries;
      if (touches) return Freedom::kTouched;
      if (answer.lower_mm > 0.0) return Freedom::kFree;
    }
    return Freedom::kUndecided;
  }

 private:
  [[nodiscard]] static PartReviewOptions ReviewOf(PartReviewOptions review, const StudyFrame& frame) {
    review.skew_errors = frame.skew_errors;
    return review;
  }

  // The worst errors of a rig are those of hundreds of frames, the worst skew is a frame's own.
  [[nodiscard]] double AllowedMm(const core::RigidTransform& world_from_part) {
    if (!allowed_mm_) {
      allowed_mm_ = review_.skew_errors
                        ? review_.WorstBudget(hull_, core::BoxAround(tree_, world_from_part))->ExpandedMm()
                        : judge_.AllowedMm(part_, world_from_part);
    }
    return *allowed_mm_;
  }

  [[nodiscard]] bool AsksClearance() const { return review_.required_clearance_mm > 0.0; }

  // Whether what a verdict allows for hangs on the witness points of its search.
  [[nodiscard]] bool HasBudget() const {
    return review_.hull_errors || (review_.skew_errors && !review_.skew_errors->is_still());
  }

  // ReviewPart's search for a clearance may end with a lower bound so much smaller than the distance, or an
  // upper bound so much larger.
  [[nodiscard]] double SlackMm() const { return review_.tolerance_mm + 2.0 * tree_.mesh().deviation_mm; }

  // The verdict of a part that is clear of the ball with which its search would begin.
  [[nodiscard]] core::Verdict VerdictBeyondBall(const core::RigidTransform& world_from_part) const {
    const core::Verdict verdict = review_.VerdictOf(core::Verdict::kClear);
    if (verdict != core::Verdict::kClear || !review_.skew_errors) return verdict;
    const auto budget = review_.WorstBudget(hull_, core::BoxAround(tree_, world_from_part));
    return review_.StaysClear(hull_, tree_, world_from_part, budget) ? verdict : core::Verdict::kUndecided;
  }

  void Touch(StepAnswer* answer) const {
    answer->verdict = review_.VerdictOf(core::Verdict::kContact);
    answer->lower_mm = 0.0;
    answer->upper_mm = tree_.mesh().deviation_mm;
  }

  // What the step above leaves of its lower bounds.
  void SetLower(std::size_t step, StepAnswer* answer) const {
    if (step + 1 == known_.steps.size()) return;
    const double moved_mm = judge_.steps_mm_[step + 1] - judge_.steps_mm_[step];
    answer->lower_mm = std::max(known_.steps[step + 1].lower_mm - moved_mm, 0.0);
    answer->beyond_mm = std::max(known_.steps[step + 1].beyond_mm - moved_mm, 0.0);
  }

  // ReviewPart's verdict, if what is known gives it without a search: `lower_mm` is a lower bound of the
  // distance, `beyond_mm` one of that of the ball around the part.
  [[nodiscard]] std::optional<core::Verdict> KnownVerdict(const core::RigidTransform& world_from_part,
                                                          const StepAnswer& answer) {
    if (!AsksClearance()) return review_.VerdictOf(core::Verdict::kClear);
    const double allowed_mm = AllowedMm(world_from_part);
    if (answer.beyond_mm >= review_.EnoughMm(allowed_mm)) return VerdictBeyondBall(world_from_part);
    if (HasBudget()) return std::nullopt;
    const double clear_mm = review_.required_clearance_mm + allowed_mm + SlackMm();
    if (answer.lower_mm >= clear_mm) return review_.VerdictOf(core::Verdict::kClear);
    // Where no lower bound tells, the search may find that they meet.
    const double near_mm = review_.required_clearance_mm - allowed_mm - SlackMm();
    if (answer.lower_mm > 0.0 && UpperByHint(world_from_part) < near_mm)
      return review_.VerdictOf(core::Verdict::kNear);
    return std::nullopt;
  }

  // The distance here of the last search's witness points.
  [[nodiscard]] double UpperByHint(const core::RigidTransform& world_from_part) const {
    if (!hint_) return kInfinity;
    const Vector3d witness = world_from_part * hint_->witness_part_in_part;
    return (witness - hint_->witness_hull_in_world).norm() + tree_.mesh().deviation_mm;
  }

  // Whether a lower bound, and the distance here of the last search's witness points, leave nothing to ask.
  [[nodiscard]] bool IsSettled(const core::RigidTransform& world_from_part, const PartAtSpacing& so_far,
                               StepAnswer* answer) {
    if (!(answer->lower_mm > 0.0) || answer->lower_mm < so_far.upper_mm) return false;
    const auto verdict = KnownVerdict(world_from_part, *answer);
    if (verdict) answer->verdict = *verdict;
    return verdict.has_value();
  }

  // Tries to settle this step, and all steps below, by one query of a ball around the part: large enough to
  // allow for the part's motion in between. If that fails, half as many steps, and so on.
  void AskBalls(std::size_t step, const core::RigidTransform& world_from_part,
                std::span<const StudyStep> so_far, StepAnswer* answer) {
    if (tree_.nodes().empty()) return;
    answer->was_asked = true;
    const core::Ball& ball = tree_.nodes()[0].ball;
    const double enough_mm = AsksClearance() ? review_.EnoughMm(AllowedMm(world_from_part)) : 0.0;
    for (std::size_t span = step + 1; span > 0; span /= 2) {
      double far_mm = 0.0;
      for (std::size_t i = 0; i < span; ++i)
        far_mm = std::max(far_mm, std::max(enough_mm, so_far[step - i].parts[part_].upper_mm) +
                                      (judge_.steps_mm_[step] - judge_.steps_mm_[step - i]));
      if (!std::isfinite(far_mm) || !(far_mm > 0.0)) continue;
      ++answer->queries;
      const double reach_mm = ball.radius_mm + tree_.mesh().deviation_mm + far_mm;
      if (hull_.Classify(world_from_part * ball.center, reach_mm) != BallAnswer::kOutside) continue;
      answer->beyond_mm = std::max(answer->beyond_mm, far_mm);
      answer->lower_mm = std::max(answer->lower_mm, far_mm);
      return;
    }
  }

  // A touch, the verdict by ReviewPart's own search, and the distance.
  void AskAll(double spacing_mm, const core::RigidTransform& world_from_part, const PartAtSpacing& so_far,
              StepAnswer* answer) {
    if (LookForTouch(spacing_mm, world_from_part, answer)) return Touch(answer);
    const auto known = KnownVerdict(world_from_part, *answer);
    if (known) {
      answer->verdict = *known;
    } else {
      const ReviewedClearance reviewed = ReviewClearance(hull_, tree_, world_from_part, review_);
      answer->queries += reviewed.clearance.queries;
      answer->verdict = reviewed.verdict;
      TakeBounds(reviewed.clearance.interval, reviewed.clearance.has_witnesses, world_from_part, answer);
      if (reviewed.verdict == core::Verdict::kContact) return Touch(answer);
    }
    // A distance from here on can't be the least one.
    const bool is_narrow = answer->upper_mm - answer->lower_mm <= SlackMm();
    if (is_narrow || answer->lower_mm >= so_far.upper_mm) return;
    (void)Narrow(world_from_part, so_far.upper_mm, review_.tolerance_mm, answer);
  }

  void TakeBounds(const core::ClearanceInterval& interval, bool has_witnesses,
                  const core::RigidTransform& world_from_part, StepAnswer* answer) {
    answer->lower_mm = std::max(answer->lower_mm, interval.lower_mm);
    answer->upper_mm = std::min(answer->upper_mm, interval.upper_mm);
    if (has_witnesses)
      hint_ = ClearanceHint{world_from_part.Inverse() * interval.witness_part_in_world_mm,
                            interval.witness_hull_in_world_mm};
  }

  // Bounds of the distance, as far as `enough_mm`. True: hull and part meet.
  bool Narrow(const core::RigidTransform& world_from_part, double enough_mm, double tolerance_mm,
              StepAnswer* answer) {
    if (!(enough_mm > 0.0)) return false;
    ClearanceOptions clearance_options;
    clearance_options.tolerance_mm = tolerance_mm;
    clearance_options.enough_mm = enough_mm;
    const Clearance clearance = FindClearance(hull_, tree_, world_from_part, clearance_options, hint_);
    answer->queries += clearance.queries;
    TakeBounds(clearance.interval, clearance.has_witnesses, world_from_part, answer);
    return clearance.meets;
  }

  // Contact is looked for only where no lower bound excludes it.
  [[nodiscard]] bool LookForTouch(double spacing_mm, const core::RigidTransform& world_from_part,
                                  StepAnswer* answer) {
    if (answer->lower_mm > 0.0) return false;
    const PartTouch touch =
        FindTouch(hull_, tree_, world_from_part, options_.review.contacts, judge_.InsideOf(part_));
    answer->queries += touch.queries;
    if (touch.surface_in_world_mm) Follow(spacing_mm, *touch.surface_in_world_mm, world_from_part);
    return touch.touches;
  }

  // Whether a followed point is so far within the hull here that FindContacts can't miss it.
  [[nodiscard]] bool IsSurelyFound(double spacing_mm, const core::RigidTransform& world_from_part,
                                   StepAnswer* answer) const {
    const double reach_mm =
        kSurelyFound * ContactResolutionMm(hull_, tree_, world_from_part, options_.review.contacts);
    return std::ranges::any_of(known_.touched, [&](const TouchedSpacings& touched) {
      if (!IsIn({&touched, 1}, spacing_mm)) return false;
      ++answer->queries;
      return hull_.Classify(world_from_part * touched.point_in_part_mm, reach_mm) == BallAnswer::kInside;
    });
  }

  // Adds the values of the spacing at which this point of the part's surface is in the hull: from the step
  // above to the least one, for at larger ones the part was asked before.
  void Follow(double spacing_mm, const Vector3d& x_in_world, const core::RigidTransform& world_from_part) {
    if (!judge_.moves_[part_]) return;
    const std::vector<double>& steps_mm = judge_.steps_mm_;
    const auto above = std::ranges::upper_bound(steps_mm, spacing_mm);
    const double from_mm = above == steps_mm.end() ? spacing_mm : *above;
    const recon::Ray down{x_in_world + (from_mm - spacing_mm) * motion_, -motion_};
    for (const recon::HullInterval& interval :
         recon::IntervalsInHull(hull_, down, {0.0, from_mm - steps_mm.front()})) {
      const TouchedSpacings touched{from_mm - interval.to_mm + kCrossingRoundingMm,
                                    from_mm - interval.from_mm - kCrossingRoundingMm,
                                    world_from_part.Inverse() * x_in_world};
      if (touched.from_mm <= touched.to_mm) known_.touched.push_back(touched);
    }
  }

  const SpacingJudge& judge_;
  const SpacingStudyOptions& options_;
  PartReviewOptions review_;  // with this frame's skew
  const recon::VisualHull& hull_;
  AskedIndex part_;
  const core::TriangleTree& tree_;
  Vector3d motion_;  // of the part while the spacing grows by 1 mm
  std::optional<ClearanceHint> hint_;
  std::optional<double> allowed_mm_;  // at this step
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

  [[nodiscard]] InsideCells* Of(AskedIndex part) { return &cells_.local()[part]; }

 private:
  tbb::enumerable_thread_specific<std::vector<InsideCells>> cells_;
};

// The worst errors near the parts in their poses: hundreds of frames share a few poses.
class SpacingJudge::WorstErrors {
 public:
  WorstErrors(const std::vector<core::TriangleTree>& parts, std::shared_ptr<const recon::HullErrors> errors)
      : parts_(parts), errors_(std::move(errors)) {}

  [[nodiscard]] double Of(AskedIndex part, const core::RigidTransform& world_from_part) {
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

SpacingJudge::SpacingJudge(std::span<const StudyLayout> layouts, const SpacingStudyOptions& options)
    : options_(options),
      steps_mm_(options.Steps()),
      inside_(std::make_unique<InsideOfThreads>(trees_)),
      worst_(std::make_unique<WorstErrors>(trees_, options.review.hull_errors)) {
  for (const StudyLayout& study : layouts) {
    layouts_.push_back({study, core::SpacingPoses(*study.layout), trees_.size()});
    const std::vector<core::PartIndex> moved = PartsMovedBy(*study.layout, study.spacing);
    for (const core::PartIndex part : study.parts) {
      trees_.emplace_back(study.layout->parts.at(part).mesh);
      moves_.push_back(std::ranges::binary_search(moved, part));
    }
  }
}

SpacingJudge::~SpacingJudge() = default;

std::vector<core::RigidTransform> SpacingJudge::PlacedLayout::PosesAt(const StudyFrame& frame,
                                                                      double studied_mm) const {
  std::vector<double> spacing_mm =
      study.spacings_from ? study.spacings_from(frame.spacing_mm) : frame.spacing_mm;
  spacing_mm[study.spacing] = studied_mm;
  const std::vector<core::RigidTransform> all = poses.At(spacing_mm);
  std::vector<core::RigidTransform> asked;
  for (const core::PartIndex part : study.parts) asked.push_back(all[part]);
  return asked;
}

std::vector<core::RigidTransform> SpacingJudge::PosesAt(const StudyFrame& frame, double studied_mm) const {
  std::vector<core::RigidTransform> all;
  for (const PlacedLayout& layout : layouts_) {
    const std::vector<core::RigidTransform> of_layout = layout.PosesAt(frame, studied_mm);
    all.insert(all.end(), of_layout.begin(), of_layout.end());
  }
  return all;
}

const SpacingJudge::PlacedLayout& SpacingJudge::LayoutOf(AskedIndex part) const {
  return *std::prev(std::ranges::upper_bound(layouts_, part, {}, &PlacedLayout::first));
}

InsideCells* SpacingJudge::InsideOf(AskedIndex part) const { return inside_->Of(part); }

double SpacingJudge::AllowedMm(AskedIndex part, const core::RigidTransform& world_from_part) const {
  if (!options_.review.hull_errors) return options_.review.uncertainty_mm;
  return worst_->Of(part, world_from_part);
}

std::vector<PartOverSpacing> SpacingJudge::AskSteps(const StudyFrame& frame,
                                                    std::span<const StudyStep> so_far) const {
  const auto at_0 = PosesAt(frame, 0.0), at_1 = PosesAt(frame, 1.0);
  std::vector<PartInFrame> parts;
  for (AskedIndex i = 0; i < trees_.size(); ++i) parts.emplace_back(*this, frame, i, at_0[i], at_1[i]);
  for (std::size_t step = steps_mm_.size(); step-- > 0;) {
    const auto poses = PosesAt(frame, steps_mm_[step]);
    for (AskedIndex i = 0; i < trees_.size(); ++i)
      parts[i].AskStep(step, poses[i], so_far[step].parts[i], so_far);
  }
  std::vector<PartOverSpacing> answers;
  for (PartInFrame& part : parts) answers.push_back(part.TakeAnswers());
  return answers;
}

Freedom SpacingJudge::AskFreedom(const StudyFrame& frame, AskedIndex part, double spacing_mm,
                                 StudyCount* count) const {
  const PlacedLayout& layout = LayoutOf(part);
  const std::size_t in_layout = part - layout.first;
  PartInFrame asked(*this, frame, part, layout.PosesAt(frame, 0.0)[in_layout],
                    layout.PosesAt(frame, 1.0)[in_layout]);
  return asked.AskFreedom(spacing_mm, layout.PosesAt(frame, spacing_mm)[in_layout], count);
}

}  // namespace elbowroom::review
