#include "app/control/calibration/calibration_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/control/calibration/board_views.h"
#include "app/control/calibration/calibration_advice.h"
#include "app/control/calibration/foreign_files.h"
#include "core/error.h"
#include "core/system/utc_time.h"
#include "recon/calibration/calibrate.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;

using KnownLenses = std::vector<std::optional<core::CameraCalibration>>;  // by camera

KnownLenses ReadKnownLenses(const CalibrationFile& file) {
  KnownLenses known(file.cameras.size());
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!file.cameras[i].known.empty()) known[i] = ReadLensFile(file.cameras[i].known, file.cameras[i].name);
  return known;
}

// A lens whose file says no size is for the frames' size.
void RequireSizes(const CalibrationFile& file, const BoardFootage& footage, KnownLenses* known_lenses) {
  KnownLenses& known = *known_lenses;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const CameraSightings& seen = footage.cameras[i];
    if (known[i] && known[i]->image_width_px == 0) {
      known[i]->image_width_px = seen.width_px;
      known[i]->image_height_px = seen.height_px;
    }
    if (!known[i] ||
        (known[i]->image_width_px == seen.width_px && known[i]->image_height_px == seen.height_px))
      continue;
    throw Error(ErrorKind::kCamera,
                fmt::format("camera '{}': the lens of '{}' is for {} x {} px, but the frames are {} x {}; "
                            "give the lens of this size",
                            seen.name, file.cameras[i].known.string(), known[i]->image_width_px,
                            known[i]->image_height_px, seen.width_px, seen.height_px));
  }
}

int NumberOf(const CalibrationFile& file, const std::string& name) {
  const auto found = std::ranges::find(file.cameras, name, &CameraFootage::name);
  return static_cast<int>(found - file.cameras.begin());
}

recon::KnownLength Resolved(const CalibrationFile& file, const KnownLength& known) {
  recon::KnownLength resolved{known.title, known.length_mm, known.tolerance_mm, std::nullopt, {}, {}};
  if (!known.cameras.empty())
    resolved.cameras = {NumberOf(file, known.cameras[0]), NumberOf(file, known.cameras[1])};
  for (const KnownLength::Pixel& pixel : known.pixels) {
    const int camera = NumberOf(file, pixel.camera);
    resolved.first.push_back({camera, pixel.from_px});
    resolved.second.push_back({camera, pixel.to_px});
  }
  return resolved;
}

void CheckLengths(const CalibrationFile& file, CalibrationOutcome* outcome) {
  for (const KnownLength& known : file.lengths) {
    outcome->lengths.push_back(recon::CheckLength(outcome->result, Resolved(file, known)));
    if (outcome->lengths.back().verdict != recon::LengthVerdict::kAgrees)
      outcome->warnings.push_back(outcome->lengths.back().message);
  }
  outcome->scale_checked =
      !outcome->lengths.empty() && std::ranges::all_of(outcome->lengths, [](const recon::LengthCheck& check) {
        return check.verdict == recon::LengthVerdict::kAgrees;
      });
  if (file.lengths.empty()) {
    outcome->advice.push_back(
        fmt::format("the scale is as right as square_mm, {} mm: measure the distance of two cameras, or of "
                    "two points that "
                    "two cameras see, and write it as [[known_length]]",
                    file.board.square_mm));
  }
}

void SummariseMap(CalibrationOutcome* outcome) {
  std::vector<double> sigmas_mm;
  for (const recon::UncertaintyMap::Node& node : outcome->map.values)
    if (node.is_known) sigmas_mm.push_back(node.sigma_mm);
  if (sigmas_mm.empty()) {
    outcome->warnings.emplace_back(
        "no part of the workspace is seen by two cameras; check workspace_mm in [world]");
    return;
  }
  outcome->seen_share =
      static_cast<double>(sigmas_mm.size()) / static_cast<double>(outcome->map.values.size());
  outcome->uncertainty_mm = core::SpreadOf(std::move(sigmas_mm));
}

recon::RigFile RigFileOf(const CalibrationFile& file, const std::string& rig_name,
                         const CalibrationOutcome& outcome) {
  recon::RigFile rig_file;
  rig_file.rig.name = rig_name;
  rig_file.rig.workspace_mm = file.workspace_mm;
  for (std::size_t i = 0; i < file.cameras.size(); ++i) {
    const recon::CalibratedCamera& camera = outcome.result.cameras[i];
    rig_file.rig.cameras.emplace_back(camera.calibration);
    rig_file.sources.push_back(file.cameras[i].trial);
    rig_file.sources.back().time_offset_s = camera.time_offset_s;
  }
  rig_file.calibration =
      recon::RigCalibration{core::NowUtc(),
                            fmt::format("{} {} x {}, {} mm", recon::ToString(file.board.kind),
                                        file.board.columns, file.board.rows, file.board.square_mm),
                            outcome.result.rms_px,
                            outcome.result.held_out_rms_px,
                            outcome.result.noise_px,
                            outcome.result.covariance};
  return rig_file;
}

// Sets were formed by stamps. Where a camera turns out to be late by a good part of a period, its frames
// belong to other sets.
bool HasLateCamera(const CalibrationOutcome& outcome) {
  constexpr double kMostShare = 0.3;
  return outcome.footage.period_s &&
         std::ranges::any_of(outcome.result.cameras, [&](const recon::CalibratedCamera& camera) {
           return camera.time_offset_sigma_s &&
                  std::abs(camera.time_offset_s) > kMostShare * *outcome.footage.period_s;
         });
}

std::vector<double> OffsetsOf(const recon::CalibrationResult& result) {
  std::vector<double> offsets_s;
  for (const recon::CalibratedCamera& camera : result.cameras) offsets_s.push_back(camera.time_offset_s);
  return offsets_s;
}

}  // namespace

CalibrationOutcome CalibrateRig(const CalibrationFile& file, const std::string& rig_name,
                                const core::Progress& progress, const std::stop_token& stop) {
  CalibrationOutcome outcome;
  KnownLenses known = ReadKnownLenses(file);  // a wrong file is told before the long search
  outcome.footage = FindBoards(file, progress, stop);
  RequireSizes(file, outcome.footage, &known);
  const auto start = std::chrono::steady_clock::now();
  outcome.input = ViewsOf(file, outcome.footage, known);
  outcome.result = recon::Calibrate(outcome.input, progress, stop);
  if (HasLateCamera(outcome)) {
    outcome.footage.sets = SetsAfterOffsets(outcome.footage, OffsetsOf(outcome.result));
    outcome.input = ViewsOf(file, outcome.footage, known);
    outcome.result = recon::Calibrate(outcome.input, progress, stop);
  }
  outcome.warnings = outcome.footage.warnings;
  outcome.warnings.insert(outcome.warnings.end(), outcome.result.warnings.begin(),
                          outcome.result.warnings.end());
  outcome.advice = AdviceFor(outcome.input, outcome.result);
  CheckLengths(file, &outcome);
  const recon::RigUncertainty uncertainty(outcome.result, outcome.result.noise_px);
  outcome.map = recon::MapUncertainty(uncertainty, file.workspace_mm, recon::MapEdgeMm(file.workspace_mm),
                                      progress, stop);
  SummariseMap(&outcome);
  outcome.time_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  outcome.rig_file = RigFileOf(file, rig_name, outcome);
  return outcome;
}

}  // namespace elbowroom::control
