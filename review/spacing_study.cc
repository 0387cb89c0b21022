#include "review/spacing_study.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/infinity.h"
#include "review/spacing_judge.h"

namespace elbowroom::review {
namespace {

// How many frames are judged in parallel at most. Batches grow as one, one, two, four, ..., because each
// batch uses what the batches before it found.
constexpr std::size_t kLargestBatch = 16;
constexpr double kMostSpacings = 10'000.0;

// What is kept of a moved part in a frame.
struct PartOfFrame {
  std::vector<double> lower_mm;  // of the distance, at each step
  std::vector<TouchedSpacings> touched;
};

class Study {
 public:
  Study(const core::Layout& layout, const StudyFrames& frames, const SpacingStudyOptions& options,
        const core::Progress& progress, std::stop_token stop)
      : judge_(layout, options),
        frames_(frames),
        options_(options),
        progress_(progress),
        stop_(std::move(stop)),
        steps_mm_(judge_.steps_mm()) {
    for (core::PartIndex i = 0; i < judge_.part_count(); ++i)
      if (judge_.Moves(i)) result_.moved.push_back(i);
  }

  SpacingStudy Run() {
    for (const double spacing_mm : steps_mm_)
      result_.steps.push_back({spacing_mm, std::vector<PartAtSpacing>(judge_.part_count())});
    moved_.resize(frames_.count);
    AskAllFrames();
    Conclude();
    const auto all = static_cast<std::int64_t>(frames_.count);
    progress_.Report(all, all, "frames");
    return std::move(result_);
  }

 private:
  // The frames of the next batch are loaded while those of this one are judged.
  void AskAllFrames() {
    std::vector<StudyFrame> batch = LoadBatch(0);
    for (std::size_t begin = 0; begin < frames_.count;) {
      const std::size_t end = begin + batch.size();
      std::vector<std::vector<PartOverSpacing>> answers(batch.size());
      tbb::task_group judging;
      judging.run([&] {
        tbb::parallel_for(std::size_t{0}, batch.size(),
                          [&](std::size_t i) { answers[i] = judge_.AskSteps(batch[i], result_.steps); });
      });
      std::vector<StudyFrame> next = LoadBatch(end);
      judging.wait();
      for (std::size_t i = 0; i < batch.size(); ++i) Take(begin + i, batch[i].frame, std::move(answers[i]));
      batch = std::move(next);
      begin = end;
    }
  }

  [[nodiscard]] std::vector<StudyFrame> LoadBatch(std::size_t begin) {
    std::vector<StudyFrame> batch;
    const std::size_t most = std::clamp(begin, std::size_t{1}, kLargestBatch);
    for (std::size_t i = begin; i < std::min(begin + most, frames_.count); ++i) {
      core::ThrowIfStopped(stop_, "the spacing study");
      batch.push_back(frames_.load(i));
    }
    if (!batch.empty())
      progress_.Report(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(frames_.count), "frames");
    return batch;
  }

  void Take(std::size_t index, core::FrameIndex frame, std::vector<PartOverSpacing> answers) {
    for (core::PartIndex i = 0; i < judge_.part_count(); ++i) {
      PartOfFrame kept;
      kept.touched = std::move(answers[i].touched);
      for (std::size_t step = 0; step < steps_mm_.size(); ++step) {
        const StepAnswer& answer = answers[i].steps[step];
        Add(answer, frame, &result_.steps[step].parts[i]);
        result_.count.queries += answer.queries;
        ++(answer.was_asked  ? result_.count.asked
           : judge_.Moves(i) ? result_.count.settled_by_motion
                             : result_.count.unmoved);
        kept.lower_mm.push_back(answer.lower_mm);
      }
      if (judge_.Moves(i)) moved_[index].push_back(std::move(kept));
    }
  }

  static void Add(const StepAnswer& answer, core::FrameIndex frame, PartAtSpacing* sum) {
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
    if (std::ranges::any_of(moved_, [&](const auto& parts) {
          return std::ranges::any_of(parts,
                                     [&](const PartOfFrame& part) { return IsIn(part.touched, spacing_mm); });
        }))
      return Freedom::kTouched;
    Freedom freedom = Freedom::kFree;
    for (std::size_t i = 0; i < frames_.count; ++i) {
      if (SureMm(i, spacing_mm) > 0.0) continue;
      core::ThrowIfStopped(stop_, "the spacing study");
      const Freedom of_frame = judge_.AskFreedom(frames_.load(i), spacing_mm, &result_.count);
      if (of_frame == Freedom::kTouched) return of_frame;
      if (of_frame == Freedom::kUndecided) freedom = of_frame;
    }
    return freedom;
  }

  // A lower bound of all moved parts' distances in this frame: a part's distance changes by no more than the
  // spacing does, so each step's lower bound gives one here.
  [[nodiscard]] double SureMm(std::size_t frame, double spacing_mm) const {
    double sure_mm = core::kInfinity;
    for (const PartOfFrame& part : moved_[frame]) {
      double of_part_mm = 0.0;
      for (std::size_t step = 0; step < steps_mm_.size(); ++step)
        of_part_mm = std::max(of_part_mm, part.lower_mm[step] - std::abs(steps_mm_[step] - spacing_mm));
      sure_mm = std::min(sure_mm, of_part_mm);
    }
    return sure_mm;
  }

  const SpacingJudge judge_;
  const StudyFrames& frames_;
  const SpacingStudyOptions& options_;
  const core::Progress& progress_;
  const std::stop_token stop_;
  const std::vector<double>& steps_mm_;
  std::vector<std::vector<PartOfFrame>> moved_;  // frames x moved parts
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
