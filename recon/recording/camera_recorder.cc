#include "recon/recording/camera_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"
#include "recon/recording/video_writer.h"

namespace elbowroom::recon {
namespace {

namespace fs = std::filesystem;

// Seconds on CLOCK_MONOTONIC, to the nanosecond.
std::string StampText(CaptureClock::time_point taken_at) {
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  const std::int64_t ns =
      std::chrono::duration_cast<std::chrono::nanoseconds>(taken_at.time_since_epoch()).count();
  return fmt::format("{}.{:09}", ns / kNsPerS, ns % kNsPerS);
}

}  // namespace

CameraRecorder::CameraRecorder(CameraRecorderOptions options)
    : options_(std::move(options)), queue_(options_.most_waiting, core::WhenFull::kBlock) {
  recording_.name = options_.name;
  thread_ = std::thread([this] { Run(); });
}

CameraRecorder::~CameraRecorder() {
  Close();
  if (thread_.joinable()) thread_.join();
}

void CameraRecorder::Add(const CapturedPicture& picture) {
  const std::lock_guard lock(mutex_);
  if (!is_open_) return;
  if (last_stamp_ && picture.taken_at <= *last_stamp_) {
    MissUnwritten(picture.number, kStampGoesBack);
  } else if (has_ended_ || !queue_.PushIfRoom(picture)) {
    MissUnwritten(picture.number);
  } else {
    last_stamp_ = picture.taken_at;
  }
}

void CameraRecorder::AddLoss(const core::PictureLoss& loss) {
  const std::lock_guard lock(mutex_);
  if (!is_open_) return;
  Miss(loss.first, loss.last, std::string(core::ToString(loss.reason)));
  recording_.lost += loss.count();
}

// With mutex_ held.
void CameraRecorder::Miss(std::uint64_t first, std::uint64_t last, const std::string& reason) {
  std::vector<MissingPictures>& missing = recording_.missing;
  if (!missing.empty() && missing.back().reason == reason && missing.back().last + 1 == first) {
    missing.back().last = last;
  } else {
    missing.push_back({first, last, reason});
  }
}

void CameraRecorder::MissUnwritten(std::uint64_t number, const std::string& reason) {
  Miss(number, number, reason);
  ++recording_.unwritten;
}

void CameraRecorder::Close() {
  const std::lock_guard lock(mutex_);
  is_open_ = false;
  queue_.Close();
}

CameraRecording CameraRecorder::Finish() {
  thread_.join();
  return std::move(recording_);
}

std::optional<std::string> CameraRecorder::WhatFillsTheDisk() const {
  std::error_code unknown;
  const fs::space_info space = fs::space(options_.folder, unknown);
  if (unknown || space.available >= options_.least_free_bytes) return std::nullopt;
  constexpr double kBytesPerMb = 1e6;
  return fmt::format("the disk is full but for {:.0f} MB; make room, or record to another disk",
                     static_cast<double>(space.available) / kBytesPerMb);
}

void CameraRecorder::Run() {
  try {
    WriteVideo(options_.folder / "video.avi");
    WriteTables();
  } catch (const core::Error& error) {
    GiveUp(error.what());
  }
}

// All pictures that came are counted as unwritten, since the video is of no use.
void CameraRecorder::GiveUp(const std::string& why) {
  has_ended_ = true;
  while (const std::optional<CapturedPicture> picture = queue_.Pop()) taken_.push_back(picture->number);
  const std::lock_guard lock(mutex_);
  for (const std::uint64_t number : taken_) MissUnwritten(number);
  std::ranges::sort(recording_.missing, {}, &MissingPictures::first);
  recording_.frames = 0;
  recording_.bytes = 0;
  recording_.video.clear();
  recording_.trouble = fmt::format("camera '{}': {}", options_.name, why);
}

// The file has its name once it is whole.
void CameraRecorder::WriteVideo(const fs::path& video) {
  const fs::path part = video.string() + ".part";
  std::optional<VideoWriter> writer;
  std::optional<std::string> fills_the_disk;
  while (const std::optional<CapturedPicture> picture = queue_.Pop()) {
    if (!fills_the_disk) fills_the_disk = WhatFillsTheDisk();
    if (fills_the_disk) {
      has_ended_ = true;
      const std::lock_guard lock(mutex_);
      MissUnwritten(picture->number);
      continue;
    }
    if (!writer) writer.emplace(part, options_.size_px, options_.rate_hz);
    stamps_ += fmt::format("{},{},{}\n", taken_.size(), StampText(picture->taken_at), picture->number);
    taken_.push_back(picture->number);
    writer->Write(picture->image_bgr);
  }
  if (!writer) {
    throw core::Error(core::ErrorKind::kCamera,
                      fills_the_disk.value_or("no picture came; look at it with 'cameras check'"));
  }
  if (fills_the_disk) recording_.trouble = fmt::format("camera '{}': {}", options_.name, *fills_the_disk);
  writer->Finish();
  std::error_code failure;
  fs::rename(part, video, failure);
  if (failure) {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("video '{}': {}", video.string(), failure.message()));
  }
  core::SyncFolder(options_.folder);
  recording_.frames = static_cast<std::int64_t>(taken_.size());
  recording_.video = video;
  recording_.bytes = fs::file_size(video);
}

// Both whole or not there.
void CameraRecorder::WriteTables() {
  // Two threads tell of them, so they may be out of order.
  std::ranges::sort(recording_.missing, {}, &MissingPictures::first);
  std::string losses = "first,last,reason\n";
  for (const MissingPictures& missing : recording_.missing)
    losses += fmt::format("{},{},{}\n", missing.first, missing.last, missing.reason);
  core::WriteWholeFile(options_.folder / "losses.csv", losses);
  recording_.timestamps = options_.folder / "stamps.csv";
  core::WriteWholeFile(recording_.timestamps, stamps_);
  recording_.bytes += losses.size() + stamps_.size();
}

}  // namespace elbowroom::recon
