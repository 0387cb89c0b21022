// elbowroom contacts RIG.yml --frame N --mesh FILE: one part against the hull of one frame.
#include <fmt/format.h>

#include <memory>

#include "app/cli/options/command.h"
#include "app/cli/options/part_option.h"
#include "app/cli/options/recovery_option.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/cli/repeated_timing.h"
#include "app/cli/rig_frame.h"
#include "app/cli/way_out.h"
#include "recon/hull/visual_hull.h"
#include "review/contacts.h"

namespace elbowroom::cli {
namespace {

struct ContactsOptions {
  RigFrameOptions frame;
  PartOptions part;
  double resolution_mm = 0.0;
  core::RecoveryRule recovery;
  double silhouette_px = review::kReadyMaskPx;
};

// Keys without a meaning for the verdict are null.
nlohmann::json Json(const core::PartContact& contact) {
  nlohmann::json json = {{"verdict", ToString(contact.verdict)},
                         {"contact_points", contact.contact_point_count},
                         {"contact_area_mm2", contact.contact_area_mm2},
                         {"cp_obj_mm", nullptr},
                         {"cp_hull_mm", nullptr},
                         {"v_rec", nullptr},
                         {"d_rec_mm", nullptr},
                         {"n_hull", nullptr},
                         {"recovery_status", ToString(contact.recovery_status)},
                         {"depth_mm", nullptr},
                         {"deepest_mm", nullptr},
                         {"contained_mm", nullptr},
                         {"points", nlohmann::json::array()},
                         {"resolution_mm", contact.resolution_mm},
                         {"triangles", contact.count.triangles},
                         {"queries", contact.count.queries},
                         {"skipped", contact.count.skipped}};
  if (contact.recovery) {
    json["cp_obj_mm"] = JsonOf(contact.recovery->cp_obj_in_world_mm);
    json["cp_hull_mm"] = JsonOf(contact.recovery->cp_hull_in_world_mm);
    json["v_rec"] = JsonOf(contact.recovery->v_rec_in_world);
    json["d_rec_mm"] = contact.recovery->d_rec_mm;
    if (contact.recovery->n_hull_in_world) json["n_hull"] = JsonOf(*contact.recovery->n_hull_in_world);
  }
  if (contact.deepest) {
    json["depth_mm"] = contact.deepest->depth_mm;
    json["deepest_mm"] = JsonOf(contact.deepest->position_in_world_mm);
  }
  if (contact.contained_in_world_mm) json["contained_mm"] = JsonOf(*contact.contained_in_world_mm);
  for (const core::ContactPoint& point : contact.points)
    json["points"].push_back(JsonOf(point.position_in_world_mm));
  return json;
}

CommandResult Run(const ContactsOptions& options, const CommandContext& context, bool json) {
  // The mesh and its pose are read before the frame: an error in them is found sooner.
  const PosedPart posed = LoadPart(options.part, context);
  review::ContactOptions contact_options;
  contact_options.resolution_mm = options.resolution_mm;
  contact_options.recovery = options.recovery;
  contact_options.Validate();
  const RigFrame frame = LoadRigFrame(options.frame, context);
  const core::TriangleTree part(posed.mesh);
  const recon::VisualHull hull = recon::MakeVisualHull(frame.rig, frame.planes, frame.masks);
  core::PartContact contact;
  const auto compute = [&] {
    contact = review::FindContacts(hull, part, posed.world_from_part, 0, contact_options);
  };
  CommandResult result;
  const RunTimes times = ComputeAndTime(json, compute);
  const WayOut way_out =
      FindWayOut(hull, part, posed.world_from_part, options.recovery, contact, options.silhouette_px);
  result.json = Json(contact);
  AddWayOut(contact, way_out, &result.json);
  result.json["deviation_mm"] = posed.mesh->deviation_mm;
  AddTimes(times, &result.json);
  result.text = contact.verdict == core::Verdict::kContact
                    ? fmt::format("contact: {} points, {:.1f} mm2, at least {:.2f} mm deep",
                                  contact.contact_point_count, contact.contact_area_mm2,
                                  contact.deepest ? contact.deepest->depth_mm : 0.0) +
                          TextOf(contact, way_out)
                    : std::string(ToString(contact.verdict));
  return result;
}

}  // namespace

void AddContactsCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("contacts", "where a part touches the hull of one frame");
  auto options = std::make_shared<ContactsOptions>();
  AddRigFrameOptions(*command, &options->frame);
  AddPartOptions(*command, &options->part);
  command
      ->add_option("--resolution", options->resolution_mm,
                   "decide pieces of this size by their centre, mm (default: half a pixel's footprint)")
      ->check(PositiveLength());
  AddRecoveryOptions(*command, &options->recovery);
  command
      ->add_option("--silhouette-error", options->silhouette_px,
                   "how far off silhouettes may be, for the uncertainties, px (default: 0.5)")
      ->check(LengthFromZero().description("PX"));
  command->callback([=, &app] {
    CheckRecoveryOptions(options->recovery);
    const bool json = app.get_option("--json")->as<bool>();
    choice->action = [=](const CommandContext& context) { return Run(*options, context, json); };
  });
}

}  // namespace elbowroom::cli
