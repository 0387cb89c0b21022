// elbowroom view RIG.yml --frame N --camera VIEW.yml --method exact|sweep|sweep-gl: the hull as a camera sees
// it.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/options/file_ending.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/repeated_timing.h"
#include "app/cli/rig_frame.h"
#include "core/error.h"
#include "core/system/whole_file.h"
#include "recon/appearance/shaded_depth.h"
#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"
#include "recon/gl/paper_methods/plane_sweep_gl.h"
#include "recon/hull/visual_hull.h"
#include "recon/images/depth_file.h"
#include "recon/images/png_file.h"
#include "recon/paper_methods/plane_sweep.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::cli {
namespace {

constexpr const char* kExact = "exact";
constexpr const char* kSweep = "sweep";
constexpr const char* kSweepGl = "sweep-gl";

struct ViewOptions {
  RigFrameOptions frame;
  std::filesystem::path camera;
  std::string method = kExact;
  std::optional<double> spacing_mm;
  int undistortion_grid = 0;
  std::filesystem::path depth;
  std::filesystem::path image;
};

// What a method saw, and its counts.
struct HullSeen {
  recon::DepthMap picture;
  recon::PictureBuffer<Eigen::Vector3f> normal_in_world;  // none from a sweep
  nlohmann::json counts = nlohmann::json::object();
};

HullSeen Seen(recon::SweptView swept, const recon::PlaneSweepOptions& options) {
  return {std::move(swept.picture),
          {},
          {{"spacing_mm", options.spacing_mm},
           {"undistortion_grid", options.undistortion_grid},
           {"planes", swept.stats.planes},
           {"tested_points", swept.stats.tested_points},
           {"skipped_points", swept.stats.skipped_points}}};
}

HullSeen Seen(recon::HullView view) {
  return {{view.width_px, view.height_px, std::move(view.depth_mm), view.hit_pixels},
          std::move(view.normal_in_world),
          {{"skipped_pixels", view.skipped_pixels}}};
}

// Sees the frame by the chosen method. See() may be called again, to time it.
class Viewer {
 public:
  Viewer(const ViewOptions& options, const RigFrame& frame, const core::CameraModel& view,
         const recon::ViewRays& rays)
      : options_(options), frame_(frame), view_(view), rays_(rays) {
    if (options.method != kExact) sweep_rays_.emplace(view);
    if (options.method == kSweepGl) gl_.emplace();
    if (options.spacing_mm) sweep_.spacing_mm = *options.spacing_mm;
    sweep_.undistortion_grid = options.undistortion_grid;
  }

  [[nodiscard]] HullSeen See() {
    if (options_.method == kSweep)
      return Seen(recon::SweepPlanes(*frame_.rig, frame_.masks, view_, *sweep_rays_, sweep_), sweep_);
    if (options_.method == kSweepGl) {
      HullSeen seen =
          Seen(gl_->Sweep(*frame_.rig, frame_.masks, view_, *sweep_rays_, sweep_, Passes()), sweep_);
      seen.counts["driver"] = gl_->driver();
      return seen;
    }
    return Seen(recon::ViewHull(recon::MakeVisualHull(frame_.rig, frame_.planes, frame_.masks), rays_,
                                {.surfaces = false}));
  }

 private:
  // A grid goes with the paper's passes.
  [[nodiscard]] recon::gl::SweepPasses Passes() const {
    return sweep_.undistortion_grid > 0 ? recon::gl::SweepPasses::kOneAPlaneAndCamera
                                        : recon::gl::SweepPasses::kOneAPlane;
  }

  const ViewOptions& options_;
  const RigFrame& frame_;
  const core::CameraModel& view_;
  const recon::ViewRays& rays_;
  std::optional<recon::SweepRays> sweep_rays_;
  recon::PlaneSweepOptions sweep_;
  std::optional<recon::gl::PlaneSweepGl> gl_;
};

recon::ViewFile ReadView(const ViewOptions& options) {
  recon::ViewFile view = recon::ReadViewFile(options.camera);
  if (view.is_orthographic && options.method != kExact) {
    throw core::Error(core::ErrorKind::kCamera,
                      fmt::format("view file '{}': --method {} takes perspective views alone; take --method "
                                  "{} or remove 'projection'",
                                  options.camera.string(), options.method, kExact));
  }
  return view;
}

// Checks the names of the files to be written, before anything is computed.
void CheckFiles(const ViewOptions& options) {
  if (options.depth == options.image) {
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("--depth and --image are both '{}'; choose two names", options.depth.string()));
  }
  CheckEnding("--depth", options.depth, {".tiff", ".tif"});
  CheckEnding("--image", options.image, {".png"});
}

// An exact view from within the hull shows nothing, as its surface lies behind every ray's start.
std::string HintOfPlace(const ViewOptions& options, const recon::ViewFile& view, const RigFrame& frame) {
  if (options.method != kExact || view.is_orthographic) return {};
  if (!recon::MakeVisualHull(frame.rig, frame.planes, frame.masks).Contains(view.camera.center_in_world()))
    return {};
  return fmt::format("view file '{}': this camera stands inside the hull and sees nothing of it; move it out",
                     options.camera.string());
}

CommandResult Run(const ViewOptions& options, const CommandContext& context, bool json) {
  CheckFiles(options);
  const recon::ViewFile view = ReadView(options);
  const recon::ViewRays rays(
      view.camera, view.is_orthographic ? recon::Projection::kOrthographic : recon::Projection::kPerspective);
  const RigFrame frame = LoadRigFrame(options.frame, context);
  Viewer viewer(options, frame, view.camera, rays);
  HullSeen seen;
  const auto compute = [&] { seen = viewer.See(); };
  CommandResult result;
  AddTimes(ComputeAndTime(json, compute), &result.json);
  core::PendingFiles files;
  files.Write(options.depth, recon::EncodeDepthTiff(seen.picture));
  if (!options.image.empty()) {
    const std::vector<std::uint8_t> png =
        recon::EncodePng(recon::ShadeDepth(rays, seen.picture, seen.normal_in_world));
    files.Write(options.image, {reinterpret_cast<const char*>(png.data()), png.size()});
  }
  files.RenameAll();
  if (seen.picture.hit_pixels == 0) result.hint = HintOfPlace(options, view, frame);
  result.json.update(seen.counts);
  result.json["method"] = options.method;
  result.json["width"] = seen.picture.width_px;
  result.json["height"] = seen.picture.height_px;
  result.json["hit_pixels"] = seen.picture.hit_pixels;
  result.text = fmt::format("{}: {} x {}, the hull on {} pixels", options.depth.string(),
                            seen.picture.width_px, seen.picture.height_px, seen.picture.hit_pixels);
  return result;
}

}  // namespace

void AddViewCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("view", "how far the hull of one frame is from a camera, pixel by pixel");
  auto options = std::make_shared<ViewOptions>();
  AddRigFrameOptions(*command, &options->frame);
  command->add_option("--camera", options->camera, "the camera to see it from (VIEW.yml)")->required();
  command
      ->add_option("--method", options->method, "the surface itself, or the first of many planes in the hull")
      ->check(CLI::IsMember({kExact, kSweep, kSweepGl}))
      ->capture_default_str();
  command->add_option("--spacing", options->spacing_mm, "between a sweep's planes, mm (default: 15)")
      ->check(PositiveLength());
  command
      ->add_option(
          "--undistortion-grid", options->undistortion_grid,
          "cells a side into which a sweep divides each plane: only their corners go through the lenses "
          "(the paper: 5; 0: every point does)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("--depth", options->depth, "depths to write (.tiff: 32-bit float, mm, 0: nothing)")
      ->required();
  command->add_option("--image", options->image, "picture to write (.png)");
  command->callback([=, &app] {
    if (options->spacing_mm && options->method == kExact)
      throw CLI::ValidationError("--spacing",
                                 "is for --method sweep and sweep-gl; the exact view has no planes");
    if (options->undistortion_grid > 0 && options->method == kExact)
      throw CLI::ValidationError("--undistortion-grid",
                                 "is for --method sweep and sweep-gl; the exact view has no planes");
    const bool json = app.get_option("--json")->as<bool>();
    choice->action = [=](const CommandContext& context) { return Run(*options, context, json); };
  });
}

}  // namespace elbowroom::cli
