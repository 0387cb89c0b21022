#include "app/control/simulation/payload_cohort.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/control/demo_parts.h"
#include "app/control/simulation/person_draws.h"
#include "app/control/simulation/space_needed.h"
#include "core/statistics/balanced_orders.h"
#include "core/units.h"
#include "recon/synthetic/demo_motion.h"

namespace elbowroom::control {
namespace {

constexpr const char* kTongs = "tongs";
constexpr const char* kPipeStep = "put the pipe in";
constexpr const char* kCableStep = "plug the cable in";
constexpr double kRequiredClearanceMm = 15.0;  // as in the demo

// A participant at work: how, and how fast.
struct Person {
  recon::PayloadManner manner;
  double length_s = 0.0;
  double hold_share = 0.0;  // of it, that the pipe is held still over the receptacle
};

Person DrawPerson(const CohortOptions& options, bool takes_tongs, PersonDraws* draws) {
  const auto degrees = [&](double low, double high) {
    return core::RadiansFromDegrees(draws->Uniform(low, high));
  };
  Person person;
  recon::PayloadManner& manner = person.manner;
  manner.takes_tongs = takes_tongs;
  manner.hand_size = draws->Uniform(0.88, 1.12);
  manner.from_rad = degrees(-25.0, 25.0);
  const double aside_rad = degrees(0.0, 360.0), aside_mm = draws->Uniform(0.0, 8.0);
  manner.aside_mm = aside_mm * Eigen::Vector2d(std::cos(aside_rad), std::sin(aside_rad));
  manner.lift_mm = draws->Uniform(0.0, 15.0);
  manner.rise_mm = draws->Uniform(40.0, 60.0);
  manner.tongs_elevation_rad = degrees(35.0, 60.0);
  manner.tongs_grip_mm = draws->Uniform(120.0, 145.0);
  manner.strokes = draws->OneOf(3, 6);
  manner.Validate();
  person.length_s = options.seconds * draws->Uniform(0.8, 1.25);
  person.hold_share = draws->Uniform(0.0, 0.15);
  return person;
}

// The time of the script at a share of the trial: it stands still while the pipe is held.
double TaskTimeS(const Person& person, double share) {
  constexpr double kHeldAt = 4.0 / recon::kTaskSeconds;  // of the script: the pipe stands upright
  const double moving = 1.0 - person.hold_share, held_from = kHeldAt * moving;
  const double of_script = share < held_from                       ? share / moving
                           : share < held_from + person.hold_share ? kHeldAt
                                                                   : (share - person.hold_share) / moving;
  return recon::kTaskSeconds * std::clamp(of_script, 0.0, 1.0);
}

// People say round numbers.
double Rounded(double length_mm) {
  constexpr double kRoundMm = 5.0;
  return kRoundMm * std::round(length_mm / kRoundMm);
}

// The gap that a participant asks for: enough, in steps of 10 mm.
double AskedFor(double needed_mm) {
  constexpr double kStepMm = 10.0;
  return kStepMm * std::ceil((needed_mm + 0.5 * kStepMm) / kStepMm);
}

// The frames of a participant's trial.
class Played {
 public:
  Played(const Person& person, double frame_rate_hz)
      : person_(person),
        frame_rate_hz_(frame_rate_hz),
        frames_(std::max<core::FrameIndex>(2, std::lround(person.length_s * frame_rate_hz))) {}

  [[nodiscard]] core::FrameIndex frames() const { return frames_; }
  [[nodiscard]] double TaskTimeAtS(double time_s) const {
    return TaskTimeS(person_, time_s * frame_rate_hz_ / static_cast<double>(frames_ - 1));
  }
  [[nodiscard]] recon::DemoScene At(double time_s) const {
    return recon::PayloadSceneAt(person_.manner, TaskTimeAtS(time_s));
  }
  [[nodiscard]] recon::DemoScene Of(core::FrameIndex frame) const { return At(TimeS(frame)); }
  // The first frame at or after that time of the script.
  [[nodiscard]] core::FrameIndex FirstFrom(double task_time_s) const {
    core::FrameIndex frame = 0;
    while (frame + 1 < frames_ && TaskTimeAtS(TimeS(frame)) < task_time_s) ++frame;
    return frame;
  }

 private:
  [[nodiscard]] double TimeS(core::FrameIndex frame) const {
    return static_cast<double>(frame) / frame_rate_hz_;
  }

  Person person_;
  double frame_rate_hz_;
  core::FrameIndex frames_;
};

SimulatedTruth TruthOf(const Played& played, const core::Layout& layout, PersonDraws* draws) {
  SpaceNeeded all(layout, kDemoGap), without_tools(layout, kDemoGap);
  for (core::FrameIndex frame = 0; frame < played.frames(); ++frame) {
    const recon::DemoScene scene = played.Of(frame);
    all.Add(scene.objects);
    if (!scene.tongs_in_use) without_tools.Add(scene.objects);
  }
  SimulatedTruth truth;
  truth.needed_mm = all.gap_mm();
  truth.needed_without_tools_mm = without_tools.gap_mm();
  // Nobody thinks of the tongs before; afterwards a little is added to what was seen to be needed.
  truth.estimate_before_mm = Rounded(truth.needed_without_tools_mm + draws->Normal(-25.0, 20.0));
  truth.estimate_after_mm = Rounded(truth.needed_mm + draws->Normal(10.0, 8.0));
  return truth;
}

// More space is asked for when the pipe can't be stood up, and when the tongs come.
std::vector<ScriptedChange> ScriptOf(const Played& played, const SimulatedTruth& truth, bool takes_tongs) {
  constexpr double kPipeStandsUpS = 3.0;
  const core::FrameIndex cable = played.FirstFrom(recon::kCableBeginsS);
  std::vector<ScriptedChange> script;
  script.push_back(
      {played.FirstFrom(kPipeStandsUpS), SpacingRequest{kDemoGap, AskedFor(truth.needed_without_tools_mm)}});
  script.push_back({cable, StepRequest{kCableStep}});
  if (!takes_tongs) return script;
  script.push_back({cable, ToolRequest{kTongs, true}});
  script.push_back({cable, SpacingRequest{kDemoGap, AskedFor(truth.needed_mm)}});
  return script;
}

SimulatedTrial PlanTrial(const CohortOptions& options, const core::Layout& layout, int participant,
                         bool takes_tongs) {
  PersonDraws draws(options.seed, participant);
  const Played played(DrawPerson(options, takes_tongs, &draws), options.frame_rate_hz);
  SimulatedTrial trial;
  trial.frames = played.frames();
  trial.scene_at = [played](double time_s) { return played.At(time_s).objects; };
  trial.truth = TruthOf(played, layout, &draws);
  trial.after = {core::EstimateGiven{core::AskedWhen::kAfter, *trial.truth.estimate_after_mm}};
  TrialSetup& setup = trial.setup;
  setup.info.participant = CodeOf(participant, options.participants);
  setup.info.task = "put the pipe into the PMT box, then plug the power cable in";
  setup.info.condition = takes_tongs ? "flexible cable" : "stiff cable";
  setup.info.order = 1;
  setup.info.estimate_mm = *trial.truth.estimate_before_mm;
  setup.info.required_clearance_mm = kRequiredClearanceMm;
  setup.info.tools = {kTongs};
  setup.info.steps = {kPipeStep, kCableStep};
  setup.layout = layout;
  setup.first_step = kPipeStep;
  setup.script = ScriptOf(played, trial.truth, takes_tongs);
  trial.file = setup.info.participant + ".db";
  return trial;
}

}  // namespace

std::vector<SimulatedTrial> PlanPayloadCohort(const CohortOptions& options) {
  constexpr std::size_t kOfFour = 4;
  const core::Layout layout = DemoLayout();
  const std::vector<std::size_t> drawn =
      core::DrawInBlocks(static_cast<std::size_t>(options.participants), kOfFour, options.seed);
  std::vector<SimulatedTrial> trials;
  for (int i = 0; i < options.participants; ++i)
    trials.push_back(PlanTrial(options, layout, i, drawn[static_cast<std::size_t>(i)] != 0));
  return trials;
}

}  // namespace elbowroom::control
