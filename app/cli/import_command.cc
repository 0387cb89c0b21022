// elbowroom import FILE: what a mesh file holds, and the same mesh in another format.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "app/cli/command.h"
#include "app/cli/unit_option.h"
#include "cad_import/mesh_file.h"

namespace elbowroom::cli {
namespace {

struct ImportCommandOptions {
  std::filesystem::path file;
  std::optional<core::LengthUnit> unit;
  std::filesystem::path out;
};

CommandResult Run(const ImportCommandOptions& options) {
  const cad_import::ImportedMesh imported =
      cad_import::ImportMeshFile(options.file, {.unit = options.unit, .unit_if_file_has_none = std::nullopt});
  const cad_import::ImportReport& report = imported.report;
  if (!options.out.empty()) cad_import::WriteMeshFile(imported.mesh, options.out);
  const Eigen::Vector3d low = report.bounds_mm.min(), high = report.bounds_mm.max();
  CommandResult result;
  result.json = {{"parts", report.parts},
                 {"triangles", report.triangles},
                 {"unit", ToString(report.unit)},
                 {"bounds_mm", {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}}},
                 {"watertight", report.watertight},
                 {"repaired", report.repaired},
                 {"dropped_triangles", report.dropped_triangles},
                 {"warnings", report.warnings}};
  const Eigen::Vector3d size = high - low;
  result.text = fmt::format("{}: {} parts, {} triangles, {:.6g} x {:.6g} x {:.6g} mm (read in {}), {}",
                            options.file.string(), report.parts, report.triangles, size.x(), size.y(),
                            size.z(), ToString(report.unit), report.watertight ? "watertight" : "open");
  for (const std::string& warning : report.warnings) result.text += "\nwarning: " + warning;
  return result;
}

}  // namespace

void AddImportCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("import", "check a mesh file and report its size, unit and defects");
  auto options = std::make_shared<ImportCommandOptions>();
  command->add_option("FILE", options->file, "STL, OBJ, PLY, glTF or GLB")->required();
  AddUnitOption(*command, &options->unit);
  command->add_option("--out", options->out, "write the mesh (.glb, .ply, .stl)");
  command->callback([=] { choice->action = [=](const CommandContext&) { return Run(*options); }; });
}

}  // namespace elbowroom::cli
