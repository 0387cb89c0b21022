#include "app/control/calibration/calibration_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cad_import/layout/toml_entry.h"
#include "core/error.h"
#include "core/file_limits.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::control {
namespace {

using cad_import::TomlEntry;
using core::ErrorKind;

constexpr std::string_view kBoardKeys[] = {"type",      "columns",    "rows",   "square_mm",
                                           "marker_mm", "dictionary", "layout", "inverted"};
constexpr std::string_view kCameraKeys[] = {"name",         "frames",           "intrinsics",
                                            "timestamps",   "distortion_model", "known",
                                            "trial_frames", "background",       "masks"};
constexpr std::string_view kLengthKeys[] = {"length_mm", "tolerance_mm", "cameras", "pixels"};
constexpr std::string_view kPixelKeys[] = {"camera", "from_px", "to_px"};

int WholeNumber(const TomlEntry& entry, std::string_view key) {
  const double number = entry.Number(key);
  if (!(number >= 0.0 && number <= 1e6) || number != std::floor(number))
    entry.Fail(key, "must be a whole number");
  return static_cast<int>(number);
}

// A table of the file that must be written once, as [key].
const toml::table& TableOf(const TomlEntry& root, std::string_view key) {
  const toml::node* node = root.Find(key);
  if (node == nullptr || !node->is_table())
    root.Fail(key, fmt::format("is missing; it must be written as [{}]", key));
  return *node->as_table();
}

recon::Board ReadBoard(const TomlEntry& root, const std::string& file) {
  const TomlEntry entry(TableOf(root, "board"), file, "[board]", kBoardKeys);
  recon::Board board;
  const std::string kind = entry.Text("type");
  const std::optional<recon::BoardKind> parsed = recon::ParseBoardKind(kind);
  if (!parsed) {
    entry.Fail("type", fmt::format("is \"{}\"; it must be \"chessboard\", \"charuco\", \"apriltag\", "
                                   "\"circles\" or \"circles_asymmetric\"",
                                   kind));
  }
  board.kind = *parsed;
  board.columns = WholeNumber(entry, "columns");
  board.rows = WholeNumber(entry, "rows");
  board.square_mm = entry.Number("square_mm");
  if (board.has_markers()) {
    board.marker_mm = entry.Number("marker_mm");
    board.dictionary = entry.Text("dictionary");
  }
  const std::string layout = entry.TextOr("layout", "current");
  if (layout != "current" && layout != "legacy") entry.Fail("layout", "must be \"current\" or \"legacy\"");
  board.layout = layout == "legacy" ? recon::CharucoLayout::kLegacy : recon::CharucoLayout::kCurrent;
  board.inverted = entry.FlagOr("inverted", false);
  try {
    board.Validate();
  } catch (const core::Error& error) {
    entry.FailAt(entry.source(), error.what(), error.kind());
  }
  return board;
}

CameraFootage ReadCamera(const TomlEntry& entry, const std::filesystem::path& folder) {
  CameraFootage camera;
  camera.name = entry.Text("name");
  if (camera.name.empty() || camera.name.find('/') != std::string::npos)
    entry.Fail("name", "must be a name without '/'");
  camera.frames = recon::ResolvedLocation(entry.TextOr("frames", ""), folder);
  camera.intrinsics = recon::ResolvedLocation(entry.TextOr("intrinsics", ""), folder);
  if (camera.frames.empty())
    entry.Fail("frames", "is missing; name the pictures in which several cameras see the board at once");
  const auto path = [&](std::string_view key) {
    const std::string text = entry.TextOr(key, "");
    return text.empty() ? std::filesystem::path() : folder / text;
  };
  camera.trial.frames = recon::ResolvedLocation(entry.TextOr("trial_frames", ""), folder);
  camera.trial.background = recon::ResolvedLocation(entry.TextOr("background", ""), folder);
  camera.trial.masks = recon::ResolvedLocation(entry.TextOr("masks", ""), folder);
  camera.timestamps = path("timestamps");
  camera.known = path("known");
  const std::string model = entry.TextOr("distortion_model", "auto");
  camera.lens_model = core::ParseDistortionModel(model);
  if (!camera.lens_model && model != "auto") {
    entry.Fail("distortion_model",
               fmt::format("is \"{}\"; it must be \"plumb_bob\", \"rational_polynomial\", "
                           "\"fisheye\" or \"auto\"",
                           model));
  }
  return camera;
}

Eigen::Vector2d Pixel(const TomlEntry& entry, std::string_view key) {
  const toml::node* node = entry.Find(key);
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  Eigen::Vector2d pixel;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto number =
        array != nullptr && array->size() == 2 ? array->get(i)->value<double>() : std::nullopt;
    if (!number || !std::isfinite(*number)) entry.Fail(key, "must be two numbers, [x, y] in pixels");
    pixel[static_cast<Eigen::Index>(i)] = *number;
  }
  return pixel;
}

KnownLength ReadLength(const TomlEntry& entry) {
  KnownLength known;
  known.length_mm = entry.Number("length_mm");
  known.tolerance_mm = entry.NumberOr("tolerance_mm", 0.0);
  if (!(known.length_mm > 0.0)) entry.Fail("length_mm", "must be more than 0");
  if (!(known.tolerance_mm >= 0.0)) entry.Fail("tolerance_mm", "must not be negative");
  known.cameras = entry.Texts("cameras");
  for (const TomlEntry& pixel : entry.Entries("pixels", kPixelKeys))
    known.pixels.push_back({pixel.Text("camera"), Pixel(pixel, "from_px"), Pixel(pixel, "to_px")});
  const bool is_between_cameras = known.cameras.size() == 2 && known.pixels.empty();
  if (!is_between_cameras && (!known.cameras.empty() || known.pixels.size() < 2)) {
    entry.FailAt(entry.source(),
                 "a known length is between two `cameras`, or its ends are given by `pixels` of two or more "
                 "cameras");
  }
  known.title = is_between_cameras ? fmt::format("between {} and {}", known.cameras[0], known.cameras[1])
                                   : fmt::format("seen by {}", known.pixels.front().camera);
  return known;
}

Eigen::AlignedBox3d ReadWorkspace(const TomlEntry& entry) {
  const toml::node* node = entry.Find("workspace_mm");
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  constexpr const char* kShape = "must be [x0, y0, z0, x1, y1, z1] in millimetres";
  if (array == nullptr || array->size() != 6) entry.Fail("workspace_mm", kShape);
  double n[6];
  for (std::size_t i = 0; i < 6; ++i) {
    const auto number = array->get(i)->value<double>();
    if (!number || !(std::abs(*number) <= core::kLongestLengthMm)) entry.Fail("workspace_mm", kShape);
    n[i] = *number;
  }
  Eigen::AlignedBox3d box(Eigen::Vector3d(n[0], n[1], n[2]), Eigen::Vector3d(n[3], n[4], n[5]));
  if (!((box.max() - box.min()).minCoeff() > 0.0))
    entry.Fail("workspace_mm",
               "is empty; each of its last three numbers must be larger than that of the first three",
               ErrorKind::kRange);
  return box;
}

void ReadWorld(const TomlEntry& root, const std::string& file, CalibrationFile* calibration) {
  const TomlEntry entry(TableOf(root, "world"), file, "[world]", {"board_frame", "camera", "workspace_mm"});
  calibration->world_camera = entry.TextOr("camera", "");
  if (entry.Find("board_frame") != nullptr) calibration->board_frame = WholeNumber(entry, "board_frame");
  if (calibration->board_frame.has_value() != calibration->world_camera.empty()) {
    entry.FailAt(entry.source(),
                 "needs either board_frame, where the board lies on the table, or camera, whose frame is the "
                 "world's");
  }
  calibration->workspace_mm = ReadWorkspace(entry);
}

void RequireNames(const TomlEntry& root, const CalibrationFile& calibration) {
  std::set<std::string> names;
  for (const CameraFootage& camera : calibration.cameras) {
    if (!names.insert(camera.name).second)
      root.Fail("camera", fmt::format("'{}' occurs twice; give every camera its own name", camera.name));
  }
  const auto require = [&](std::string_view key, const std::string& name) {
    if (!names.contains(name)) root.Fail(key, fmt::format("names '{}', which is no [[camera]]", name));
  };
  if (!calibration.world_camera.empty()) require("world", calibration.world_camera);
  for (const KnownLength& known : calibration.lengths) {
    for (const std::string& name : known.cameras) require("known_length", name);
    for (const KnownLength::Pixel& pixel : known.pixels) require("known_length", pixel.camera);
  }
}

// Where the calibrated cameras bring their pictures from in a trial, and what they are set to.
void TakeLiveCameras(const TomlEntry& root, const recon::RigFile& live, CalibrationFile* calibration) {
  for (CameraFootage& camera : calibration->cameras) {
    const auto same =
        std::ranges::find(live.rig.cameras, camera.name, [](const core::CameraModel& c) { return c.name(); });
    if (same == live.rig.cameras.end())
      root.Fail("live", fmt::format("names a file without a camera '{}'", camera.name));
    if (!camera.trial.frames.empty())
      root.Fail("live", fmt::format("and trial_frames both say where the pictures of camera '{}' come from",
                                    camera.name));
    const recon::CameraSources& sources =
        live.sources[static_cast<std::size_t>(same - live.rig.cameras.begin())];
    camera.trial.frames = sources.frames;
    camera.trial.capture = sources.capture;
  }
}

}  // namespace

CalibrationFile ReadCalibrationFile(const std::filesystem::path& path) {
  const toml::table table = cad_import::ParseTomlFile(path, "calibration file");
  const std::string file = path.string();
  const TomlEntry root(table, file, "", {"board", "camera", "world", "known_length", "live"});
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  CalibrationFile calibration;
  calibration.board = ReadBoard(root, file);
  for (const TomlEntry& entry : root.Entries("camera", kCameraKeys))
    calibration.cameras.push_back(ReadCamera(entry, folder));
  if (calibration.cameras.empty()) root.Fail("camera", "is missing; write a [[camera]] for each camera");
  if (calibration.cameras.size() > core::kMostCameras)
    root.Fail("camera", fmt::format("occurs {} times; at most {} cameras can be used",
                                    calibration.cameras.size(), core::kMostCameras));
  if (const std::string live = root.TextOr("live", ""); !live.empty())
    TakeLiveCameras(root, recon::ReadRigFile(folder / live, recon::RigUse::kPictures), &calibration);
  for (const TomlEntry& entry : root.Entries("known_length", kLengthKeys))
    calibration.lengths.push_back(ReadLength(entry));
  ReadWorld(root, file, &calibration);
  RequireNames(root, calibration);
  return calibration;
}

}  // namespace elbowroom::control
