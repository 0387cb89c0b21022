// elbowroom hull RIG.yml --frame N --edge MM --out OUT.ply: the hull's surface as a mesh.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/repeated_timing.h"
#include "app/cli/rig_frame.h"
#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/hull_mesh.h"

namespace elbowroom::cli {
namespace {

struct HullOptions {
  RigFrameOptions frame;
  double edge_mm = 0.0;
  std::filesystem::path out;
};

CommandResult Run(const HullOptions& options, const CommandContext& context, bool json) {
  const RigFrame frame = LoadRigFrame(options.frame, context);
  recon::HullMesh hull;
  const auto compute = [&] {
    hull = recon::MeshHull(recon::MakeVisualHull(frame.rig, frame.planes, frame.masks), options.edge_mm,
                           context.progress, context.stop);
  };
  CommandResult result;
  AddTimes(ComputeAndTime(json, compute), &result.json);
  if (hull.mesh.triangles.empty()) {
    throw core::Error(
        core::ErrorKind::kGeometry,
        fmt::format("{}: the hull of frame {} is empty (or thinner than --edge); nothing to write to {}",
                    options.frame.rig_file.string(), options.frame.frame, options.out.string()));
  }
  cad_import::WriteMeshFile(hull.mesh, options.out);
  const double volume_mm3 = core::VolumeMm3(hull.mesh);
  const bool watertight = core::IsWatertight(hull.mesh);
  result.json["vertices"] = hull.mesh.vertices_mm.size();
  result.json["triangles"] = hull.mesh.triangles.size();
  result.json["volume_mm3"] = volume_mm3;
  result.json["watertight"] = watertight;
  result.json["cells"] = hull.cells;
  result.json["skipped_cells"] = hull.skipped_cells;
  result.json["queries"] = hull.queries;
  result.text =
      fmt::format("{}: {} triangles, {:.6g} mm3, {}", options.out.string(), hull.mesh.triangles.size(),
                  volume_mm3, watertight ? "watertight" : "not watertight");
  return result;
}

}  // namespace

void AddHullCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("hull", "write the hull of one frame as a closed mesh");
  auto options = std::make_shared<HullOptions>();
  AddRigFrameOptions(*command, &options->frame);
  command->add_option("--edge", options->edge_mm, "edge length of the mesh's cells, mm")
      ->required()
      ->check(PositiveLength());
  command->add_option("--out", options->out, "mesh to write (.ply, .stl, .glb)")->required();
  command->callback([=, &app] {
    const bool json = app.get_option("--json")->as<bool>();
    choice->action = [=](const CommandContext& context) { return Run(*options, context, json); };
  });
}

}  // namespace elbowroom::cli
