#include "app/control/gauge/gauge_job.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/control/gauge/gauge_faults.h"
#include "core/error.h"
#include "core/system/utc_time.h"
#include "recon/footage/recorded_rig.h"
#include "recon/segmentation/frame_segmenter.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;

GaugePlace PlaceOf(core::FrameIndex frame, recon::RodMeasurement rod, const TrueRod& truth) {
  GaugePlace place;
  place.frame = frame;
  place.error_mm = rod.diameter.value_mm - truth.diameter_mm;
  if (truth.length_mm && rod.length) place.length_error_mm = rod.length->value_mm - *truth.length_mm;
  place.rod = std::move(rod);
  place.faults = FaultsOf(place, truth);
  return place;
}

template <typename Size>
std::optional<std::size_t> Largest(const std::vector<GaugePlace>& places, const Size& size) {
  std::optional<std::size_t> largest;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::optional<double> of_place = size(places[i]);
    if (of_place && (!largest || *of_place > size(places[*largest]))) largest = i;
  }
  return largest;
}

void Summarise(GaugeOutcome* outcome) {
  using Size = std::optional<double>;
  outcome->worst = Largest(outcome->places, [](const GaugePlace& place) -> Size {
                     return std::abs(place.error_mm);
                   }).value();
  outcome->worst_straightness = Largest(outcome->places, [](const GaugePlace& place) -> Size {
    return place.rod.straightness ? Size(place.rod.straightness->value_mm) : Size();
  });
  outcome->worst_length = Largest(outcome->places, [](const GaugePlace& place) -> Size {
    if (place.length_error_mm) return std::abs(*place.length_error_mm);
    return place.rod.length ? Size(-place.rod.length->bound.total_mm()) : Size();
  });
  if (outcome->truth.length_mm && !outcome->worst_length)
    outcome->faults.emplace_back(
        "the length wasn't measured at any place: hold the rod so that both of its ends are free and in "
        "view");
}

std::string LackingCamera(const recon::FrameSet& pictures, const core::Rig& rig) {
  for (std::size_t i = 0; i < pictures.cameras.size(); ++i) {
    const recon::CameraFrame& camera = pictures.cameras[i];
    if (camera.image_bgr.empty() && !camera.ready_mask) return rig.cameras[i].name();
  }
  return "";
}

void AddWarnings(const GaugeFrames& frames, GaugeOutcome* outcome) {
  const auto& calibration = frames.rig_file.calibration;
  if (!calibration || calibration->covariance.size() == 0)
    outcome->warnings.emplace_back(
        "the rig has no covariance of a calibration, so the bound is that of the silhouettes alone");
  const bool are_checked = std::ranges::any_of(outcome->places, [](const GaugePlace& place) {
    return std::ranges::any_of(place.rod.cameras,
                               [](const recon::CameraOfGauge& camera) { return camera.offset.has_value(); });
  });
  if (!are_checked)
    outcome->warnings.emplace_back(
        "at no place three cameras measure the rod, and two can't check each other's direction");
  constexpr std::size_t kFewPlaces = 10;
  if (outcome->places.size() < kFewPlaces)
    outcome->warnings.push_back(fmt::format(
        "the rod was measured at {} only; move it through all of the workspace, and use --frames",
        outcome->places.size() == 1 ? "one place" : fmt::format("{} places", outcome->places.size())));
}

}  // namespace

bool GaugeOutcome::passed() const {
  return faults.empty() && std::ranges::all_of(places, &GaugePlace::passed);
}

GaugeFrames ReadGaugeFrames(const std::filesystem::path& rig_file, std::vector<core::FrameIndex> frames,
                            const core::Progress& progress, const std::stop_token& stop) {
  std::ranges::sort(frames);
  frames.erase(std::ranges::unique(frames).begin(), frames.end());
  GaugeFrames result{recon::ReadRigFile(rig_file), {}, std::move(frames), {}, {}};
  recon::RecordedRig source(result.rig_file, stop);
  std::optional<recon::FrameSegmenter> segmenter;
  for (const core::FrameIndex frame : result.frames) {
    core::ThrowIfStopped(stop, "gauge");
    progress.Report(static_cast<std::int64_t>(result.masks.size()),
                    static_cast<std::int64_t>(result.frames.size()), "frames read");
    // The first frame is read before the backgrounds: a missing frame is found sooner.
    const recon::FrameSet pictures = source.Read(frame, stop);
    if (!segmenter)
      segmenter.emplace(source.ReadBackgrounds(progress, stop), recon::SegmentationOptions(), source.rig());
    result.masks.push_back(segmenter->SegmentSoft(pictures));
    result.lacking_camera.push_back(LackingCamera(pictures, source.rig()));
  }
  result.planes = recon::MakeUndistortedPlanes(result.rig_file.rig);
  return result;
}

GaugeOutcome GaugeRig(const GaugeFrames& frames, const TrueRod& truth, const core::Progress& progress,
                      const std::stop_token& stop) {
  const Eigen::MatrixXd covariance =
      frames.rig_file.calibration ? frames.rig_file.calibration->covariance : Eigen::MatrixXd();
  std::vector<recon::RodGaugeResult> results(frames.frames.size());
  constexpr std::size_t kFramesAtOnce = 16;  // between two reports
  for (std::size_t from = 0; from < results.size(); from += kFramesAtOnce) {
    core::ThrowIfStopped(stop, "gauge");
    progress.Report(static_cast<std::int64_t>(from), static_cast<std::int64_t>(results.size()),
                    "places measured");
    tbb::parallel_for(from, std::min(from + kFramesAtOnce, results.size()), [&](std::size_t i) {
      if (const std::string& camera = frames.lacking_camera[i]; !camera.empty()) {
        results[i].reason = fmt::format("the picture of camera '{}' is missing", camera);
        return;
      }
      results[i] =
          recon::GaugeRod(frames.rig_file.rig, frames.planes, frames.masks[i], covariance, truth.diameter_mm);
    });
  }
  GaugeOutcome outcome;
  outcome.truth = truth;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].rod)
      outcome.places.push_back(PlaceOf(frames.frames[i], std::move(*results[i].rod), truth));
    else
      outcome.warnings.push_back(fmt::format("frame {}: no rod: {}", frames.frames[i], results[i].reason));
  }
  if (outcome.places.empty()) {
    throw Error(ErrorKind::kGeometry,
                fmt::format("frame {}: no rod of {:.6g} mm: {}{}", frames.frames.front(), truth.diameter_mm,
                            results.front().reason,
                            results.size() > 1
                                ? fmt::format(" (and in none of the other {} frames)", results.size() - 1)
                                : std::string()));
  }
  Summarise(&outcome);
  AddWarnings(frames, &outcome);
  return outcome;
}

core::RigGauge RigGaugeOf(const GaugeOutcome& outcome) {
  const GaugePlace& worst = outcome.worst_place();
  return {core::NowUtc(),  outcome.truth.diameter_mm,           worst.rod.diameter.value_mm,
          worst.error_mm,  worst.rod.diameter.bound.total_mm(), static_cast<int>(outcome.places.size()),
          outcome.passed()};
}

}  // namespace elbowroom::control
