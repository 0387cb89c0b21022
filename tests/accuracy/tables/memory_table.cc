// docs/performance.md, "memory": what each stage of the demo's frames asks the heap for.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_judge.h"
#include "app/control/frame_result_pool.h"
#include "app/control/outcome_tracker.h"
#include "app/control/scene_composer.h"
#include "app/control/trial_rules.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull.h"
#include "recon/segmentation/frame_segmenter.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/allocation_count.h"
#include "tests/support/resident_memory.h"

namespace elbowroom::accuracy {
namespace {

using test_support::AllocationCount;
using test_support::AllocationsSoFar;

constexpr core::FrameIndex kPictures = 360;  // that are kept, to be played over and over
constexpr int kRoundsBefore = 2, kRounds = 3;
constexpr double kPlayedRateHz = 30.0;

constexpr std::array kStages = {"the frame's result", "masks",   "hull, with its contours",
                                "contours' cells",    "judging", "operator's view",
                                "touches, heat maps"};
using StageCounts = std::array<AllocationCount, kStages.size()>;

// The stages of control::FramePipeline, one after the other, and what a trial does with a frame.
class StagedTrial {
 public:
  explicit StagedTrial(const control::TrialSetup& setup)
      : layout_(std::make_shared<const core::Layout>(setup.layout)),
        rig_(std::make_shared<const core::Rig>(setup.source->rig())),
        planes_(recon::MakeUndistortedPlanes(*rig_)),
        segmenter_(setup.source->ReadBackgrounds({}, {}), setup.segmentation, *rig_),
        judge_(*layout_, control::ReviewOptionsOf(setup.info, setup.source->rig(), setup.rig_quality)),
        tracker_(setup.info, judge_.part_trees()) {}

  void Play(recon::FrameSet frames, StageCounts* counts) {
    AllocationCount before = AllocationsSoFar();
    auto end_stage = [&, stage = std::size_t{0}]() mutable {
      const AllocationCount now = AllocationsSoFar();
      (*counts)[stage++] += now - before;
      before = AllocationsSoFar();
    };
    const std::shared_ptr<control::FrameResult> result = results_.Take();
    result->record.frame = frames.index;
    result->record.time_s = frames.time_s;
    result->record.spacing_mm = layout_->InitialSpacings();
    result->layout = layout_;
    result->world_from_parts = core::PosesAt(*layout_, result->record.spacing_mm);
    end_stage();
    std::vector<core::SoftMask> masks = segmenter_.SegmentSoft(frames);
    end_stage();
    result->hull = recon::NextHull(last_ ? last_->hull : nullptr, rig_, planes_, masks).hull;
    result->record.masks = std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
    end_stage();
    result->hull->Prepare();
    end_stage();
    judge_.Judge(last_.get(), result.get());
    end_stage();
    See(*result);
    end_stage();
    tracker_.Add(*result, {});
    end_stage();
    last_ = result;
  }

 private:
  void See(const control::FrameResult& result) {
    if (!rays_) {
      const recon::OrbitCamera camera = control::OverviewCamera(result, 640, 480);
      rays_.emplace(recon::CameraOf(recon::ViewFrom(camera, 640, 480)));
    }
    view_ = recon::ViewHull(*result.hull, *rays_, {.surfaces = false}, std::move(view_));
  }

  std::shared_ptr<const core::Layout> layout_;
  std::shared_ptr<const core::Rig> rig_;
  recon::UndistortedPlanes planes_;
  recon::FrameSegmenter segmenter_;
  control::FrameResultPool results_;
  control::FrameJudge judge_;
  control::OutcomeTracker tracker_;
  std::optional<recon::ViewRays> rays_;
  recon::HullView view_;
  control::SharedFrameResult last_;
};

struct MemoryUse {
  StageCounts counts;
  std::int64_t most_added_bytes = 0;  // to the resident set, by the trial
};

MemoryUse UseOf(const control::TrialSetup& setup, const std::vector<recon::FrameSet>& pictures, int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  const std::int64_t before_bytes = test_support::ResidentBytes(::getpid());
  StagedTrial trial(setup);
  MemoryUse use;
  core::FrameIndex index = 0;
  for (int round = 0; round < kRoundsBefore + kRounds; ++round) {
    StageCounts warming_up;
    for (recon::FrameSet frames : pictures) {
      frames.index = index++;
      frames.time_s = static_cast<double>(frames.index) / kPlayedRateHz;
      trial.Play(std::move(frames), round < kRoundsBefore ? &warming_up : &use.counts);
      use.most_added_bytes =
          std::max(use.most_added_bytes, test_support::ResidentBytes(::getpid()) - before_bytes);
    }
  }
  return use;
}

std::vector<std::string> RowOf(std::size_t stage, const MemoryUse& one, const MemoryUse& two) {
  constexpr double kFrames = static_cast<double>(kRounds * kPictures);
  std::vector<std::string> row = {kStages[stage]};
  for (const MemoryUse* use : {&one, &two}) {
    const AllocationCount& count = use->counts[stage];
    row.push_back(fmt::format("{:.2f}", static_cast<double>(count.allocations) / kFrames));
    row.push_back(fmt::format("{:.1f}", static_cast<double>(count.bytes) / 1000.0 / kFrames));
  }
  return row;
}

}  // namespace

void MeasureMemory(const std::filesystem::path& docs) {
  const control::TrialSetup setup = control::MakeDemoTrial(control::DemoPlay::kForever);
  fmt::print(stderr, "memory: drawing {} frames\n", kPictures);
  std::vector<recon::FrameSet> pictures;
  for (core::FrameIndex i = 0; i < kPictures; ++i) pictures.push_back(setup.source->Read(i));
  reporting::Table table{{"stage", "1 thread: allocations a frame", "KB a frame",
                          "2 threads: allocations a frame", "KB a frame"},
                         {}};
  fmt::print(stderr, "memory: playing them\n");
  const MemoryUse one = UseOf(setup, pictures, 1), two = UseOf(setup, pictures, 2);
  for (std::size_t stage = 0; stage < kStages.size(); ++stage) table.rows.push_back(RowOf(stage, one, two));
  // The second trial finds memory that the first gave back, so only the first one's share can be told.
  table.rows.push_back({"most resident, over all stages", "-",
                        fmt::format("{:.0f}", static_cast<double>(one.most_added_bytes) / 1000.0), "-", "-"});
  reporting::WriteSection(
      docs / "performance.md", "memory",
      reporting::ToMarkdown(table) + "\n" + reporting::ToLine(reporting::ThisMachine(docs / "..")));
}

}  // namespace elbowroom::accuracy
