#include "review/spacing_study.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/infinity.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {
namespace {

using recon::BallAnswer;

using core::kInfinity;
// How many frames are judged in parallel at most. Batches grow as one, one, two, four, ..., because each
// batch uses what the batches before it found.
constexpr std::size_t kLargestBatch = 16;
constexpr double kMostSpacings = 10'000.0;
// Touching is told from free by clearances whose bounds are as close as the spacing's tolerance divided by
// these, one after the other until the bounds tell.
constexpr std::array kFiner = {4.0, 32.0, 256.0};

// The answer for one part in one frame at one step.
struct PartAnswer {
  core::Verdict verdict = core::Verdict::kClear;
  double depth_mm = 0.0;
  double lower_mm = 0.0;
  double upper_mm = kInfinity;
  std::int64_t queries = 0;
  bool was_asked = false;
};

// Answers of one frame: parts x steps.
struct FrameAnswers {
  core::FrameIndex frame = 0;
  std::vector<std::vector<PartAnswer>> parts;
};

enum class Freedom { kTouched, kFree, kUndecided };

class Study {
 public:
  Study(const core::Layout& layout, const StudyFrames& frames, const SpacingStudyOptions& options,
        const core::Progress& progress, std::stop_token stop)
      : layout_(layout),
        frames_(frames),
        options_(options),
        progress_(progress),
        stop_(std::move(stop)),
        steps_mm_(options.Steps()) {
    for (const core::Part& part : layout.parts) trees_.emplace_back(part.mesh);
    const std::vector<double> initial = layout.InitialSpacings();
    // The parts that the spacing moves are those whose poses differ between any two values.
    const auto here = PosesAt(initial, 0.0), there = PosesAt(initial, 1.0);
    for (core::PartIndex i = 0; i < trees_.size(); ++i) {
      moves_.push_back(!(here[i] == there[i]));
      if (moves_.back()) result_.moved.push_back(i);
    }
  }

  SpacingStudy Run() {
    for (const double spacing_mm : steps_mm_)
      result_.steps.push_back({spacing_mm, std::vector<PartAtSpacing>(trees_.size())});
    lower_mm_.resize(frames_.count);
    for (std::size_t begin = 0; begin < frames_.count;)
      begin = AskBatch(begin, std::clamp(begin, std::size_t{1}, kLargestBatch));
    Conclude();
    const auto all = static_cast<std::int64_t>(frames_.count);
    progress_.Report(all, all, "frames");
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::vector<core::RigidTransform> PosesAt(std::vector<double> spacing_mm,
                                                          double studied_mm) const {
    spacing_mm[options_.spacing] = studied_mm;
    return core::PosesAt(layout_, spacing_mm);
  }

  // Judges a batch of frames. Returns the index of the frame after it.
  std::size_t AskBatch(std::size_t begin, std::size_t most) {
    core::ThrowIfStopped(stop_, "the spacing study");
    progress_.Report(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(frames_.count), "frames");
    std::vector<StudyFrame> batch;
    for (std::size_t i = begin; i < std::min(begin + most, frames_.count); ++i)
      batch.push_back(frames_.load(i));
    std::vector<FrameAnswers> answers(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) { answers[i] = AskFrame(batch[i]); });
    for (std::size_t i = 0; i < batch.size(); ++i) Take(begin + i, answers[i]);
    return begin + batch.size();
  }

  // Steps go down from the largest, at which parts are farthest from their references: there a lower bound is
  // large enough to settle steps below.
  [[nodiscard]] FrameAnswers AskFrame(const StudyFrame& frame) const {
    FrameAnswers answers;
    answers.frame = frame.frame;
    answers.parts.assign(trees_.size(), std::vector<PartAnswer>(steps_mm_.size()));
    std::vector<std::optional<ClearanceHint>> hints(trees_.size());
    std::vector<core::RigidTransform> last_poses;
    for (std::size_t step = steps_mm_.size(); step-- > 0;) {
      const auto poses = PosesAt(frame.spacing_mm, steps_mm_[step]);
      for (core::PartIndex i = 0; i < trees_.size(); ++i) {
        std::vector<PartAnswer>& of_part = answers.parts[i];
        const bool is_first = step + 1 == steps_mm_.size();
        if (!is_first && !moves_[i]) {
          of_part[step] = of_part[step + 1];
          of_part[step].was_asked = false;
          of_part[step].queries = 0;
          continue;
        }
        const double enough_mm = EnoughMm(i, step);
        const double sure_mm = is_first ? 0.0
                                        : of_part[step + 1].lower_mm -
                                              (poses[i].translation_mm - last_poses[i].translation_mm).norm();
        if (sure_mm > 0.0 && sure_mm >= enough_mm) {
          of_part[step].lower_mm = sure_mm;
          continue;
        }
        of_part[step] = AskBalls(*frame.hull, i, poses[i], step);
        if (of_part[step].lower_mm > 0.0) continue;
        const std::int64_t queries = of_part[step].queries;
        of_part[step] = Ask(*frame.hull, i, poses[i], enough_mm, options_.review.tolerance_mm, &hints[i]);
        of_part[step].queries += queries;
      }
      last_poses = poses;
    }
    return answers;
  }

  // Distances from here on can change neither a verdict nor the least distance so far.
  [[nodiscard]] double EnoughMm(core::PartIndex part, std::size_t step) const {
    return std::max(options_.review.required_clearance_mm + options_.review.uncertainty_mm,
                    result_.steps[step].parts[part].upper_mm);
  }

  // Tries to settle this step, and all steps below, by one query of a ball around the part: large enough to
  // allow for the part's motion in between. If that fails, half as many steps, and so on.
  [[nodiscard]] PartAnswer AskBalls(const recon::VisualHull& hull, core::PartIndex part,
                                    const core::RigidTransform& world_from_part, std::size_t step) const {
    PartAnswer answer;
    if (trees_[part].nodes().empty()) return answer;
    answer.was_asked = true;
    const core::Ball& ball = trees_[part].nodes()[0].ball;
    for (std::size_t span = step + 1; span > 0; span /= 2) {
      double far_mm = 0.0;
      for (std::size_t i = 0; i < span; ++i)
        far_mm = std::max(far_mm, EnoughMm(part, step - i) + (steps_mm_[step] - steps_mm_[step - i]));
      if (!std::isfinite(far_mm) || !(far_mm > 0.0)) continue;
      ++answer.queries;
      const double reach_mm = ball.radius_mm + trees_[part].mesh().deviation_mm + far_mm;
      if (hull.Classify(world_from_part * ball.center, reach_mm) != BallAnswer::kOutside) continue;
      answer.lower_mm = far_mm;
      break;
    }
    return answer;
  }

  [[nodiscard]] PartAnswer Ask(const recon::VisualHull& hull, core::PartIndex part,
                               const core::RigidTransform& world_from_part, double enough_mm,
                               double tolerance_mm, std::optional<ClearanceHint>* hint) const {
    PartAnswer answer;
    answer.was_asked = true;
    const core::PartContact contact =
        FindContacts(hull, trees_[part], world_from_part, part, options_.review.contacts);
    answer.queries = contact.count.queries;
    answer.verdict = contact.verdict;
    if (contact.verdict == core::Verdict::kContact) {
      answer.depth_mm = contact.deepest ? contact.deepest->depth_mm : 0.0;
      answer.upper_mm = trees_[part].mesh().deviation_mm;
      return answer;
    }
    if (enough_mm <= 0.0) return answer;
    ClearanceOptions clearance_options;
    clearance_options.tolerance_mm = tolerance_mm;
    clearance_options.enough_mm = enough_mm;
    const Clearance clearance = FindClearance(hull, trees_[part], world_from_part, clearance_options, *hint);
    answer.queries += clearance.queries;
    answer.lower_mm = clearance.interval.lower_mm;
    answer.upper_mm = clearance.interval.upper_mm;
    answer.verdict = Judge(clearance, options_.review.required_clearance_mm, options_.review.uncertainty_mm);
    if (clearance.has_witnesses)
      *hint = ClearanceHint{world_from_part.Inverse() * clearance.interval.witness_part_in_world_mm,
                            clearance.interval.witness_hull_in_world_mm};
    return answer;
  }

  void Take(std::size_t index, const FrameAnswers& answers) {
    for (core::PartIndex i = 0; i < trees_.size(); ++i) {
      for (std::size_t step = 0; step < steps_mm_.size(); ++step) {
        const PartAnswer& answer = answers.parts[i][step];
        Add(answer, answers.frame, &result_.steps[step].parts[i]);
        result_.count.queries += answer.queries;
        ++(answer.was_asked ? result_.count.asked
           : moves_[i]      ? result_.count.settled_by_motion
                            : result_.count.unmoved);
        if (moves_[i]) lower_mm_[index].push_back(answer.lower_mm);
      }
    }
  }

  static void Add(const PartAnswer& answer, core::FrameIndex frame, PartAtSpacing* sum) {
    switch (answer.verdict) {
      case core::Verdict::kContact:
        ++sum->frames_in_contact;
        break;
      case core::Verdict::kNear:
        ++sum->frames_near;
        break;
      case core::Verdict::kClear:
        ++sum->frames_clear;
        break;
      case core::Verdict::kUndecided:
        ++sum->frames_undecided;
        break;
    }
    if (answer.upper_mm < sum->upper_mm || answer.depth_mm > sum->deepest_mm) sum->closest_frame = frame;
    sum->deepest_mm = std::max(sum->deepest_mm, answer.depth_mm);
    sum->upper_mm = std::min(sum->upper_mm, answer.upper_mm);
    sum->lower_mm = std::min({sum->lower_mm, answer.lower_mm, sum->upper_mm});
  }

  [[nodiscard]] bool IsTouched(std::size_t step) const {
    return std::ranges::any_of(
        result_.moved, [&](core::PartIndex i) { return result_.steps[step].parts[i].frames_in_contact > 0; });
  }

  // Goes from the largest step down to the first that isn't free, then bisects between that and the one
  // above.
  void Conclude() {
    std::size_t free = steps_mm_.size();
    Freedom below = Freedom::kFree;
    while (free > 0) {
      below = IsTouched(free - 1) ? Freedom::kTouched : FreedomAt(steps_mm_[free - 1]);
      if (below != Freedom::kFree) break;
      --free;
    }
    for (std::size_t step = 0; step < free; ++step) {
      if (IsTouched(step) || (step + 1 == free && below == Freedom::kTouched))
        result_.largest_touched_mm = steps_mm_[step];
    }
    if (free < steps_mm_.size()) result_.smallest_free_mm = steps_mm_[free];
    if (free == 0 || free == steps_mm_.size()) return;
    double not_free_mm = steps_mm_[free - 1], free_mm = steps_mm_[free];
    while (free_mm - not_free_mm > options_.tolerance_mm) {
      core::ThrowIfStopped(stop_, "the spacing study");
      const double middle_mm = 0.5 * (not_free_mm + free_mm);
      const Freedom freedom = FreedomAt(middle_mm);
      (freedom == Freedom::kFree ? free_mm : not_free_mm) = middle_mm;
      if (freedom == Freedom::kTouched) result_.largest_touched_mm = middle_mm;
    }
    result_.smallest_free_mm = free_mm;
  }

  // Whether a moved part is in the hull in some frame at this value. Only frames in which that is possible
  // are loaded again.
  Freedom FreedomAt(double spacing_mm) {
    Freedom freedom = Freedom::kFree;
    for (std::size_t i = 0; i < frames_.count; ++i) {
      if (SureMm(i, spacing_mm) > 0.0) continue;
      core::ThrowIfStopped(stop_, "the spacing study");
      const Freedom of_frame = FreedomOf(frames_.load(i), spacing_mm);
      if (of_frame == Freedom::kTouched) return of_frame;
      if (of_frame == Freedom::kUndecided) freedom = of_frame;
    }
    return freedom;
  }

  // A lower bound of all moved parts' distances in this frame: a part's distance changes by no more than the
  // spacing does, so each step's lower bound gives one here.
  [[nodiscard]] double SureMm(std::size_t frame, double spacing_mm) const {
    double sure_mm = kInfinity;
    for (std::size_t part = 0; part < result_.moved.size(); ++part) {
      double of_part_mm = 0.0;
      for (std::size_t step = 0; step < steps_mm_.size(); ++step)
        of_part_mm = std::max(of_part_mm, lower_mm_[frame][part * steps_mm_.size() + step] -
                                              std::abs(steps_mm_[step] - spacing_mm));
      sure_mm = std::min(sure_mm, of_part_mm);
    }
    return sure_mm;
  }

  Freedom FreedomOf(const StudyFrame& frame, double spacing_mm) {
    const auto poses = PosesAt(frame.spacing_mm, spacing_mm);
    Freedom freedom = Freedom::kFree;
    for (const core::PartIndex part : result_.moved) {
      std::optional<ClearanceHint> hint;
      Freedom of_part = Freedom::kUndecided;
      for (std::size_t i = 0; i < kFiner.size() && of_part == Freedom::kUndecided; ++i) {
        const double tolerance_mm = options_.tolerance_mm / kFiner[i];
        const PartAnswer answer = Ask(*frame.hull, part, poses[part], tolerance_mm, tolerance_mm, &hint);
        ++result_.count.asked;
        result_.count.queries += answer.queries;
        if (answer.verdict == core::Verdict::kContact) return Freedom::kTouched;
        if (answer.lower_mm > 0.0) of_part = Freedom::kFree;
      }
      if (of_part == Freedom::kUndecided) freedom = of_part;
    }
    return freedom;
  }

  const core::Layout& layout_;
  const StudyFrames& frames_;
  const SpacingStudyOptions& options_;
  const core::Progress& progress_;
  const std::stop_token stop_;
  const std::vector<double> steps_mm_;
  std::vector<core::TriangleTree> trees_;
  std::vector<bool> moves_;
  // One list a frame: moved parts x steps.
  std::vector<std::vector<double>> lower_mm_;
  SpacingStudy result_;
};

}  // namespace

void SpacingStudyOptions::Validate(const core::Layout& layout) const {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw core::Error(core::ErrorKind::kRange, "spacing study: " + what);
  };
  core::Require(spacing < layout.spacings.size(), "a study is of one of the layout's spacings");
  const core::Spacing& gap = layout.spacings[spacing];
  require(from_mm >= gap.min_mm && to_mm <= gap.max_mm && from_mm <= to_mm,
          fmt::format("'{}' goes from {} to {} mm, not from {} to {}; choose a range within", gap.name,
                      gap.min_mm, gap.max_mm, from_mm, to_mm));
  require(step_mm > 0.0 && std::isfinite(step_mm),
          fmt::format("a step must be positive, not {} mm", step_mm));
  require((to_mm - from_mm) / step_mm <= kMostSpacings,
          fmt::format("{} steps at most; choose a longer one than {} mm", kMostSpacings, step_mm));
  require(tolerance_mm > 0.0 && std::isfinite(tolerance_mm),
          fmt::format("the tolerance must be positive, not {} mm", tolerance_mm));
  review.Validate();
}

std::vector<double> SpacingStudyOptions::Steps() const {
  std::vector<double> steps_mm;
  for (double i = 0.0; from_mm + i * step_mm < to_mm; ++i) steps_mm.push_back(from_mm + i * step_mm);
  steps_mm.push_back(to_mm);
  return steps_mm;
}

SpacingStudy StudySpacing(const core::Layout& layout, const StudyFrames& frames,
                          const SpacingStudyOptions& options, const core::Progress& progress,
                          std::stop_token stop) {
  options.Validate(layout);
  return Study(layout, frames, options, progress, std::move(stop)).Run();
}

}  // namespace elbowroom::review
