#include "app/control/simulation/cohort_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>
#include <variant>

#include "app/control/parallel_tasks.h"
#include "app/control/simulation/cohort_table.h"
#include "app/control/trial_runner.h"
#include "core/error.h"
#include "core/procedure/simulated.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"
#include "recon/synthetic/rig_presets.h"
#include "sessions/after_trial.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

// No trial has as many frames, so that no two have the same noise.
constexpr core::FrameIndex kNoiseApart = 1'000'000;

// What a session says of how it came to be.
std::string NoteOf(const CohortOptions& options) {
  return fmt::format("{}task {}, seed {}, {:g} s, {:g} Hz", core::kSimulatedNote, ToString(options.task),
                     options.seed, options.seconds, options.frame_rate_hz);
}

// Whether the file is the trial, recorded whole.
bool IsRecorded(const fs::path& session, const SimulatedTrial& trial, const std::string& note) {
  try {
    const sessions::SessionReader reader(session);
    const core::TrialInfo& info = reader.header().trial;
    const std::vector<core::SessionEvent> events = reader.events();
    const auto has = [&](const core::EventContent& what) {
      return std::ranges::find(events, what, &core::SessionEvent::what) != events.end();
    };
    return info.participant == trial.setup.info.participant && info.order == trial.setup.info.order &&
           info.condition == trial.setup.info.condition &&
           static_cast<core::FrameIndex>(reader.frames().size()) == trial.frames && has(core::Note{note}) &&
           std::ranges::all_of(trial.after, has);
  } catch (const core::Error&) {
    return false;
  }
}

void RequireFree(const fs::path& session) {
  if (fs::exists(session))
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("'{}' is there already and isn't what would be recorded; choose another folder, "
                    "or remove it",
                    session.string()));
}

void Record(const SimulatedTrial& trial, const recon::SyntheticRig& stage, core::FrameIndex noise_from,
            const fs::path& session, const std::stop_token& stop) {
  TrialSetup setup = trial.setup;
  setup.source =
      std::make_shared<recon::SyntheticRig>(stage.Before(trial.scene_at, trial.frames, noise_from));
  TrialOptions options;
  options.session = session;
  TrialControls controls;
  const TrialOutcome outcome = RunTrial(setup, options, controls, stop);
  if (outcome.frames < trial.frames) {  // stopped: half a trial is no participant's
    fs::remove(outcome.session);
    core::ThrowIfStopped(stop, "the simulation");
  }
  if (!trial.after.empty()) sessions::AddAfterTrial(outcome.session, trial.after);
}

recon::SyntheticRig StageOf(const CohortOptions& options) {
  recon::SyntheticRigOptions rig;
  rig.seed = options.seed;
  rig.frame_rate_hz = options.frame_rate_hz;
  rig.what_ends_it = "the simulated task";
  return {recon::FourCameraRig(), [](double) { return std::vector<recon::SyntheticObject>(); }, rig};
}

}  // namespace

RecordedCohort RecordCohort(const CohortOptions& options, const fs::path& folder,
                            const core::Progress& progress, const std::stop_token& stop) {
  RecordedCohort cohort;
  cohort.trials = PlanCohort(options);
  const std::string note = NoteOf(options);
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < cohort.trials.size(); ++i) {
    SimulatedTrial& trial = cohort.trials[i];
    trial.setup.opening.push_back(core::Note{note});
    cohort.sessions.push_back(folder / trial.file);
    cohort.frames += trial.frames;
    if (fs::exists(cohort.sessions.back()) && IsRecorded(cohort.sessions.back(), trial, note)) {
      ++cohort.kept;
      continue;
    }
    RequireFree(cohort.sessions.back());
    missing.push_back(i);
  }
  core::MakeFolder(folder);
  recon::SyntheticRig stage = StageOf(options);
  (void)stage.ReadBackgrounds(progress, stop);
  SharedProgress shared(progress, static_cast<std::int64_t>(missing.size()), "sessions");
  RunTasks(missing.size(), "the simulation", stop, [&](std::size_t task, const std::stop_token& token) {
    const std::size_t i = missing[task];
    Record(cohort.trials[i], stage, kNoiseApart * static_cast<core::FrameIndex>(i), cohort.sessions[i],
           token);
    shared.Add(1);
  });
  cohort.truth = folder / "truth.csv";
  core::WriteWholeFile(cohort.truth, TruthCsv(cohort.trials));
  return cohort;
}

}  // namespace elbowroom::control
