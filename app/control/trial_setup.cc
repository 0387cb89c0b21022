#include "app/control/trial_setup.h"

#include <fmt/format.h>

#include <utility>

#include "app/control/procedure/procedure_table.h"
#include "app/control/segmentation/segmentation_table.h"
#include "app/control/trial_file/trial_tables.h"
#include "cad_import/layout/layout_file.h"
#include "cad_import/layout/toml_entry.h"
#include "core/error.h"
#include "recon/capture/live_rig.h"
#include "recon/capture/live_viewer.h"
#include "recon/capture/rig_source.h"
#include "recon/footage/recorded_rig.h"
#include "recon/footage/viewer_footage.h"
#include "recon/rig_files/rig_file.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::control {
namespace {

using cad_import::TomlEntry;

struct ViewerEntry {
  core::CameraModel camera;
  std::string location;
};

// The camera that [viewer] names, if it is there.
std::optional<ViewerEntry> ReadViewer(const TomlEntry& root, const std::filesystem::path& file) {
  const toml::node* node = root.Find("viewer");
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) root.Fail("viewer", "must be written as [viewer]");
  const TomlEntry entry(*node->as_table(), file.string(), "[viewer]", {"camera", "frames"});
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  const recon::ViewFile view = recon::ReadViewFile(folder / entry.Text("camera"));
  if (view.is_orthographic) entry.Fail("camera", "must name a perspective camera; this one is orthographic");
  return ViewerEntry{view.camera, recon::ResolvedLocation(entry.Text("frames"), folder)};
}

std::shared_ptr<recon::FrameSetSource> RecordedWithViewer(std::shared_ptr<recon::RecordedRig> rig,
                                                          const ViewerEntry& viewer,
                                                          const std::stop_token& stop,
                                                          std::vector<std::string>* warnings) {
  auto footage = std::make_shared<recon::ViewerFootage>(std::move(rig), viewer.camera, viewer.location, stop);
  const core::FrameIndex viewer_frames = footage->viewer_frame_count();
  const std::optional<core::FrameIndex> rig_frames = footage->frame_count();
  if (!rig_frames || viewer_frames < *rig_frames) {
    warnings->push_back(
        fmt::format("the viewer's footage '{}' ends after {} frames; later ones take their colours from the "
                    "rig's cameras",
                    viewer.location, viewer_frames));
  }
  return footage;
}

// The rig's frame sets, with the pictures of the viewer camera if the trial has one.
std::shared_ptr<recon::FrameSetSource> OpenSource(recon::RigFile rig_file,
                                                  const std::optional<ViewerEntry>& viewer,
                                                  recon::LiveTaps taps, const std::stop_token& stop,
                                                  std::vector<std::string>* warnings) {
  if (!viewer) return recon::OpenRig(std::move(rig_file), stop, std::move(taps));
  const bool is_live = recon::IsLiveRig(rig_file);
  if (is_live != recon::IsLive(viewer->location)) {
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format("the viewer's pictures '{}' {} live, and those of rig '{}' {}; use both live, or "
                    "both recorded",
                    viewer->location, is_live ? "aren't" : "are", rig_file.rig.name,
                    is_live ? "are" : "aren't"));
  }
  if (is_live) {
    return std::make_shared<recon::LiveViewer>(recon::OpenRig(std::move(rig_file), stop, std::move(taps)),
                                               viewer->camera, viewer->location);
  }
  return RecordedWithViewer(std::make_shared<recon::RecordedRig>(std::move(rig_file), stop), *viewer, stop,
                            warnings);
}

// Null: the trial keeps silhouettes, or its footage is recorded already.
std::shared_ptr<recon::FootageRecorder> RecorderFor(const TomlEntry& root, const recon::RigFile& rig_file,
                                                    std::vector<std::string>* warnings) {
  const std::string record = root.TextOr("record", "silhouettes");
  if (record == "silhouettes") return nullptr;
  if (record != "footage") root.Fail("record", R"(must be "silhouettes" or "footage")");
  if (recon::IsLiveRig(rig_file)) return std::make_shared<recon::FootageRecorder>(rig_file);
  warnings->push_back(fmt::format(
      "record = \"footage\" is for live cameras; those of rig '{}' are recorded already", rig_file.rig.name));
  return nullptr;
}

double LengthFromZero(const TomlEntry& entry, std::string_view key) {
  const double length_mm = entry.NumberOr(key, 0.0);
  if (!(length_mm >= 0.0)) entry.Fail(key, "must not be negative");
  return length_mm;
}

core::TrialInfo InfoFrom(const TrialTables& tables) {
  const TomlEntry root = tables.Root();
  core::TrialInfo info;
  info.participant = root.TextOr("participant", "");
  info.task = root.TextOr("task", "");
  info.estimate_mm = root.NumberOr("estimate_mm", 0.0);
  info.required_clearance_mm = LengthFromZero(root, "required_clearance_mm");
  info.uncertainty_mm = LengthFromZero(root, "uncertainty_mm");
  info.tools = root.Texts("tools");
  ReadProcedure(root, tables.file.parent_path(), &info);
  if (const auto planned = tables.Planned()) ReadPlanned(*planned, &info);
  return info;
}

}  // namespace

core::TrialInfo ReadTrialInfo(const std::filesystem::path& path) { return InfoFrom(ReadTrialTables(path)); }

TrialSetup ReadTrialFile(const std::filesystem::path& path, std::stop_token stop) {
  const TrialTables tables = ReadTrialTables(path);
  const TomlEntry root = tables.Root();
  TrialSetup setup;
  setup.info = InfoFrom(tables);
  const std::filesystem::path folder = tables.file.parent_path();
  setup.layout_file = folder / root.Text("layout");
  cad_import::ImportedLayout imported = cad_import::ImportLayoutFile(setup.layout_file, {}, stop);
  setup.layout = core::WithPairsOfParts(std::move(imported.layout));
  setup.sections = std::move(imported.sections);
  setup.warnings = std::move(imported.warnings);
  recon::RigFile rig_file = recon::ReadRigFile(folder / root.Text("rig"));
  SegmentationTable segmentation = ReadSegmentation(root, tables.file, rig_file.rig);
  setup.segmentation = std::move(segmentation.options);
  setup.rig_quality = recon::QualityOf(rig_file);
  core::RigQuality& quality = setup.rig_quality;
  if (root.Find("uncertainty_mm") != nullptr) quality.errors.reset();  // what the trial says wins
  if (quality.errors) quality.errors->boundary_sigma_px = segmentation.boundary_sigma_px;
  if (quality.is_refuted()) {
    setup.warnings.push_back(
        fmt::format("the gauge of rig '{}' failed ({:.2f} mm off, {:.2f} mm is the bound): no part will be "
                    "near or clear, but "
                    "undecided; calibrate the rig again, and gauge it",
                    rig_file.rig.name, quality.gauge->error_mm, quality.gauge->bound_mm));
  }
  setup.footage = RecorderFor(root, rig_file, &setup.warnings);
  recon::LiveTaps taps = setup.footage ? setup.footage->Taps() : recon::LiveTaps();
  setup.source =
      OpenSource(std::move(rig_file), ReadViewer(root, tables.file), std::move(taps), stop, &setup.warnings);
  return setup;
}

}  // namespace elbowroom::control
