#include "app/control/cameras/background_taking.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <system_error>
#include <utility>

#include "app/control/cameras/camera_check.h"
#include "app/control/cameras/empty_scene_capture.h"
#include "core/error.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"
#include "recon/footage/background.h"
#include "recon/images/picture_encoder.h"
#include "recon/segmentation/segmentation_options.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;
namespace fs = std::filesystem;

constexpr double kWantedFalseRate = 1e-6;
constexpr double kLongestS = 3600.0;

// A sequence's path has its number as %04d, and no other '%'.
void RequireNoPercent(const std::string& text, const std::string& what) {
  if (text.find('%') == std::string::npos) return;
  throw Error(
      ErrorKind::kFormat,
      fmt::format("{} '{}' has a '%', which paths of picture sequences can't have; choose another name", what,
                  text));
}

void RequireNewOrEmpty(const fs::path& folder) {
  std::error_code failure;
  const fs::file_status status = fs::status(folder, failure);
  if (status.type() == fs::file_type::not_found) return;
  const bool is_empty_folder = fs::is_directory(status) && fs::is_empty(folder, failure) && !failure;
  if (is_empty_folder) return;
  throw Error(ErrorKind::kFile,
              fmt::format("{}: is {}; choose a folder that is new or empty", folder.string(),
                          failure                    ? "not readable: " + failure.message()
                          : fs::is_directory(status) ? "not empty"
                                                     : "no folder"));
}

// A folder beside the one that is wanted, which takes its name once it is complete; else it is removed.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(const fs::path& wanted)
      : wanted_(fs::absolute(wanted / "").lexically_normal().parent_path()),
        path_(wanted_.parent_path() /
              fmt::format(".{}.{}.unfinished", wanted_.filename().string(), ::getpid())) {
    core::MakeFolder(path_);
  }
  ~UnfinishedFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

  void Finish() {
    std::error_code failure;
    fs::rename(path_, wanted_, failure);  // an empty folder gives way
    if (failure) {
      throw Error(ErrorKind::kFile, fmt::format("{}: can't be made: {}; choose a folder that is new or empty",
                                                wanted_.string(), failure.message()));
    }
    core::SyncFolder(wanted_.parent_path());
  }

 private:
  fs::path wanted_, path_;
};

using Pictures = std::vector<std::vector<recon::TimedPicture>>;

void RequireEnough(const core::Rig& rig, const Pictures& pictures, double seconds) {
  for (core::CameraIndex i = 0; i < pictures.size(); ++i) {
    if (std::ssize(pictures[i]) >= kLeastPictures) continue;
    throw Error(
        ErrorKind::kCamera,
        fmt::format("camera '{}': {} pictures came in {:.1f} s, and a background needs {}; take longer "
                    "(--seconds), or see what 'cameras check' says",
                    rig.cameras[i].name(), pictures[i].size(), seconds, kLeastPictures));
  }
}

CameraBackground Examine(const std::string& name, const std::vector<recon::TimedPicture>& pictures,
                         int min_blob_px) {
  recon::BackgroundAccumulator accumulator;
  for (const recon::TimedPicture& picture : pictures) accumulator.Add(picture.image_bgr);
  const recon::BackgroundReference reference = accumulator.Reference();
  CameraBackground camera{name, accumulator.frames(),
                          recon::ExamineEmptyScene(pictures, reference, min_blob_px)};
  if (camera.scene.moved_px.empty()) {
    camera.suggested =
        recon::SuggestThreshold(reference, kWantedFalseRate, recon::SegmentationOptions().edge_slack_px);
  }
  camera.faults = recon::FaultsOf(camera.scene, name, pictures.front().image_bgr.size());
  return camera;
}

// One line for all cameras: the first fault in full, and how many more there are.
void RefuseFaults(const std::vector<CameraBackground>& cameras) {
  std::vector<std::string> faults;
  for (const CameraBackground& camera : cameras)
    faults.insert(faults.end(), camera.faults.begin(), camera.faults.end());
  if (faults.empty()) return;
  const std::string more = faults.size() > 1 ? fmt::format(" (and {} more)", faults.size() - 1) : "";
  throw Error(
      ErrorKind::kCamera,
      fmt::format("{}{}; nothing was written: put that right and take the background again, or take it "
                  "anyway (--anyway)",
                  faults.front(), more));
}

std::uint64_t WritePictures(const std::vector<recon::TimedPicture>& pictures, const fs::path& folder) {
  core::MakeFolder(folder);
  std::atomic<std::uint64_t> bytes = 0;
  tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t i) {
    const std::vector<std::uint8_t> png = recon::EncodePicture(pictures[i].image_bgr, ".png");
    core::WriteWholeFile(folder / fmt::format("{:04}.png", i),
                         {reinterpret_cast<const char*>(png.data()), png.size()});
    bytes += png.size();
  });
  return bytes;
}

double SecondsOf(const Pictures& pictures) {
  double seconds = 0.0;
  for (const auto& of_camera : pictures)
    seconds = std::max(seconds, of_camera.back().time_s - of_camera.front().time_s);
  return seconds;
}

}  // namespace

void BackgroundOptions::Validate() const {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw Error(ErrorKind::kRange, what);
  };
  require(seconds > 0.0 && seconds <= kLongestS, "seconds must be above 0 and at most 3600");
  require(countdown_s >= 0.0 && countdown_s <= kLongestS, "countdown must be 0 to 3600 s");
  require(min_blob_px >= 0, "min_blob_px must be 0 or more");
}

BackgroundOutcome TakeBackground(const recon::RigFile& rig_file, const fs::path& folder,
                                 const BackgroundOptions& options, const core::Progress& progress,
                                 const std::stop_token& stop) {
  options.Validate();
  RequireLiveRig(rig_file);
  RequireNoPercent(fs::absolute(folder).string(), "folder");
  for (const core::CameraModel& camera : rig_file.rig.cameras) RequireNoPercent(camera.name(), "camera");
  RequireNewOrEmpty(folder);
  const Pictures pictures =
      CapturePictures(rig_file, {options.countdown_s, options.seconds, kMostPictures}, progress, stop);
  RequireEnough(rig_file.rig, pictures, options.seconds);
  BackgroundOutcome outcome;
  outcome.seconds = SecondsOf(pictures);
  outcome.cameras.resize(pictures.size());
  tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t i) {
    outcome.cameras[i] = Examine(rig_file.rig.cameras[i].name(), pictures[i], options.min_blob_px);
  });
  if (!options.anyway) RefuseFaults(outcome.cameras);
  UnfinishedFolder unfinished(folder);
  recon::RigFile with_background = rig_file;
  for (core::CameraIndex i = 0; i < pictures.size(); ++i) {
    progress.Report(static_cast<std::int64_t>(i), static_cast<std::int64_t>(pictures.size()),
                    "writing the background, camera");
    core::ThrowIfStopped(stop, "writing the background");
    const fs::path of_camera = unfinished.path() / rig_file.rig.cameras[i].name();
    outcome.bytes += WritePictures(pictures[i], of_camera);
    with_background.sources[i].background = (of_camera / "%04d.png").string();
  }
  recon::WriteRigFile(with_background, unfinished.path() / "RIG.yml");
  unfinished.Finish();
  outcome.rig_file = folder / "RIG.yml";
  return outcome;
}

}  // namespace elbowroom::control
