#include "app/cli/options/part_option.h"

#include "app/cli/options/unit_option.h"
#include "cad_import/mesh_file.h"
#include "recon/rig_files/pose_file.h"

namespace elbowroom::cli {

void AddPartOptions(CLI::App& command, PartOptions* options) {
  command.add_option("--mesh", options->mesh, "the part")->required();
  AddUnitOption(command, &options->unit);
  command.add_option("--world-from-part", options->world_from_part,
                     "the part's pose (YAML); default: where its file has it");
}

PosedPart LoadPart(const PartOptions& options, const CommandContext& context) {
  PosedPart part;
  part.mesh =
      cad_import::ImportMeshFile(options.mesh, {.unit = options.unit}, context.progress, context.stop).mesh;
  if (!options.world_from_part.empty()) part.world_from_part = recon::ReadPoseFile(options.world_from_part);
  return part;
}

}  // namespace elbowroom::cli
