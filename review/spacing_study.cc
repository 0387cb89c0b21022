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

// Frames that follow each other and have the same answers: hull, spacings and group are one.
struct FrameRun {
  StudyFrame first;
  std::int64_t frames = 1;
};

bool IsStill(const StudyFrame& frame) { return !frame.skew_errors || frame.skew_errors->is_still(); }

class Study {
 public:
  Study(std::span<const StudyLayout> layouts, const StudyFrames& frames, const SpacingStudyOptions& options,
        const core::Progress& progress, std::stop_token stop)
      : judge_(layouts, options),
        frames_(frames),
        options_(options),
        progress_(progress),
        stop_(std::move(stop)),
        steps_mm_(judge_.steps_mm()) {}

  std::vector<PartStudy> Run() {
    std::vector<StudyStep> none;
    for (const double spacing_mm : steps_mm_)
      none.push_back({spacing_mm, std::vector<PartAtSpacing>(judge_.part_count())});
    so_far_.assign(options_.groups, none);
    group_frames_.assign(options_.groups, 0);
    counts_.resize(judge_.part_count());
    kept_.resize(options_.groups);
    AskAllFrames();
    std::vector<PartStudy> studies(judge_.part_count());
    for (AskedIndex part = 0; part < studies.size(); ++part) {
      for (std::size_t group = 0; group < options_.groups; ++group)
        studies[part].curves.push_back(Conclude(group, part));
      studies[part].count = counts_[part];
    }
    const auto all = static_cast<std::int64_t>(frames_.count);
    progress_.Report(all, all, "frames");
    return studies;
  }

 private:
  // What is kept of the parts in a run of frames; nothing of those that the spacing doesn't move.
  struct Kept {
    std::size_t position = 0;  // of its first frame
    std::vector<PartOfFrame> parts;
  };

  // The frames of the next batch are loaded while those of this one are judged.
  void AskAllFrames() {
    std::vector<FrameRun> batch = LoadBatch();
    while (!batch.empty()) {
      const std::size_t begin = asked_;
      std::vector<std::vector<PartOverSpacing>> answers(batch.size());
      tbb::task_group judging;
      judging.run([&] {
        tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
          answers[i] = judge_.AskSteps(batch[i].first, so_far_[batch[i].first.group]);
        });
      });
      std::vector<FrameRun> next;
      try {
        next = LoadBatch();
      } catch (...) {
        judging.wait();
        throw;
      }
      judging.wait();
      std::size_t position = begin;
      for (std::size_t i = 0; i < batch.size(); ++i) {
        Take(position, batch[i], std::move(answers[i]));
        position += static_cast<std::size_t>(batch[i].frames);
      }
      asked_ = position;
      batch = std::move(next);
    }
  }

  [[nodiscard]] static bool HaveOneAnswer(const StudyFrame& a, const StudyFrame& b) {
    return a.hull == b.hull && a.group == b.group && a.spacing_mm == b.spacing_mm && IsStill(a) && IsStill(b);
  }

  // The frame after those of the last batch waits in `pending_`.
  [[nodiscard]] std::vector<FrameRun> LoadBatch() {
    std::vector<FrameRun> batch;
    const std::size_t most = std::clamp(loaded_, std::size_t{1}, kLargestBatch);
    const std::size_t begin = loaded_;
    for (;;) {
      if (!pending_ && loaded_ < frames_.count) {
        core::ThrowIfStopped(stop_, "the spacing study");
        pending_ = frames_.load(loaded_);
      }
      if (!pending_) break;
      if (!batch.empty() && HaveOneAnswer(batch.back().first, *pending_)) {
        ++batch.back().frames;
      } else if (batch.size() < most) {
        core::Require(pending_->group < options_.groups, "a frame's group is one of the study's");
        batch.push_back({*std::move(pending_)});
      } else {
        break;
      }
      pending_.reset();
      ++loaded_;
    }
    if (!batch.empty())
      progress_.Report(static_cast<std::int64_t>(begin), static_cast<std::int64_t>(frames_.count), "frames");
    return batch;
  }

  void Take(std::size_t position, const FrameRun& run, std::vector<PartOverSpacing> answers) {
    std::vector<StudyStep>& steps = so_far_[run.first.group];
    group_frames_[run.first.group] += run.frames;
    Kept kept{position, {}};
    for (AskedIndex i = 0; i < judge_.part_count(); ++i) {
      StudyCount& count = counts_[i];
      count.unchanged_frames += run.frames - 1;
      PartOfFrame of_part;
      of_part.touched = std::move(answers[i].touched);
      for (std::size_t step = 0; step < steps_mm_.size(); ++step) {
        const StepAnswer& answer = answers[i].steps[step];
        Add(answer, run, &steps[step].parts[i]);
        count.queries += answer.queries;
        ++(answer.was_asked ? count.asked : judge_.Moves(i) ? count.settled_by_motion : count.unmoved);
        of_part.lower_mm.push_back(answer.lower_mm);
      }
      kept.parts.push_back(judge_.Moves(i) ? std::move(of_part) : PartOfFrame());
    }
    kept_[run.first.group].push_back(std::move(kept));
  }

  static void Add(const StepAnswer& answer, const FrameRun& run, PartAtSpacing* sum) {
    switch (answer.verdict) {
      case core::Verdict::kContact:
        sum->frames_in_contact += run.frames;
        break;
      case core::Verdict::kNear:
        sum->frames_near += run.frames;
        break;
      case core::Verdict::kClear:
        sum->frames_clear += run.frames;
        break;
      case core::Verdict::kUndecided:
        sum->frames_undecided += run.frames;
        break;
    }
    if (answer.upper_mm < sum->upper_mm || answer.depth_mm > sum->deepest_mm)
      sum->closest_frame = run.first.frame;
    sum->deepest_mm = std::max(sum->deepest_mm, answer.depth_mm);
    sum->upper_mm = std::min(sum->upper_mm, answer.upper_mm);
    sum->lower_mm = std::min({sum->lower_mm, answer.lower_mm, sum->upper_mm});
  }

  // Goes from the largest step down to the first that isn't free, then bisects between that and the one
  // above.
  [[nodiscard]] PartCurve Conclude(std::size_t group, AskedIndex part) {
    PartCurve curve{group_frames_[group], {}, std::nullopt, std::nullopt};
    for (const StudyStep& step : so_far_[group]) curve.steps.push_back(step.parts[part]);
    if (!judge_.Moves(part)) {
      curve.smallest_free_mm = steps_mm_.front();
      return curve;
    }
    const auto is_touched = [&](std::size_t step) { return curve.steps[step].frames_in_contact > 0; };
    std::size_t free = steps_mm_.size();
    Freedom below = Freedom::kFree;
    while (free > 0) {
      below = is_touched(free - 1) ? Freedom::kTouched : FreedomAt(group, part, steps_mm_[free - 1]);
      if (below != Freedom::kFree) break;
      --free;
    }
    for (std::size_t step = 0; step < free; ++step) {
      if (is_touched(step) || (step + 1 == free && below == Freedom::kTouched))
        curve.largest_touched_mm = steps_mm_[step];
    }
    if (free < steps_mm_.size()) curve.smallest_free_mm = steps_mm_[free];
    if (free == 0 || free == steps_mm_.size()) return curve;
    double not_free_mm = steps_mm_[free - 1], free_mm = steps_mm_[free];
    while (free_mm - not_free_mm > options_.tolerance_mm) {
      core::ThrowIfStopped(stop_, "the spacing study");
      const double middle_mm = 0.5 * (not_free_mm + free_mm);
      const Freedom freedom = FreedomAt(group, part, middle_mm);
      (freedom == Freedom::kFree ? free_mm : not_free_mm) = middle_mm;
      if (freedom == Freedom::kTouched) curve.largest_touched_mm = middle_mm;
    }
    curve.smallest_free_mm = free_mm;
    return curve;
  }

  // Whether the part is in the hull in some frame at this value. Only frames in which that is possible are
  // loaded again.
  Freedom FreedomAt(std::size_t group, AskedIndex part, double spacing_mm) {
    if (std::ranges::any_of(kept_[group],
                            [&](const Kept& kept) { return IsIn(kept.parts[part].touched, spacing_mm); }))
      return Freedom::kTouched;
    Freedom freedom = Freedom::kFree;
    for (const Kept& kept : kept_[group]) {
      if (SureMm(kept.parts[part], spacing_mm) > 0.0) continue;
      core::ThrowIfStopped(stop_, "the spacing study");
      const Freedom of_frame =
          judge_.AskFreedom(frames_.load(kept.position), part, spacing_mm, &counts_[part]);
      if (of_frame == Freedom::kTouched) return of_frame;
      if (of_frame == Freedom::kUndecided) freedom = of_frame;
    }
    return freedom;
  }

  // A lower bound of the part's distance in a frame: it changes by no more than the spacing does, so each
  // step's lower bound gives one here.
  [[nodiscard]] double SureMm(const PartOfFrame& part, double spacing_mm) const {
    double sure_mm = 0.0;
    for (std::size_t step = 0; step < steps_mm_.size(); ++step)
      sure_mm = std::max(sure_mm, part.lower_mm[step] - std::abs(steps_mm_[step] - spacing_mm));
    return sure_mm;
  }

  const SpacingJudge judge_;
  const StudyFrames& frames_;
  const SpacingStudyOptions& options_;
  const core::Progress& progress_;
  const std::stop_token stop_;
  const std::vector<double>& steps_mm_;
  std::vector<std::vector<StudyStep>> so_far_;  // groups x steps, of the parts that are asked
  std::vector<std::int64_t> group_frames_;
  std::vector<StudyCount> counts_;       // one a part
  std::vector<std::vector<Kept>> kept_;  // groups x runs of frames
  std::size_t loaded_ = 0;               // frames that are in a batch
  std::size_t asked_ = 0;
  std::optional<StudyFrame> pending_;
};

// Whether the second answer is the closer one.
bool IsCloser(const PartAtSpacing& now, const PartAtSpacing& other) {
  if (other.deepest_mm != now.deepest_mm) return other.deepest_mm > now.deepest_mm;
  return other.upper_mm < now.upper_mm;
}

void Add(const PartAtSpacing& other, PartAtSpacing* sum) {
  if (IsCloser(*sum, other)) sum->closest_frame = other.closest_frame;
  sum->frames_in_contact += other.frames_in_contact;
  sum->frames_near += other.frames_near;
  sum->frames_undecided += other.frames_undecided;
  sum->frames_clear += other.frames_clear;
  sum->deepest_mm = std::max(sum->deepest_mm, other.deepest_mm);
  sum->lower_mm = std::min(sum->lower_mm, other.lower_mm);
  sum->upper_mm = std::min(sum->upper_mm, other.upper_mm);
}

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
  core::Require(groups > 0, "a study has a group of frames at least");
  review.Validate();
}

std::vector<double> SpacingStudyOptions::Steps() const {
  std::vector<double> steps_mm;
  for (double i = 0.0; from_mm + i * step_mm < to_mm; ++i) steps_mm.push_back(from_mm + i * step_mm);
  steps_mm.push_back(to_mm);
  return steps_mm;
}

std::vector<core::PartIndex> PartsMovedBy(const core::Layout& layout, core::SpacingIndex spacing) {
  std::vector<double> spacing_mm = layout.InitialSpacings();
  spacing_mm[spacing] = 0.0;
  const auto here = core::PosesAt(layout, spacing_mm);
  spacing_mm[spacing] = 1.0;
  const auto there = core::PosesAt(layout, spacing_mm);
  std::vector<core::PartIndex> moved;
  for (core::PartIndex i = 0; i < here.size(); ++i)
    if (!(here[i] == there[i])) moved.push_back(i);
  return moved;
}

// A value is free of contact for all if it is so for each.
SpacingCurve Together(std::span<const SpacingCurve> curves) {
  if (curves.empty()) return {};
  SpacingCurve sum = curves.front();
  for (const SpacingCurve& curve : curves.subspan(1)) {
    core::Require(curve.steps.size() == sum.steps.size(), "the curves have the same steps");
    sum.frames += curve.frames;
    for (std::size_t step = 0; step < sum.steps.size(); ++step)
      for (core::PartIndex i = 0; i < sum.steps[step].parts.size(); ++i)
        Add(curve.steps[step].parts.at(i), &sum.steps[step].parts[i]);
    if (curve.largest_touched_mm)
      sum.largest_touched_mm = std::max(curve.largest_touched_mm, sum.largest_touched_mm);
    sum.smallest_free_mm = curve.smallest_free_mm && sum.smallest_free_mm
                               ? std::max(curve.smallest_free_mm, sum.smallest_free_mm)
                               : std::nullopt;
  }
  return sum;
}

std::optional<double> SmallestClearMm(const SpacingCurve& curve, std::span<const core::PartIndex> parts) {
  std::optional<double> smallest_mm;
  for (std::size_t step = curve.steps.size(); step-- > 0;) {
    const bool is_clear = std::ranges::all_of(
        parts, [&](core::PartIndex i) { return curve.steps[step].parts[i].frames_clear == curve.frames; });
    if (!is_clear) break;
    smallest_mm = curve.steps[step].spacing_mm;
  }
  return smallest_mm;
}

StudyCount& StudyCount::operator+=(const StudyCount& other) {
  asked += other.asked;
  settled_by_motion += other.settled_by_motion;
  unmoved += other.unmoved;
  queries += other.queries;
  unchanged_frames += other.unchanged_frames;
  return *this;
}

StudyCount CountOf(std::span<const PartStudy> parts) {
  StudyCount sum;
  for (const PartStudy& part : parts) sum += part.count;
  if (!parts.empty()) sum.unchanged_frames = parts.front().count.unchanged_frames;
  return sum;
}

SpacingStudy Joined(std::span<const PartStudy> parts, std::span<const double> steps_mm,
                    std::vector<core::PartIndex> moved) {
  SpacingStudy study;
  study.moved = std::move(moved);
  const std::size_t groups = parts.empty() ? 0 : parts.front().curves.size();
  for (std::size_t group = 0; group < groups; ++group) {
    SpacingCurve curve;
    curve.smallest_free_mm = steps_mm.front();
    for (const double spacing_mm : steps_mm) curve.steps.push_back({spacing_mm, {}});
    for (const PartStudy& part : parts) {
      const PartCurve& of_part = part.curves.at(group);
      curve.frames = of_part.frames;
      for (std::size_t step = 0; step < curve.steps.size(); ++step)
        curve.steps[step].parts.push_back(of_part.steps.at(step));
      curve.largest_touched_mm = std::max(curve.largest_touched_mm, of_part.largest_touched_mm);
      curve.smallest_free_mm = of_part.smallest_free_mm && curve.smallest_free_mm
                                   ? std::max(curve.smallest_free_mm, of_part.smallest_free_mm)
                                   : std::nullopt;
    }
    study.curves.push_back(std::move(curve));
  }
  study.count = CountOf(parts);
  return study;
}

std::vector<PartStudy> StudyParts(std::span<const StudyLayout> layouts, const StudyFrames& frames,
                                  const SpacingStudyOptions& options, const core::Progress& progress,
                                  std::stop_token stop) {
  for (const StudyLayout& layout : layouts) {
    SpacingStudyOptions of_layout = options;
    of_layout.spacing = layout.spacing;
    of_layout.Validate(*layout.layout);
  }
  return Study(layouts, frames, options, progress, std::move(stop)).Run();
}

SpacingStudy StudySpacing(const core::Layout& layout, const StudyFrames& frames,
                          const SpacingStudyOptions& options, const core::Progress& progress,
                          std::stop_token stop) {
  StudyLayout all{&layout, options.spacing, {}};
  for (core::PartIndex part = 0; part < layout.parts.size(); ++part) all.parts.push_back(part);
  return Joined(StudyParts({&all, 1}, frames, options, progress, std::move(stop)), options.Steps(),
                PartsMovedBy(layout, options.spacing));
}

}  // namespace elbowroom::review
