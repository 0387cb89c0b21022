#include "app/control/trial_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cad_import/layout/layout_file.h"
#include "cad_import/layout/toml_entry.h"
#include "core/error.h"
#include "recon/capture/live_rig.h"
#include "recon/capture/live_viewer.h"
#include "recon/capture/rig_source.h"
#include "recon/footage/recorded_rig.h"
#include "recon/footage/viewer_footage.h"
#include "recon/images/mask_image.h"
#include "recon/rig_files/rig_file.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::control {
namespace {

using cad_import::TomlEntry;

template <typename Value, typename Parse>
Value Choice(const TomlEntry& entry, std::string_view key, Value otherwise, Parse parse,
             std::string_view choices) {
  if (entry.Find(key) == nullptr) return otherwise;
  const std::optional<Value> value = parse(entry.Text(key));
  if (!value) entry.Fail(key, fmt::format("must be {}", choices));
  return *value;
}

constexpr std::array<std::string_view, 7> kSegmentationKeys{
    "method", "k_sigma", "floor_levels", "min_blob_px", "shadows", "boundary_sigma_px", "camera"};

struct SegmentationTable {
  recon::SegmentationOptions options;
  double boundary_sigma_px = core::kBoundarySigmaPx;
};

SegmentationTable ReadSegmentation(const TomlEntry& root, const std::string& file) {
  SegmentationTable read;
  recon::SegmentationOptions& options = read.options;
  const toml::node* node = root.Find("segmentation");
  if (node == nullptr) return read;
  if (!node->is_table()) root.Fail("segmentation", "must be written as [segmentation]");
  const TomlEntry entry(*node->as_table(), file, "[segmentation]", kSegmentationKeys);
  options.method =
      Choice(entry, "method", options.method, recon::ParseSegmentationMethod, R"("threshold" or "adaptive")");
  options.shadows =
      Choice(entry, "shadows", options.shadows, recon::ParseShadowRule, R"("keep" or "reject")");
  options.k_sigma = entry.NumberOr("k_sigma", options.k_sigma);
  options.floor_levels = entry.NumberOr("floor_levels", options.floor_levels);
  const double min_blob_px = entry.NumberOr("min_blob_px", options.min_blob_px);
  if (min_blob_px < 0.0 || min_blob_px > 1e9)
    entry.Fail("min_blob_px", "must be a number of pixels, 0 or more");
  options.min_blob_px = static_cast<int>(min_blob_px);
  read.boundary_sigma_px = entry.NumberOr("boundary_sigma_px", read.boundary_sigma_px);
  if (!(read.boundary_sigma_px >= 0.0))
    entry.Fail("boundary_sigma_px", "must be a number of pixels, 0 or more");
  try {
    options.Validate();
  } catch (const core::Error& error) {
    entry.FailAt(node->source(), error.what());
  }
  return read;
}

std::optional<double> NumberIfThere(const TomlEntry& entry, std::string_view key) {
  if (entry.Find(key) == nullptr) return std::nullopt;
  return entry.Number(key);
}

// What [[segmentation.camera]] says of single cameras.
std::vector<recon::CameraSegmentation> ReadCameraSegmentation(const TomlEntry& root,
                                                              const std::filesystem::path& file,
                                                              const core::Rig& rig) {
  const toml::node* node = root.Find("segmentation");
  if (node == nullptr) return {};
  constexpr std::array<std::string_view, 4> kKeys{"name", "k_sigma", "floor_levels", "ignore"};
  const TomlEntry segmentation(*node->as_table(), file.string(), "[segmentation]", kSegmentationKeys);
  std::vector<recon::CameraSegmentation> cameras;
  for (const TomlEntry& entry : segmentation.Entries("camera", kKeys)) {
    recon::CameraSegmentation camera{
        entry.Text("name"), NumberIfThere(entry, "k_sigma"), NumberIfThere(entry, "floor_levels"), {}};
    if (entry.Find("ignore") != nullptr) {
      const std::filesystem::path mask = file.parent_path() / entry.Text("ignore");
      camera.ignore =
          recon::ReadMaskImage(mask, fmt::format("the ignore mask of camera '{}'", camera.camera));
    }
    if (std::ranges::count(cameras, camera.camera, &recon::CameraSegmentation::camera) != 0)
      entry.Fail("name", fmt::format("is '{}' a second time", camera.camera));
    try {
      camera.Validate(rig);
    } catch (const core::Error& error) {
      entry.FailAt(entry.source(), error.what());
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

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

}  // namespace

TrialSetup ReadTrialFile(const std::filesystem::path& path, std::stop_token stop) {
  const toml::table table = cad_import::ParseTomlFile(path, "trial file");
  const TomlEntry root(table, path.string(), "",
                       {"rig", "layout", "participant", "task", "estimate_mm", "required_clearance_mm",
                        "uncertainty_mm", "tools", "segmentation", "viewer", "record"});
  TrialSetup setup;
  setup.info.participant = root.TextOr("participant", "");
  setup.info.task = root.TextOr("task", "");
  setup.info.estimate_mm = root.NumberOr("estimate_mm", 0.0);
  setup.info.required_clearance_mm = LengthFromZero(root, "required_clearance_mm");
  setup.info.uncertainty_mm = LengthFromZero(root, "uncertainty_mm");
  setup.info.tools = root.Texts("tools");
  const SegmentationTable segmentation = ReadSegmentation(root, path.string());
  setup.segmentation = segmentation.options;
  const std::filesystem::path folder = path.parent_path();
  cad_import::ImportedLayout imported = cad_import::ImportLayoutFile(folder / root.Text("layout"), {}, stop);
  setup.layout = core::WithPairsOfParts(std::move(imported.layout));
  setup.warnings = std::move(imported.warnings);
  recon::RigFile rig_file = recon::ReadRigFile(folder / root.Text("rig"));
  setup.segmentation.cameras = ReadCameraSegmentation(root, path, rig_file.rig);
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
      OpenSource(std::move(rig_file), ReadViewer(root, path), std::move(taps), stop, &setup.warnings);
  return setup;
}

std::map<std::string, std::string> SettingsOf(const recon::SegmentationOptions& options) {
  std::map<std::string, std::string> settings{
      {"segmentation.method", std::string(ToString(options.method))},
      {"segmentation.k_sigma", fmt::format("{}", options.k_sigma)},
      {"segmentation.floor_levels", fmt::format("{}", options.floor_levels)},
      {"segmentation.min_blob_px", fmt::format("{}", options.min_blob_px)},
      {"segmentation.max_hole_px", fmt::format("{}", options.max_hole_px)},
      {"segmentation.edge_slack_px", fmt::format("{}", options.edge_slack_px)},
      {"segmentation.shadow_darkest", fmt::format("{}", options.shadow_darkest)},
      {"segmentation.shadow_chroma", fmt::format("{}", options.shadow_chroma)},
      {"segmentation.shadows", std::string(ToString(options.shadows))}};
  for (const recon::CameraSegmentation& camera : options.cameras) {
    const std::string key = fmt::format("segmentation.camera.{}.", camera.camera);
    if (camera.k_sigma) settings[key + "k_sigma"] = fmt::format("{}", *camera.k_sigma);
    if (camera.floor_levels) settings[key + "floor_levels"] = fmt::format("{}", *camera.floor_levels);
    if (camera.ignore.width_px() != 0)
      settings[key + "ignored_pixels"] = fmt::format("{}", camera.ignore.CountObjectPixels());
  }
  return settings;
}

}  // namespace elbowroom::control
