// elbowroom import FILE: what a CAD file holds, what is wrong with it, and the same model in another format.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/options/file_ending.h"
#include "app/cli/options/unit_option.h"
#include "app/control/import_picture.h"
#include "cad_import/cad_file.h"
#include "cad_import/formats/file_format.h"
#include "cad_import/mesh_file.h"
#include "cad_import/normalisation/surface_defects.h"
#include "core/error.h"
#include "core/size_text.h"
#include "recon/gl/scene/scene_renderer.h"
#include "recon/images/png_file.h"

namespace elbowroom::cli {
namespace {

struct ImportCommandOptions {
  std::filesystem::path file;
  cad_import::ImportOptions import;
  std::filesystem::path out;
  std::filesystem::path picture;
};

void WritePicture(const cad_import::CadModel& model, const std::filesystem::path& path,
                  const CommandContext& context) {
  const cad_import::SurfaceDefects defects = cad_import::FindDefects(model, context.progress, context.stop);
  context.progress.Report(0, 0, "drawing");
  recon::gl::SceneRenderer renderer;
  const recon::Image picture = control::ImportPicture(renderer, model, defects);
  core::ThrowIfStopped(context.stop, "the picture of the import");
  recon::WritePng(picture, path);
}

// Throws where the command would write over the file that it reads.
void CheckOutput(const char* option, const std::filesystem::path& output,
                 const std::filesystem::path& input) {
  std::error_code ignored;
  if (output.empty() || !std::filesystem::equivalent(output, input, ignored)) return;
  throw core::Error(
      core::ErrorKind::kFile,
      fmt::format("{} '{}': is the file that is read; choose another name", option, output.string()));
}

// The names that `layout add --node` takes; a file of one body has nothing to choose from.
std::string NodeLines(const std::vector<std::string>& nodes) {
  constexpr std::size_t kMost = 40;
  if (nodes.size() < 2) return "";
  std::string text = "\nnodes:";
  for (std::size_t i = 0; i < std::min(nodes.size(), kMost); ++i) text += "\n  " + nodes[i];
  if (nodes.size() > kMost)
    text += fmt::format("\n  and {} more; --json lists them all", nodes.size() - kMost);
  return text;
}

CommandResult Run(const ImportCommandOptions& options, const CommandContext& context) {
  CheckEnding("--picture", options.picture, {".png"});
  CheckOutput("--out", options.out, options.file);
  const cad_import::CadModel model =
      cad_import::ImportCadFile(options.file, options.import, context.progress, context.stop);
  const cad_import::ImportReport& report = model.report;
  if (!options.out.empty()) cad_import::WriteModelFile(model, options.out);
  if (!options.picture.empty()) WritePicture(model, options.picture, context);
  const Eigen::Vector3d low = report.bounds_mm.min(), high = report.bounds_mm.max();
  const std::vector<std::string> nodes = cad_import::NodesOf(model);
  CommandResult result;
  result.json = {{"parts", report.parts},
                 {"meshes", model.shapes.size()},
                 {"triangles", report.triangles},
                 {"unit", report.unit},
                 {"bounds_mm", {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}}},
                 {"watertight", report.watertight},
                 {"repaired", report.repaired},
                 {"dropped_triangles", report.dropped_triangles},
                 {"deviation_mm", report.deviation_mm},
                 {"nodes", nodes},
                 {"warnings", report.warnings}};
  const std::string shared =
      model.shapes.size() < model.instances.size() ? fmt::format(" of {} meshes", model.shapes.size()) : "";
  result.text =
      fmt::format("{}: {} part{}{}, {} triangles, {} mm (its unit: {}), {}", options.file.string(),
                  report.parts, report.parts == 1 ? "" : "s", shared, report.triangles,
                  core::SizeText(high - low), report.unit, report.watertight ? "watertight" : "open");
  if (report.deviation_mm > 0.0)
    result.text += fmt::format(", triangles within {:.2g} mm of its faces", report.deviation_mm);
  result.text += NodeLines(nodes);
  for (const std::string& warning : report.warnings) result.text += "\nwarning: " + warning;
  if (!options.out.empty()) {
    const bool is_glb = cad_import::FindFormat(options.out) == cad_import::FileFormat::kGlb;
    result.text += fmt::format("\nwritten: {}, in {}", options.out.string(), is_glb ? "m, as GLB is" : "mm");
    result.json["out"] = options.out.string();
  }
  if (!options.picture.empty()) {
    result.text += "\npicture: " + options.picture.string();
    result.json["picture"] = options.picture.string();
  }
  return result;
}

}  // namespace

void AddImportCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("import", "check a CAD file and report its size, unit and defects");
  auto options = std::make_shared<ImportCommandOptions>();
  command
      ->add_option("FILE", options->file,
                   "STEP, IGES, BREP, STL, OBJ, PLY, OFF, glTF, GLB, 3MF, COLLADA, FBX or 3DS")
      ->required();
  AddUnitOption(*command, &options->import.unit);
  command
      ->add_option("--tolerance", options->import.tolerance_mm,
                   "STEP, IGES, BREP: how far triangles may be from the faces, mm (default: 0.2, or a "
                   "thousandth of a body's diagonal if that is less)")
      ->check(PositiveLength());
  command
      ->add_option_function<double>(
          "--memory-gib",
          [options](double gib) {
            options->import.limits.memory_bytes = std::llround(gib * 1024.0 * 1024.0 * 1024.0);
          },
          "memory that reading the file may take (default: 4)")
      ->check(CLI::Range(0.1, 1024.0));
  command
      ->add_option("--time-s", options->import.limits.time_s,
                   "time that reading the file may take (default: 120)")
      ->check(CLI::Range(0.1, 86'400.0));
  command->add_option("--out", options->out,
                      "write the model: .glb with parts, names and colours; .ply, .stl as one mesh");
  command->add_option("--picture", options->picture,
                      "write a picture of the parts, with open edges and other defects drawn over it (.png)");
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
