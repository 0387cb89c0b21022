// A simulated cohort: participants who each do a task in a way of their own, of whom it is known what they
// need.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/control/trial_setup.h"
#include "core/layout.h"
#include "core/session.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::control {

enum class CohortTask {
  kPayload,  // the paper's payload spacing task: a trial each (Table 3)
  kBlocks,   // the paper's block-design task: patterns in real space, then in a hybrid environment (Tables 1,
             // 2)
};
inline constexpr CohortTask kCohortTasks[] = {CohortTask::kPayload, CohortTask::kBlocks};

[[nodiscard]] std::optional<CohortTask> ParseCohortTask(std::string_view text);  // "payload", "blocks"
[[nodiscard]] std::string_view ToString(CohortTask task);

struct CohortOptions {
  CohortTask task = CohortTask::kPayload;
  int participants = 4;    // [1, 10000]
  std::uint64_t seed = 1;  // the same one gives the same motion again
  double seconds = 16.0;   // that a participant of usual speed needs: for the payload task, or for a timed
                           // 2 x 2 pattern in real space; [0.5, 600]
  double frame_rate_hz = 15.0;  // [1, 60]

  // Those of the task, as the paper has it.
  [[nodiscard]] static CohortOptions Of(CohortTask task);
  // Throws: core::PreconditionError naming the field out of range.
  void Validate() const;
};

// What is known of a trial, because its motion is made. Lengths are gaps of the layout's spacing.
struct SimulatedTruth {
  double needed_without_tools_mm = 0.0;  // in the frames without a tool in use
  double needed_mm = 0.0;                // in all
  std::optional<double> estimate_before_mm = {};
  std::optional<double> estimate_after_mm = {};
  std::optional<double> pattern_s = {};  // of blocks: from the first frame to the one in which it is done
};

// What there is to record of a trial.
struct SimulatedTrial {
  std::string file;  // "P01.db"
  TrialSetup setup;  // without a source
  recon::SceneAtTime scene_at;
  core::FrameIndex frames = 0;
  std::vector<core::EventContent> after = {};  // said after it
  SimulatedTruth truth = {};
};

// By participant, then by order. A function of the options alone; a participant who is added changes nothing
// for those before. Throws: as CohortOptions::Validate.
[[nodiscard]] std::vector<SimulatedTrial> PlanCohort(const CohortOptions& options);

}  // namespace elbowroom::control
