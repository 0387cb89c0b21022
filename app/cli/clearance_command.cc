// elbowroom clearance RIG.yml --frame N --mesh FILE: how far a part is from the hull of one frame.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "app/cli/options/command.h"
#include "app/cli/options/part_option.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/cli/repeated_timing.h"
#include "app/cli/rig_frame.h"
#include "recon/error_budget/hull_errors.h"
#include "recon/hull/visual_hull.h"
#include "review/clearance.h"
#include "review/part_review.h"

namespace elbowroom::cli {
namespace {

struct ClearanceCommandOptions {
  RigFrameOptions frame;
  PartOptions part;
  review::ClearanceOptions clearance;
  std::optional<double> required_mm;
  std::optional<double> uncertainty_mm;
};

nlohmann::json Json(const review::Clearance& clearance) {
  const core::ClearanceInterval& interval = clearance.interval;
  const auto witness = [&](const Eigen::Vector3d& x) {
    return clearance.has_witnesses ? JsonOf(x) : nlohmann::json();
  };
  return {{"lower_mm", OrNull(interval.lower_mm)},
          {"upper_mm", OrNull(interval.upper_mm)},
          {"witness_part_mm", witness(interval.witness_part_in_world_mm)},
          {"witness_hull_mm", witness(interval.witness_hull_in_world_mm)},
          {"meets", clearance.meets},
          {"queries", clearance.queries},
          {"distances", clearance.distances},
          {"cells_left", clearance.cells_left}};
}

std::string TextOf(const review::Clearance& clearance) {
  const core::ClearanceInterval& interval = clearance.interval;
  if (clearance.meets) return "contact: part and hull meet";
  if (std::isinf(interval.lower_mm)) return "clear: the hull has no points in this frame";
  if (std::isinf(interval.upper_mm)) return fmt::format("at least {:.3f} mm", interval.lower_mm);
  return fmt::format("{:.3f} to {:.3f} mm", interval.lower_mm, interval.upper_mm);
}

// What a verdict allows for: as given, or computed from the rig's covariance, or nothing.
std::optional<core::ErrorBudget> BudgetOf(const RigFrame& frame, const recon::VisualHull& hull,
                                          const core::TriangleTree& part,
                                          const core::RigidTransform& world_from_part,
                                          const review::Clearance& clearance) {
  if (!frame.quality.errors) return std::nullopt;
  const recon::HullErrors errors(*frame.rig, *frame.quality.errors);
  if (!clearance.has_witnesses) return errors.WorstIn(core::BoxAround(part, world_from_part));
  const core::ClearanceInterval& interval = clearance.interval;
  if (clearance.meets) return errors.WorstAt(interval.witness_hull_in_world_mm);
  return errors.At(hull, interval.witness_hull_in_world_mm, interval.witness_part_in_world_mm);
}

void AddVerdict(double required_mm, const review::Clearance& clearance, double allowed_mm,
                const core::RigQuality& quality, CommandResult* result) {
  review::PartReviewOptions review;
  review.required_clearance_mm = required_mm;
  review.is_rig_refuted = quality.is_refuted();
  const core::Verdict verdict = review.VerdictOf(clearance, allowed_mm);
  result->json["verdict"] = ToString(verdict);
  result->json["required_mm"] = required_mm;
  result->text += fmt::format("; {} mm required, +- {:.2g} mm allowed for: {}", required_mm, allowed_mm,
                              ToString(verdict));
}

CommandResult Run(const ClearanceCommandOptions& options, const CommandContext& context, bool json) {
  options.clearance.Validate();
  // The mesh and its pose are read before the frame: an error in them is found sooner.
  const PosedPart posed = LoadPart(options.part, context);
  const RigFrame frame = LoadRigFrame(options.frame, context);
  const core::TriangleTree part(posed.mesh);
  const recon::VisualHull hull = recon::MakeVisualHull(frame.rig, frame.planes, frame.masks);
  review::Clearance clearance;
  const auto compute = [&] {
    clearance = review::FindClearance(hull, part, posed.world_from_part, options.clearance);
  };
  CommandResult result;
  const RunTimes times = ComputeAndTime(json, compute);
  result.json = Json(clearance);
  result.json["deviation_mm"] = posed.mesh->deviation_mm;
  AddTimes(times, &result.json);
  const std::optional<core::ErrorBudget> budget =
      options.uncertainty_mm ? std::nullopt : BudgetOf(frame, hull, part, posed.world_from_part, clearance);
  const double allowed_mm = budget ? budget->ExpandedMm() : options.uncertainty_mm.value_or(0.0);
  result.json["uncertainty_mm"] = allowed_mm;
  result.json["budget"] = budget ? JsonOf(*budget) : nlohmann::json();
  result.text = TextOf(clearance);
  if (options.required_mm) {
    AddVerdict(*options.required_mm, clearance, allowed_mm, frame.quality, &result);
  }
  return result;
}

}  // namespace

void AddClearanceCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("clearance", "how far a part is from the hull of one frame");
  auto options = std::make_shared<ClearanceCommandOptions>();
  AddRigFrameOptions(*command, &options->frame);
  AddPartOptions(*command, &options->part);
  command->add_option("--tolerance", options->clearance.tolerance_mm, "between the bounds, mm (default: 1)")
      ->check(PositiveLength());
  command->add_option("--required", options->required_mm, "clearance that is required: adds a verdict, mm")
      ->check(PositiveLength());
  command
      ->add_option(
          "--uncertainty", options->uncertainty_mm,
          "what the verdict allows for the rig and the part, mm (default: computed where RIG.yml has a "
          "covariance, else 0)")
      ->check(LengthFromZero());
  command->callback([=, &app] {
    const bool json = app.get_option("--json")->as<bool>();
    choice->action = [=](const CommandContext& context) { return Run(*options, context, json); };
  });
}

}  // namespace elbowroom::cli
