// elbowroom keepout S.db... --edge MM --out FILE: what real things took, to be left free by CAD.
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "app/cli/options/command.h"
#include "app/cli/options/file_ending.h"
#include "app/cli/options/frame_range_option.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/control/keep_out/keep_out_file.h"
#include "app/control/keep_out/keep_out_job.h"
#include "core/spread.h"

namespace elbowroom::cli {
namespace {

struct KeepoutOptions {
  control::KeepOutRequest request;
  std::string tool;
  std::filesystem::path out;
};

constexpr double kMiB = 1 << 20;

nlohmann::json KeepOutJson(const control::KeepOutRequest& request, const control::KeepOut& found) {
  const core::TriangleMesh& mesh = found.swept.mesh;
  return {{"vertices", mesh.vertices_mm.size()},
          {"triangles", mesh.triangles.size()},
          {"volume_mm3", core::VolumeMm3(mesh)},
          {"watertight", core::IsWatertight(mesh)},
          {"edge_mm", request.edge_mm},
          {"bound_mm", OrNull(found.bound_mm)},
          {"sessions", found.sessions},
          {"frames", found.frames},
          {"frames_without_camera", found.frames_without_camera},
          {"hulls", found.hulls},
          {"seconds", found.seconds},
          {"dwell_s", JsonOf(core::SpreadOf(found.swept.dwell_s))},
          {"queries", found.work.balls},
          {"bounded_cells", found.work.bounded_cells},
          {"skipped",
           {{"unchanged_frames", found.frames - found.hulls},
            {"covered_cells", found.work.covered_cells},
            {"buried_cells", found.work.buried_cells}}},
          {"memory_mib", static_cast<double>(found.bytes) / kMiB}};
}

CommandResult Run(const KeepoutOptions& options, const CommandContext& context) {
  CheckEnding("--out", options.out, {".stl", ".ply", ".glb"});
  control::KeepOutRequest request = options.request;
  if (!options.tool.empty()) request.tool = options.tool;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const control::KeepOut found = control::FindKeepOut(request, context.progress, context.stop);
  const double time_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  control::WriteKeepOut(request, found, options.out);
  CommandResult result;
  result.json = KeepOutJson(request, found);
  result.json["time_ms"] = time_ms;
  result.json["files"] = {options.out.string()};
  result.text =
      fmt::format("{}: {} triangles, {:.6g} mm3, holds what was real in {} frames ({:.4g} s), {}",
                  options.out.string(), found.swept.mesh.triangles.size(), core::VolumeMm3(found.swept.mesh),
                  found.frames, found.seconds, result.json["watertight"] ? "watertight" : "not watertight");
  if (found.frames_without_camera > 0)
    result.hint =
        fmt::format("{} frames are left out: each lacks a camera's picture", found.frames_without_camera);
  return result;
}

}  // namespace

void AddKeepoutCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("keepout", "the space that real things took in sessions, as a closed mesh");
  auto options = std::make_shared<KeepoutOptions>();
  command->add_option("SESSION", options->request.sessions, "the sessions (S.db), of one world frame")
      ->required();
  command->add_option("--edge", options->request.edge_mm, "edge length of the grid's cells, mm")
      ->required()
      ->check(PositiveLength());
  command->add_option("--out", options->out, "mesh to write (.stl, .ply, .glb)")->required();
  command->add_option("--tool", options->tool, "only while this tool is marked in use");
  AddFrameRangeOption(*command, &options->request.frames);
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
