#include "tests/accuracy/chain/chain_study.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>

#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::accuracy {
namespace {

void AddVerdict(const JudgedPart& part, std::size_t rule, RuleFigures* figures) {
  const core::Verdict verdict = part.verdicts[rule];
  figures->tally.Add(part.true_mm, verdict);
  if (verdict != core::Verdict::kClear) return;
  if (part.true_mm >= kRequiredMm[rule]) return;
  ++figures->clear_but_nearer;
  figures->most_missing_mm = std::max(figures->most_missing_mm, kRequiredMm[rule] - part.true_mm);
}

void AddBounds(const JudgedPart& part, ChainFigures* figures) {
  if (!part.bounds || part.true_mm >= VerdictTally::kFarthestMm) return;
  const JudgedPart::Bounds& bounds = *part.bounds;
  if (std::isinf(bounds.lower_mm)) {
    ++figures->without_hull;
    return;
  }
  ++figures->with_bounds;
  const double below_mm = bounds.lower_mm - bounds.budget.ExpandedMm() - part.true_mm;
  if (below_mm > 0.0) {
    ++figures->nearer_than_bounds;
    figures->most_below_bounds_mm = std::max(figures->most_below_bounds_mm, below_mm);
  }
  figures->allowed_mm.push_back(bounds.budget.ExpandedMm());
  figures->calibration_mm.push_back(bounds.budget.calibration_mm);
  figures->segmentation_mm.push_back(bounds.budget.segmentation_mm);
  figures->skew_mm.push_back(bounds.budget.skew_mm);
  if (part.true_mm > 0.0 && bounds.has_witnesses)
    figures->hull_excess_mm.push_back(part.true_mm - 0.5 * (bounds.lower_mm + bounds.upper_mm));
}

}  // namespace

ChainFigures StudyChain(const ChainStudyOptions& options, const core::Progress& progress) {
  ChainFigures figures;
  figures.cameras = options.rig.cameras;
  for (int calibration = 0; calibration < options.calibrations; ++calibration) {
    const std::uint64_t seed = recon::StreamSeed(options.seed, calibration, 0, 0);
    const std::string of_all = fmt::format("{} cameras, calibration {} of {}", options.rig.cameras,
                                           calibration + 1, options.calibrations);
    progress.Report(0, options.trials, of_all);
    const ChainRig rig = MakeChainRig(options.rig, seed);
    const ChainCameras cameras(rig.truth, seed);
    const auto backgrounds = cameras.TakeBackgrounds(seed);
    figures.held_out_px.push_back(rig.held_out_px);
    figures.center_error_mm.push_back(rig.center_error_mm);
    std::vector<std::vector<JudgedPart>> judged(static_cast<std::size_t>(options.trials));
    std::atomic<int> done = 0;
    tbb::parallel_for(std::size_t{0}, judged.size(), [&](std::size_t i) {
      const ChainTrialOptions trial{kChainObjects[i % std::size(kChainObjects)], options.frames,
                                    recon::StreamSeed(seed, static_cast<std::int64_t>(i), 1, 0)};
      // While a trial waits for its own loops its thread must not begin another one.
      tbb::this_task_arena::isolate([&] { judged[i] = RunChainTrial(rig, cameras, backgrounds, trial); });
      progress.Report(++done, options.trials, of_all + ", trial");
    });
    figures.frames += std::int64_t{options.trials} * options.frames;
    for (const std::vector<JudgedPart>& of_trial : judged)
      for (const JudgedPart& part : of_trial) {
        for (std::size_t rule = 0; rule < kRequiredMm.size(); ++rule)
          AddVerdict(part, rule, &figures.rules[rule]);
        AddBounds(part, &figures);
        figures.fastest_mm_per_s.push_back(part.fastest_mm_per_s);
        figures.most_skew_ms.push_back(1e3 * part.most_skew_s);
      }
  }
  return figures;
}

}  // namespace elbowroom::accuracy
