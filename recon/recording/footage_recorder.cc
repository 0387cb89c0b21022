#include "recon/recording/footage_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/system/file_sync.h"

namespace elbowroom::recon {
namespace {

namespace fs = std::filesystem;
using core::CameraIndex;

bool IsPlainName(const std::string& name) {
  constexpr std::size_t kLongest = 64;
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, is_plain);
}

// The cameras' names if all of them can name a folder, else cam1, cam2, ...
std::vector<std::string> FolderNames(const core::Rig& rig) {
  std::vector<std::string> names;
  for (const core::CameraModel& camera : rig.cameras) names.push_back(camera.name());
  const std::set<std::string> different(names.begin(), names.end());
  if (different.size() == names.size() && std::ranges::all_of(names, IsPlainName)) return names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = fmt::format("cam{}", i + 1);
  return names;
}

}  // namespace

void RequireEmptyFolder(const fs::path& folder) {
  std::error_code failure;
  if (!fs::exists(fs::symlink_status(folder, failure))) return;
  if (fs::is_directory(folder, failure) && fs::is_empty(folder, failure)) return;
  throw core::Error(core::ErrorKind::kFile,
                    fmt::format("{}: {}; choose a new folder", folder.string(),
                                fs::is_directory(folder, failure) ? "there is something in it already"
                                                                  : "it is not a folder"));
}

std::vector<std::string> FootageRecording::Troubles() const {
  std::vector<std::string> troubles;
  for (const CameraRecording& camera : cameras)
    if (!camera.trouble.empty()) troubles.push_back(camera.trouble);
  return troubles;
}

struct FootageRecorder::Shared {
  std::mutex mutex;
  std::vector<std::optional<double>> rates_hz;           // as the cameras say
  std::vector<std::shared_ptr<CameraRecorder>> cameras;  // empty but between Begin and End

  [[nodiscard]] std::shared_ptr<CameraRecorder> RecorderOf(CameraIndex camera) {
    const std::lock_guard lock(mutex);
    return cameras.empty() ? nullptr : cameras[camera];
  }
  [[nodiscard]] std::vector<std::shared_ptr<CameraRecorder>> TakeAll() {
    const std::lock_guard lock(mutex);
    return std::exchange(cameras, {});
  }
};

FootageRecorder::FootageRecorder(RigFile rig_file, FootageRecorderOptions options)
    : rig_file_(std::move(rig_file)), options_(options), shared_(std::make_shared<Shared>()) {
  shared_->rates_hz.resize(rig_file_.rig.cameras.size());
}

FootageRecorder::~FootageRecorder() { (void)shared_->TakeAll(); }

LiveTaps FootageRecorder::Taps() {
  LiveTaps taps;
  taps.on_picture = [shared = shared_](CameraIndex camera, const CapturedPicture& picture) {
    if (const auto recorder = shared->RecorderOf(camera)) recorder->Add(picture);
  };
  taps.on_loss = [shared = shared_](const core::PictureLoss& loss) {
    if (const auto recorder = shared->RecorderOf(loss.camera)) recorder->AddLoss(loss);
  };
  taps.on_state = [shared = shared_](CameraIndex camera, const CameraState& state) {
    const std::lock_guard lock(shared->mutex);
    if (state.report.rate_hz) shared->rates_hz[camera] = state.report.rate_hz;
  };
  return taps;
}

double FootageRecorder::RateOf(CameraIndex camera) const {
  constexpr double kUsualRateHz = 30.0;
  const std::lock_guard lock(shared_->mutex);
  const std::optional<double>& rate_hz = shared_->rates_hz[camera];
  if (rate_hz && *rate_hz > 0.0) return *rate_hz;
  return rig_file_.sources[camera].capture.rate_hz.value_or(kUsualRateHz);
}

void FootageRecorder::Begin(const fs::path& folder) {
  core::Require(folder_.empty(), "a recorder records once");
  RequireEmptyFolder(folder);
  folder_ = fs::absolute(folder);
  std::vector<std::shared_ptr<CameraRecorder>> cameras;
  const std::vector<std::string> names = FolderNames(rig_file_.rig);
  for (CameraIndex i = 0; i < names.size(); ++i) {
    camera_folders_.push_back(folder_ / names[i]);
    core::MakeFolder(camera_folders_[i]);
    CopyBackground(i);
    const core::CameraModel& camera = rig_file_.rig.cameras[i];
    const cv::Size size_px(camera.width_px(), camera.height_px());
    const std::uint64_t bytes = 3 * static_cast<std::uint64_t>(size_px.area());
    cameras.push_back(std::make_shared<CameraRecorder>(
        CameraRecorderOptions{camera.name(), camera_folders_[i], size_px, RateOf(i),
                              std::max<std::size_t>(kLeastWaiting, options_.most_waiting_bytes / bytes),
                              options_.least_free_bytes}));
  }
  begin_ = std::chrono::steady_clock::now();
  const std::lock_guard lock(shared_->mutex);
  shared_->cameras = std::move(cameras);
}

// So that the folder can go elsewhere. What is no single file stays where it is.
void FootageRecorder::CopyBackground(CameraIndex camera) {
  std::string& background = rig_file_.sources[camera].background;
  std::error_code failure;
  if (background.empty() || !fs::is_regular_file(background, failure)) return;
  const fs::path copy = camera_folders_[camera] / ("background" + fs::path(background).extension().string());
  fs::copy_file(background, copy, failure);
  if (failure) {
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("camera '{}': background '{}' can't be copied to '{}': {}",
                    rig_file_.rig.cameras[camera].name(), background, copy.string(), failure.message()));
  }
  background = copy.string();
}

bool FootageRecorder::has_ended() const {
  const std::lock_guard lock(shared_->mutex);
  return std::ranges::any_of(shared_->cameras, [](const auto& camera) { return camera->has_ended(); });
}

FootageRecording FootageRecorder::End() {
  const std::vector<std::shared_ptr<CameraRecorder>> cameras = shared_->TakeAll();
  core::Require(!cameras.empty(), "a recording has begun and not ended");
  FootageRecording recording;
  recording.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  for (const auto& camera : cameras) camera->Close();  // all of them end at once
  for (const auto& camera : cameras) {
    recording.cameras.push_back(camera->Finish());
    recording.bytes += recording.cameras.back().bytes;
  }
  WriteRig(&recording);
  return recording;
}

void FootageRecorder::WriteRig(FootageRecording* recording) const {
  RigFile played = rig_file_;
  for (CameraIndex i = 0; i < played.sources.size(); ++i) {
    if (recording->cameras[i].video.empty()) return;
    played.sources[i].frames = recording->cameras[i].video.string();
    played.sources[i].timestamps = recording->cameras[i].timestamps.string();
  }
  recording->rig_file = folder_ / "RIG.yml";
  WriteRigFile(played, recording->rig_file);
}

}  // namespace elbowroom::recon
