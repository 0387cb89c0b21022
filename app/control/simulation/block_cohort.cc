#include "app/control/simulation/block_cohort.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "app/control/demo_parts.h"
#include "app/control/simulation/person_draws.h"
#include "app/control/simulation/space_needed.h"
#include "core/statistics/balanced_orders.h"
#include "core/units.h"
#include "recon/synthetic/block_motion.h"

namespace elbowroom::control {
namespace {

constexpr const char* kCoverGap = "cover_gap";

// How long a pattern takes, of one of 2 x 2 in real space by the same person. The paper says of the hybrid
// environments that they "only took about twice as long"; the rest is ours.
constexpr double kLargeTimes = 2.2, kPracticeTimes = 1.25;
constexpr double kGenericTimes = 2.1, kFaithfulTimes = 1.85;
constexpr double kPeopleSd = 0.2, kPatternSd = 0.1;  // shares: between people, and between patterns of one

core::Part PartAt(std::string name, core::TriangleMesh mesh, const Eigen::Vector3d& position_mm) {
  core::Part part;
  part.name = std::move(name);
  part.mesh = std::make_shared<const core::TriangleMesh>(std::move(mesh));
  part.world_from_part.translation_mm = position_mm;
  return part;
}

core::TriangleMesh PlateMesh(double size_x_mm, double size_y_mm, double height_mm) {
  return MeshThrough(std::array<ProfileRing, 2>{RectangleRing(size_x_mm, size_y_mm, 0.0),
                                                RectangleRing(size_x_mm, size_y_mm, height_mm)});
}

// The target pattern on a card behind the blocks, and the top of the paper's enclosure, 36" x 25" x 18".
core::Layout BlockLayout() {
  constexpr double kInchMm = 25.4, kCardMm = 160.0, kThickMm = 8.0;
  constexpr double kCoverMm = 18.0 * kInchMm - kThickMm;
  core::Layout layout;
  layout.parts.push_back(PartAt("pattern", PlateMesh(kCardMm, kCardMm, kThickMm), {-310.0, 0.0, 0.0}));
  layout.parts.push_back(
      PartAt("cover", PlateMesh(25.0 * kInchMm, 36.0 * kInchMm, kThickMm), {0.0, 0.0, kThickMm + kCoverMm}));
  layout.spacings.push_back({kCoverGap, "cover", "pattern", core::Axis::kZ, 100.0, kCoverMm, kCoverMm});
  layout.Validate();
  return layout;
}

// What a trial is of.
struct Pattern {
  std::string condition;
  int side = 2;
  bool is_practice = false;
};

// "2 x 2, timed"
std::string NameOf(const Pattern& pattern) {
  return fmt::format("{0} x {0}, {1}", pattern.side, pattern.is_practice ? "practice" : "timed");
}

// In the order in which one participant does them.
std::vector<Pattern> PatternsOf(const std::string& hybrid) {
  constexpr int kInReal = 3, kInHybrid = 2;
  std::vector<Pattern> patterns;
  for (const auto& [condition, count] :
       {std::pair<std::string, int>{kRealSpace, kInReal}, {hybrid, kInHybrid}})
    for (const bool is_practice : {true, false})
      for (const int side : {2, 3})
        patterns.insert(patterns.end(), count, Pattern{condition, side, is_practice});
  return patterns;
}

double TimesOf(const Pattern& pattern) {
  double times = pattern.side == 3 ? kLargeTimes : 1.0;
  if (pattern.is_practice) times *= kPracticeTimes;
  if (pattern.condition == kGenericHands) times *= kGenericTimes;
  if (pattern.condition == kFaithfulHands) times *= kFaithfulTimes;
  return times;
}

// How a person is about all patterns.
struct BlockPerson {
  recon::BlockManner manner;
  double times = 1.0;         // of the usual time
  double hybrid_times = 1.0;  // in a hybrid environment, beside its own
};

double Share(PersonDraws* draws, double sd) { return std::clamp(draws->Normal(1.0, sd), 0.5, 1.6); }

BlockPerson DrawBlockPerson(PersonDraws* draws) {
  BlockPerson person;
  person.manner.hand.size = draws->Uniform(0.88, 1.12);
  person.manner.from_rad = core::RadiansFromDegrees(draws->Uniform(-15.0, 15.0));
  person.manner.lift_mm = draws->Uniform(0.0, 60.0);
  person.times = Share(draws, kPeopleSd);
  person.hybrid_times = Share(draws, kPatternSd);
  return person;
}

SimulatedTrial PlanBlockTrial(const CohortOptions& options, const core::Layout& layout,
                              const BlockPerson& person, const Pattern& pattern, double length_s) {
  SimulatedTrial trial;
  trial.frames = std::max<core::FrameIndex>(2, 1 + std::lround(length_s * options.frame_rate_hz));
  const double last_s = static_cast<double>(trial.frames - 1) / options.frame_rate_hz;
  recon::BlockManner manner = person.manner;
  if (pattern.condition == kGenericHands) {  // the paper's dishwashing gloves
    manner.hand.glove_mm = 1.0;
    manner.hand.glove_bgr = Eigen::Vector3d(60.0, 210.0, 230.0);
  }
  trial.scene_at = [manner, side = pattern.side, last_s](double time_s) {
    return recon::BlocksAt(manner, side, std::min(time_s / last_s, 1.0));
  };
  SpaceNeeded needed(layout, kCoverGap);
  for (core::FrameIndex frame = 0; frame < trial.frames; ++frame)
    needed.Add(trial.scene_at(static_cast<double>(frame) / options.frame_rate_hz));
  trial.truth.needed_mm = trial.truth.needed_without_tools_mm = needed.gap_mm();
  const auto done =
      std::min<core::FrameIndex>(static_cast<core::FrameIndex>(std::ceil(recon::PatternDoneAt(pattern.side) *
                                                                         last_s * options.frame_rate_hz)),
                                 trial.frames - 1);
  trial.truth.pattern_s = static_cast<double>(done) / options.frame_rate_hz;

  TrialSetup& setup = trial.setup;
  setup.info.task = NameOf(pattern);
  setup.info.condition = pattern.condition;
  setup.info.block = pattern.is_practice ? "practice" : "timed";
  setup.info.steps = {NameOf(pattern)};
  setup.layout = layout;
  setup.first_step = setup.info.steps.front();
  setup.script.push_back({done, StepRequest{}});
  return trial;
}

}  // namespace

std::vector<SimulatedTrial> PlanBlockCohort(const CohortOptions& options) {
  const core::Layout layout = BlockLayout();
  const std::array<const char*, 2> hybrids{kGenericHands, kFaithfulHands};
  const std::vector<std::size_t> drawn =
      core::DrawInBlocks(static_cast<std::size_t>(options.participants), hybrids.size(), options.seed);
  std::vector<SimulatedTrial> trials;
  for (int i = 0; i < options.participants; ++i) {
    PersonDraws draws(options.seed, i);
    const BlockPerson person = DrawBlockPerson(&draws);
    int order = 0;
    for (const Pattern& pattern : PatternsOf(hybrids[drawn[static_cast<std::size_t>(i)]])) {
      const double length_s = options.seconds * TimesOf(pattern) * person.times *
                              (pattern.condition == kRealSpace ? 1.0 : person.hybrid_times) *
                              Share(&draws, kPatternSd);
      SimulatedTrial trial = PlanBlockTrial(options, layout, person, pattern, length_s);
      trial.setup.info.participant = CodeOf(i, options.participants);
      trial.setup.info.order = ++order;
      trial.file = fmt::format("{}_{:02}.db", trial.setup.info.participant, order);
      trials.push_back(std::move(trial));
    }
  }
  return trials;
}

}  // namespace elbowroom::control
