#include "app/control/segmentation/segmentation_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/control/trial_file/trial_tables.h"
#include "core/error.h"
#include "recon/images/mask_image.h"

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

std::optional<double> NumberIfThere(const TomlEntry& entry, std::string_view key) {
  if (entry.Find(key) == nullptr) return std::nullopt;
  return entry.Number(key);
}

// What [[segmentation.camera]] says of single cameras.
std::vector<recon::CameraSegmentation> ReadCameras(const TomlEntry& segmentation,
                                                   const std::filesystem::path& file, const core::Rig& rig) {
  constexpr std::array<std::string_view, 4> kKeys{"name", "k_sigma", "floor_levels", "ignore"};
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

}  // namespace

SegmentationTable ReadSegmentation(const TomlEntry& root, const std::filesystem::path& file,
                                   const core::Rig& rig) {
  SegmentationTable read;
  recon::SegmentationOptions& options = read.options;
  const toml::node* node = root.Find("segmentation");
  if (node == nullptr) return read;
  if (!node->is_table()) root.Fail("segmentation", "must be written as [segmentation]");
  const TomlEntry entry(*node->as_table(), file.string(), "[segmentation]", kSegmentationKeys);
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
  options.cameras = ReadCameras(entry, file, rig);
  return read;
}

SegmentationTable ReadSegmentationFile(const std::filesystem::path& file, const core::Rig& rig) {
  const TrialTables tables = ReadTrialTables(file, "segmentation file");
  const TomlEntry root = tables.Root();
  if (root.Find("segmentation") == nullptr)
    root.FailAt(tables.table.source(),
                "has no [segmentation]; add that table, as in a trial file (an empty one: the defaults)");
  return ReadSegmentation(root, tables.file, rig);
}

}  // namespace elbowroom::control
