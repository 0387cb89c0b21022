#include "app/control/calibration/rig_import.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/control/calibration/board_footage.h"
#include "app/control/calibration/board_views.h"
#include "app/control/calibration/foreign_files.h"
#include "core/error.h"
#include "core/system/utc_time.h"
#include "recon/calibration/rig_check.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;
using core::RigidTransform;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using recon::ForeignCamera;
using recon::ForeignRig;

[[noreturn]] void FailOf(const ForeignCamera& camera, const std::string& what) {
  throw Error(ErrorKind::kCamera, fmt::format("camera '{}': {}", camera.name, what));
}

void RequirePoses(const ForeignRig& rig) {
  if (rig.cameras.empty()) throw Error(ErrorKind::kFormat, "the files have no camera");
  for (const ForeignCamera& camera : rig.cameras)
    if (!camera.stated)
      FailOf(camera,
             "its file has a lens, but doesn't say where it stands; use the file as known = \"…\" in "
             "CALIB.toml, and calibrate");
  const auto is_as_first = [&](const ForeignCamera& camera) {
    return !camera.projection && camera.stated->rotation == rig.cameras.front().stated->rotation &&
           camera.stated->translation == rig.cameras.front().stated->translation;
  };
  if (rig.cameras.size() > 1 && !rig.is_chain && std::ranges::all_of(rig.cameras, is_as_first))
    throw Error(ErrorKind::kCamera,
                "the files say of all cameras that they stand in one place, so they have lenses "
                "only; use them as known = \"…\" in CALIB.toml, and calibrate");
}

void PutSizes(const RigImportOptions& options, ForeignRig* rig) {
  for (ForeignCamera& camera : rig->cameras) {
    if (camera.lens.image_width_px != 0) continue;
    if (!options.size_px) FailOf(camera, "its file doesn't say the pictures' size; say --size WIDTH HEIGHT");
    camera.lens.image_width_px = (*options.size_px)[0];
    camera.lens.image_height_px = (*options.size_px)[1];
  }
}

// The world with its z axis along an axis of the file.
RigidTransform WorldFromFile(const Vector3d& up_in_file) {
  return {Eigen::Quaterniond::FromTwoVectors(up_in_file, Vector3d::UnitZ()).toRotationMatrix(),
          Vector3d::Zero()};
}

recon::RigFile RigFileOf(std::vector<core::CameraCalibration> calibrations,
                         const RigidTransform& world_from_file, const std::string& rig_name) {
  recon::RigFile file;
  file.rig.name = rig_name;
  const RigidTransform file_from_world = world_from_file.Inverse();
  for (core::CameraCalibration& calibration : calibrations) {
    calibration.cam_from_world = calibration.cam_from_world * file_from_world;
    file.rig.cameras.emplace_back(std::move(calibration));
    file.sources.emplace_back();
  }
  return file;
}

// A cube around the point nearest to all optical axes. Its edge is 0.8 of the cameras' median distance.
Eigen::AlignedBox3d GuessedWorkspace(const core::Rig& rig) {
  constexpr double kHalfEdgeShare = 0.4;
  constexpr double kLeastAngleRad = 5.0 * std::numbers::pi / 180.0;
  Matrix3d sum = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const core::CameraModel& camera : rig.cameras) {
    const Vector3d axis = camera.cam_from_world().rotation.row(2).transpose();
    const Matrix3d across = Matrix3d::Identity() - axis * axis.transpose();
    sum += across;
    right += across * camera.center_in_world();
  }
  const double least = Eigen::SelfAdjointEigenSolver<Matrix3d>(sum).eigenvalues()[0];
  const Vector3d middle = sum.ldlt().solve(right);
  std::vector<double> distances_mm;
  for (const core::CameraModel& camera : rig.cameras)
    distances_mm.push_back((camera.cam_from_world() * middle).z());
  const bool is_seen =
      std::ranges::all_of(distances_mm, [](double distance_mm) { return distance_mm > 0.0; });
  if (!(least > kLeastAngleRad * kLeastAngleRad) || !is_seen)
    throw Error(ErrorKind::kRange,
                "where the cameras look doesn't tell the workspace; say --workspace X0 Y0 Z0 X1 Y1 "
                "Z1 in mm");
  std::ranges::sort(distances_mm);
  const double half_mm = kHalfEdgeShare * distances_mm[distances_mm.size() / 2];
  return {middle - Vector3d::Constant(half_mm), middle + Vector3d::Constant(half_mm)};
}

// --- with a check

std::optional<std::size_t> PlaceOf(const ForeignRig& rig, const std::string& name) {
  const auto find = [&](const auto& is_it) -> std::optional<std::size_t> {
    const auto found = std::ranges::find_if(rig.cameras, is_it);
    if (found == rig.cameras.end()) return std::nullopt;
    return static_cast<std::size_t>(found - rig.cameras.begin());
  };
  const auto exact = find([&](const ForeignCamera& camera) { return camera.name == name; });
  return exact ? exact : find([&](const ForeignCamera& camera) {
    return recon::IsSameCamera(camera.name, name) || recon::IsSameCamera(camera.alias, name);
  });
}

// For each camera of the check, its place in the rig.
std::vector<std::size_t> MatchedCameras(const ForeignRig& rig, const CalibrationFile& check,
                                        std::vector<std::string>* warnings) {
  std::vector<std::size_t> places;
  std::string unmatched;
  for (const CameraFootage& camera : check.cameras) {
    const auto place = PlaceOf(rig, camera.name);
    if (place) places.push_back(*place);
    if (!place) unmatched += fmt::format("{}'{}'", unmatched.empty() ? "" : ", ", camera.name);
  }
  if (unmatched.empty()) return places;
  std::string names;
  for (const ForeignCamera& camera : rig.cameras)
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", camera.name);
  if (!places.empty() || rig.cameras.size() != check.cameras.size())
    throw Error(ErrorKind::kCamera,
                fmt::format("the files have no camera {}, but {}; name the cameras of the check as there",
                            unmatched, names));
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) places.push_back(i);
  warnings->push_back(
      fmt::format("no name fits: the cameras {} are taken as those of the check, in its order", names));
  return places;
}

// Cameras that the check doesn't have get the size of its first; nothing is asked of them.
void PutFootageSizes(const BoardFootage& footage, MatchedRig* matched) {
  const auto put = [](const CameraSightings& seen, core::CameraCalibration* lens) {
    if (lens->image_width_px == 0)
      lens->image_width_px = seen.width_px, lens->image_height_px = seen.height_px;
  };
  for (std::size_t i = 0; i < matched->places.size(); ++i) {
    const ForeignCamera& camera = matched->rig.cameras[matched->places[i]];
    const CameraSightings& seen = footage.cameras[i];
    core::CameraCalibration& lens = matched->rig.cameras[matched->places[i]].lens;
    put(seen, &lens);
    if (camera.known) put(seen, &*matched->rig.cameras[matched->places[i]].known);
    if (lens.image_width_px != seen.width_px || lens.image_height_px != seen.height_px)
      FailOf(camera, fmt::format("its calibration is for {} x {} px, but the frames are {} x {}; use frames "
                                 "of this size",
                                 lens.image_width_px, lens.image_height_px, seen.width_px, seen.height_px));
  }
  for (ForeignCamera& camera : matched->rig.cameras) put(footage.cameras.front(), &camera.lens);
}

// A 3 x 4 matrix is without a lens; the check may name one.
void PutKnownLenses(const CalibrationFile& check, MatchedRig* matched, std::vector<std::string>* warnings) {
  if (matched->rig.format != recon::ForeignFormat::kProjection) return;
  for (std::size_t i = 0; i < check.cameras.size(); ++i) {
    ForeignCamera& camera = matched->rig.cameras[matched->places[i]];
    if (!check.cameras[i].known.empty())
      camera.known = ReadLensFile(check.cameras[i].known, check.cameras[i].name);
    if (check.cameras[i].known.empty())
      warnings->push_back(
          fmt::format("camera '{}': a 3 x 4 matrix has no lens, so its pictures are taken as undistorted; "
                      "name the lens as known in the check",
                      check.cameras[i].name));
  }
}

RigidTransform WorldOf(const CalibrationFile& check, const recon::CalibrationInput& input,
                       const std::vector<core::CameraCalibration>& calibrations) {
  if (!check.board_frame) return calibrations[static_cast<std::size_t>(input.world.number)].cam_from_world;
  const auto file_from_board = recon::BoardInSet(input, calibrations, input.world.number);
  if (!file_from_board)
    throw Error(
        ErrorKind::kCamera,
        fmt::format(
            "the board in board_frame {} doesn't decide the world: one camera alone sees it, and its two "
            "poses fit alike; name a frame in which two cameras see it",
            *check.board_frame));
  return file_from_board->Inverse();
}

void WarnOfUnchecked(const recon::RigCheck& result, const CalibrationFile& check,
                     std::vector<std::string>* warnings) {
  for (std::size_t i = 0; i < check.cameras.size(); ++i)
    if (!result.camera_error_px[i])
      warnings->push_back(
          fmt::format("camera '{}' isn't checked: it never sees the board together with another one",
                      check.cameras[i].name));
}

}  // namespace

RigImport ImportRig(const RigImportOptions& options, const std::string& rig_name) {
  RigImport import;
  ForeignRig foreign = ReadForeignFiles(options.files, options.format);
  RequirePoses(foreign);
  import.format = foreign.format;
  PutSizes(options, &foreign);
  import.found = UncheckedConvention(foreign, options.stated);
  import.warnings = foreign.warnings;
  import.warnings.insert(import.warnings.end(), import.found.warnings.begin(), import.found.warnings.end());
  import.rig_file = RigFileOf(recon::CalibrationsOf(foreign, import.found.convention, import.found.unit_mm),
                              WorldFromFile(options.up_in_file), rig_name);
  core::Rig& rig = import.rig_file.rig;
  rig.workspace_mm = options.workspace_mm ? *options.workspace_mm : GuessedWorkspace(rig);
  if (foreign.format == recon::ForeignFormat::kProjection)
    import.warnings.emplace_back("3 x 4 matrices have no lens: the pictures are taken as undistorted");
  if (!options.workspace_mm)
    import.warnings.emplace_back(
        "workspace_mm is a cube around where the cameras look; correct it in the rig file, or "
        "say --workspace");
  rig.Validate();
  return import;
}

RigImport ImportCheckedRig(const RigImportOptions& options, const CalibrationFile& check,
                           const std::string& rig_name, const core::Progress& progress,
                           const std::stop_token& stop) {
  RigImport import;
  MatchedRig matched{ReadForeignFiles(options.files, options.format), {}};
  RequirePoses(matched.rig);
  import.warnings = matched.rig.warnings;
  matched.places = MatchedCameras(matched.rig, check, &import.warnings);
  PutKnownLenses(check, &matched, &import.warnings);
  if (matched.rig.cameras.size() > matched.places.size())
    import.warnings.push_back(fmt::format("{} of the files' cameras aren't in the check, and left out",
                                          matched.rig.cameras.size() - matched.places.size()));
  const BoardFootage footage = FindBoards(check, progress, stop);
  const recon::CalibrationInput input =
      ViewsOf(check, footage, std::vector<std::optional<core::CameraCalibration>>(check.cameras.size()));
  PutFootageSizes(footage, &matched);
  progress.Report(0, 0, "trying what the poses may mean");
  import.found = FindConvention(matched, input, options.stated);
  import.warnings.insert(import.warnings.end(), import.found.warnings.begin(), import.found.warnings.end());
  std::vector<core::CameraCalibration> calibrations =
      CalibrationsIn(matched, import.found.convention, import.found.unit_mm);
  for (std::size_t i = 0; i < calibrations.size(); ++i) calibrations[i].name = check.cameras[i].name;
  import.format = matched.rig.format;
  import.rig_file = RigFileOf(calibrations, WorldOf(check, input, calibrations), rig_name);
  import.rig_file.rig.workspace_mm = options.workspace_mm.value_or(check.workspace_mm);
  import.rig_file.rig.Validate();
  if (!import.found.check) return import;
  WarnOfUnchecked(*import.found.check, check, &import.warnings);
  import.rig_file.calibration =
      recon::RigCalibration{core::NowUtc(),
                            fmt::format("{} calibration, checked by {} {} x {}, {} mm",
                                        ToString(import.format), recon::ToString(check.board.kind),
                                        check.board.columns, check.board.rows, check.board.square_mm),
                            import.found.check->error_px,
                            std::nullopt,
                            import.found.check->error_px / std::numbers::sqrt2,
                            {}};
  return import;
}

}  // namespace elbowroom::control
