#include "tests/accuracy/hard/hard_costs.h"

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>

#include "core/error.h"
#include "recon/exact_view/hull_view.h"
#include "tests/accuracy/hard/case_costs.h"
#include "tests/accuracy/hard/hard_assembly.h"
#include "tests/accuracy/hard/hard_errors.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

// From seeded places around the hull, all of it in the picture.
void AddViews(const SeenHull& seen, const HardOptions& options, const TimingEffort& effort, int width_px,
              int height_px, HardKind* kind) {
  constexpr int kPlacesTimes = 4, kCheckEvery = 8;
  recon::Random random(options.seed);
  const double radius_mm = 0.5 * seen.box_mm.diagonal().norm();
  for (int i = 0; i < kPlacesTimes * options.places_each; ++i) {
    const double away_mm = radius_mm * random.Uniform(2.0, 4.0);
    const Vector3d eye = seen.box_mm.center() + away_mm * random.Direction();
    core::CameraCalibration view =
        recon::HandView(width_px, height_px, 0.45 * height_px * away_mm / radius_mm).calibration();
    view.cam_from_world = core::CamFromWorldLookingAt(eye, seen.box_mm.center());
    const core::CameraModel camera(std::move(view));
    const recon::ViewRays rays(camera);
    const std::vector<std::function<void()>> job = {[&] { (void)recon::ViewHull(*seen.hull, rays); }};
    kind->costs.push_back({std::string(ToString(seen.which)), "-", fmt::format("view {}", i + 1),
                           TimeInTurns(job, 1, effort).front().median_ms,
                           static_cast<double>(recon::ViewHull(*seen.hull, rays).hit_pixels)});
    const ViewErrors errors = ErrorsOfView(*seen.hull, camera, kCheckEvery);
    kind->checked += errors.rays;
    kind->wrong += errors.wrong;
    kind->worst_error = std::max(kind->worst_error, errors.depth_share);
  }
}

// One query of the ball around the part for contacts, one for the clearance.
bool IsSettledByBall(const core::PartContact& answer) {
  return answer.count.queries == 1 && answer.clearance && answer.clearance->queries == 1;
}

// One part of the assembly in a frame: what it took, and whether the answer is right.
void AddPart(const SeenHull& seen, const HardAssembly& assembly, const HardCase& at, std::size_t part,
             const core::PartContact& answer, HardCost cost, HardKinds* kinds) {
  core::Require(answer.clearance.has_value(), "a clearance is required of each part");
  cost.part = fmt::format("part {}", part);
  cost.work = static_cast<double>(answer.count.queries + answer.clearance->queries);
  HardKind& kind = IsSettledByBall(answer) ? kinds->skipped : kinds->asked;
  kind.costs.push_back(std::move(cost));
  const core::ClearanceInterval& interval = answer.clearance->interval;
  const ClearanceErrors errors = ErrorsOf(interval, *seen.hull, assembly.TreeOf(part),
                                          at.world_from_part * assembly.instances[part].assembly_from_part);
  // A part that is sure to be far enough away needn't have a close upper bound.
  const bool is_far = interval.lower_mm >= AssemblyReview().EnoughMm();
  kind.Check(errors.bounds_hold, is_far ? 0.0 : errors.upper_mm);
}

// One frame of the assembly: all its parts, and each part.
void AddFrame(const SeenHull& seen, const HardAssembly& assembly, const HardCase& at,
              const TimingEffort& effort, HardKinds* kinds) {
  std::vector<review::InsideCells> inside;
  for (std::size_t i = 0; i < assembly.instances.size(); ++i) inside.emplace_back(assembly.TreeOf(i));
  std::vector<core::PartContact> answers(inside.size());
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = 0; i < inside.size(); ++i)
    jobs.emplace_back(
        [&, i] { answers[i] = ReviewOf(*seen.hull, assembly, at.world_from_part, i, &inside[i]); });
  const std::vector<Timing> timings = TimeInTurns(jobs, 1, effort);
  HardCost frame{std::string(ToString(seen.which)), "assembly", std::string(ToString(at.place)), 0.0, 0.0};
  for (std::size_t i = 0; i < timings.size(); ++i) {
    frame.ms += timings[i].median_ms;
    frame.work += IsSettledByBall(answers[i]) ? 0.0 : 1.0;
    AddPart(seen, assembly, at, i, answers[i], {frame.hull, "", frame.place, timings[i].median_ms, 0.0},
            kinds);
  }
  kinds->frame.costs.push_back(std::move(frame));
}

}  // namespace

std::vector<HardKind> MeasureHardCosts(const HardOptions& options, const TimingEffort& effort) {
  HardKinds kinds;
  const std::vector<HardPart> for_all = PartsForAll(options);
  const HardAssembly assembly = ImportHardAssembly(options.seed);
  for (const HardHull which : kHardHulls) {
    fmt::print(stderr, "hard: {}\n", ToString(which));
    const SeenHull seen = SeeHull(which, recon::ViewSceneRig::kFour);
    std::vector<HardPart> parts = for_all;
    for (HardPart& part : PartsAround(seen, options)) parts.push_back(std::move(part));
    for (const HardCase& hard_case : CasesOf(seen, parts, options))
      AddCaseCosts(seen, hard_case, effort, &kinds);
    AddViews(seen, options, effort, 640, 480, &kinds.view_of_four);
    AddViews(SeeHull(which, recon::ViewSceneRig::kEight), options, effort, 1280, 720, &kinds.view_of_eight);
    for (const HardCase& at : CasesOf(seen, {assembly.whole}, options))
      AddFrame(seen, assembly, at, effort, &kinds);
  }
  return kinds.InOrder();
}

}  // namespace elbowroom::accuracy
