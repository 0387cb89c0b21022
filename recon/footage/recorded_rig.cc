#include "recon/footage/recorded_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "recon/footage/background_reader.h"
#include "recon/footage/image_sequence.h"
#include "recon/footage/per_camera.h"
#include "recon/footage/read_ahead.h"
#include "recon/images/image_file.h"
#include "recon/images/mask_image.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;
using core::FrameIndex;

core::BitMask ReadSizedMask(ImageReader& reader, const std::filesystem::path& file,
                            const core::CameraModel& camera, const std::stop_token& stop) {
  const std::string who = fmt::format("camera '{}'", camera.name());
  const PictureHeader header = reader.Open(file);
  if (header.width_px != camera.width_px() || header.height_px != camera.height_px()) {
    throw Error(ErrorKind::kFile,
                fmt::format("{}: mask '{}' is {} x {} px, but the rig says {} x {}; use masks of the "
                            "calibrated size",
                            who, file.string(), header.width_px, header.height_px, camera.width_px(),
                            camera.height_px()));
  }
  RequireExactMask(header, file, who);
  return MaskFromImage(reader.Decode(DecodedAs::kStored, stop));
}

// Ready masks as pictures of a source: no picture, a mask.
ReadAhead::ReadFrame MasksOf(std::vector<std::filesystem::path> files, const core::CameraModel& camera) {
  const auto reader = std::make_shared<ImageReader>(fmt::format("camera '{}'", camera.name()),
                                                    cv::Size(camera.width_px(), camera.height_px()));
  return [files = std::move(files), reader, camera](FrameIndex index, const std::stop_token& stop) {
    std::optional<CameraFrame> frame;
    if (index < static_cast<FrameIndex>(files.size())) {
      const std::filesystem::path& file = files[static_cast<std::size_t>(index)];
      frame.emplace(CameraFrame{{}, ReadSizedMask(*reader, file, camera, stop)});
    }
    return frame;
  };
}

std::vector<std::filesystem::path> FindMaskFiles(const std::string& location, const std::string& who) {
  if (IsLive(location) || KindOf(location) == SourceKind::kVideo) {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: masks '{}' must be an image, a pattern such as mask_%04d.png or a "
                            "folder of images",
                            who, location));
  }
  return FindImageFiles(location, who);
}

}  // namespace

// Where one camera's frames come from.
struct RecordedRig::Camera {
  std::string location;
  std::shared_ptr<const ImageSource> source;  // null for one with ready masks
  FrameIndex masks = 0;                       // the number of ready masks
  std::unique_ptr<ReadAhead> frames;

  // Makes that frame the next to take. A few frames before it are read and dropped: to begin anew in a video
  // costs more.
  void SkipTo(FrameIndex frame, const std::stop_token& stop) {
    constexpr FrameIndex kMostDropped = 16;
    if (next && *next < frame && frame - *next <= kMostDropped)
      while (*next < frame && frames->Take(stop)) ++*next;
    frames->Expect(frame);
    next = frame + 1;
  }
  std::optional<FrameIndex> next = {};  // of SkipTo: the frame that comes next

  // The number that the camera's picture had when it came; of other footage, that of the frame.
  [[nodiscard]] std::uint64_t NumberOf(FrameIndex frame) const {
    return pictures.empty() ? static_cast<std::uint64_t>(frame)
                            : pictures.at(static_cast<std::size_t>(frame));
  }
  std::vector<std::uint64_t> pictures = {};

  // The frame of the picture with that number. Nothing: the table of stamps doesn't have it.
  [[nodiscard]] std::optional<FrameIndex> FrameOf(std::uint64_t number) const {
    if (pictures.empty()) return static_cast<FrameIndex>(number);
    const auto frame = frames_of.find(number);
    if (frame == frames_of.end()) return std::nullopt;
    return frame->second;
  }
  std::unordered_map<std::uint64_t, FrameIndex> frames_of = {};
  void KeepPictures(FrameTable table) {
    pictures = std::move(table.pictures);
    for (std::size_t i = 0; i < pictures.size(); ++i)
      if (table.time_s[i]) frames_of.emplace(pictures[i], static_cast<FrameIndex>(i));
  }

  [[nodiscard]] FrameIndex frame_count() const { return source != nullptr ? source->frame_count() : masks; }
};

RecordedRig::Camera RecordedRig::OpenCamera(const CameraSources& sources, const core::CameraModel& camera,
                                            const std::stop_token& stop) {
  const std::string who = fmt::format("camera '{}'", camera.name());
  if (!sources.masks.empty()) {
    std::vector<std::filesystem::path> files = FindMaskFiles(sources.masks, who);
    const auto count = static_cast<FrameIndex>(files.size());
    return {sources.masks, nullptr, count, std::make_unique<ReadAhead>(MasksOf(std::move(files), camera))};
  }
  if (sources.frames.empty()) {
    throw Error(ErrorKind::kFormat, fmt::format("{}: the rig names neither frames nor masks; add one", who));
  }
  std::shared_ptr<ImageSource> source = OpenImageSource(sources.frames, camera, stop);
  auto frames = ReadAheadOf(source);
  return {sources.frames, std::move(source), 0, std::move(frames)};
}

namespace {

// Of a set's pictures; of an even number of them the mean of the two in the middle.
double MedianTime(const StampedSet& set) {
  std::vector<double> times_s;
  for (const std::optional<StampedFrame>& frame : set.frames)
    if (frame) times_s.push_back(frame->time_s);
  std::ranges::sort(times_s);
  return 0.5 * (times_s[(times_s.size() - 1) / 2] + times_s[times_s.size() / 2]);
}

}  // namespace

void RequireOneRate(const CameraRate& one, const CameraRate& other) {
  constexpr double kAllowedRatio = 1.05;  // containers round, and average over dropped frames
  const double ratio = one.frames_hz / other.frames_hz;
  if (std::max(ratio, 1.0 / ratio) <= kAllowedRatio) return;
  throw Error(ErrorKind::kFormat,
              fmt::format("camera '{}' runs at {:.3g} frames/s and camera '{}' at {:.3g}; frames of one "
                          "number must be of one instant: use footage of one rate",
                          one.camera, one.frames_hz, other.camera, other.frames_hz));
}

RecordedRig::RecordedRig(RigFile rig_file, std::stop_token stop) : rig_file_(std::move(rig_file)) {
  core::Require(rig_file_.sources.size() == rig_file_.rig.cameras.size(),
                "a rig file has sources for every camera");
  rig_file_.rig.Validate();
  cameras_.resize(rig_file_.rig.cameras.size());
  RunPerCamera(cameras_.size(), [&](core::CameraIndex i) {
    cameras_[i] = OpenCamera(rig_file_.sources[i], rig_file_.rig.cameras[i], stop);
  });
  FindShortest();
  FormSets();
  if (sets_.empty()) FindFrameRate();
}

// Stamps of pictures that their source doesn't have count for nothing.
void RecordedRig::FormSets() {
  std::vector<FrameStamps> stamps(cameras_.size());
  for (core::CameraIndex i = 0; i < cameras_.size(); ++i) {
    const CameraSources& sources = rig_file_.sources[i];
    if (sources.timestamps.empty()) return;
    FrameTable table =
        ReadFrameTable(sources.timestamps, fmt::format("camera '{}'", rig_file_.rig.cameras[i].name()));
    stamps[i] = table.time_s;
    cameras_[i].KeepPictures(std::move(table));
    stamps[i].resize(std::min(stamps[i].size(), static_cast<std::size_t>(cameras_[i].frame_count())));
    for (std::optional<double>& at_s : stamps[i])
      if (at_s) *at_s += sources.time_offset_s;
  }
  sets_ = SetsOfAllTimes(stamps);
  if (sets_.empty()) {
    throw Error(ErrorKind::kFormat,
                "the cameras' tables of stamps name no picture that their footage has; check timestamps");
  }
  double from_s = 0.0;
  for (StampedSet& set : sets_) {
    const double time_s = MedianTime(set);
    if (set_times_s_.empty()) from_s = time_s;
    for (std::optional<StampedFrame>& frame : set.frames)
      if (frame) frame->time_s -= from_s;
    // Medians over different cameras may go back a little.
    set_times_s_.push_back(set_times_s_.empty() ? 0.0 : std::max(time_s - from_s, set_times_s_.back()));
  }
  if (sets_.size() > 1 && set_times_s_.back() > 0.0)
    frame_rate_hz_ = static_cast<double>(sets_.size() - 1) / set_times_s_.back();
}

RecordedRig::~RecordedRig() = default;

// The rate that all videos share; 25 Hz where none says.
void RecordedRig::FindFrameRate() {
  std::optional<CameraRate> first;
  for (core::CameraIndex i = 0; i < cameras_.size(); ++i) {
    if (cameras_[i].source == nullptr || !cameras_[i].source->frame_rate_hz()) continue;
    const CameraRate rate{rig_file_.rig.cameras[i].name(), *cameras_[i].source->frame_rate_hz()};
    if (!first) first = rate;
    RequireOneRate(*first, rate);
  }
  if (first) frame_rate_hz_ = first->frames_hz;
}

void RecordedRig::FindShortest() {
  shortest_source_.reset();
  for (core::CameraIndex i = 0; i < cameras_.size(); ++i) {
    const FrameIndex frames = cameras_[i].frame_count();
    if (!shortest_source_ || frames < shortest_source_->frames)
      shortest_source_ = ShortestSource{i, cameras_[i].location, frames};
  }
}

std::optional<FrameIndex> RecordedRig::frame_count() const {
  if (!sets_.empty()) return static_cast<FrameIndex>(sets_.size());
  if (!shortest_source_) return std::nullopt;
  return shortest_source_->frames;
}

std::string RecordedRig::WhatEndsIt() const {
  if (!sets_.empty()) return fmt::format("the last set of pictures by their stamps ({} sets)", sets_.size());
  if (!shortest_source_) return {};
  return fmt::format("the shortest source, camera '{}' ({} frames)",
                     rig_file_.rig.cameras[shortest_source_->camera].name(), shortest_source_->frames);
}

std::optional<FrameSet> RecordedRig::TryRead(FrameIndex index, std::stop_token stop) {
  if (index < 0) {
    throw Error(ErrorKind::kRange, fmt::format("frame {} is out of range: frames count from 0", index));
  }
  if (!sets_.empty()) return TryReadSet(index, stop);
  for (const Camera& camera : cameras_) camera.frames->Expect(index);
  FrameSet set{index, static_cast<double>(index) / frame_rate_hz_, {}};
  bool has_ended = false;
  std::exception_ptr failure;
  for (const Camera& camera : cameras_) {
    try {
      std::optional<CameraFrame> frame = camera.frames->Take(stop);
      has_ended = has_ended || !frame;
      if (frame) set.cameras.push_back(std::move(*frame));
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  }
  // Where one camera ends, it doesn't matter what the others have.
  if (has_ended) {
    FindShortest();
    return std::nullopt;
  }
  if (failure) std::rethrow_exception(failure);
  return set;
}

std::vector<std::optional<CameraFrame>> RecordedRig::ReadPictures(
    std::span<const std::optional<std::uint64_t>> numbers, const std::stop_token& stop) {
  core::Require(numbers.size() == cameras_.size(), "one number a camera");
  std::vector<std::optional<FrameIndex>> frames(cameras_.size());
  for (core::CameraIndex i = 0; i < cameras_.size(); ++i) {
    if (!numbers[i]) continue;
    frames[i] = sets_.empty() ? static_cast<FrameIndex>(*numbers[i]) : cameras_[i].FrameOf(*numbers[i]);
    if (frames[i]) cameras_[i].SkipTo(*frames[i], stop);
  }
  std::vector<std::optional<CameraFrame>> pictures(cameras_.size());
  for (core::CameraIndex i = 0; i < cameras_.size(); ++i) {
    if (!frames[i]) continue;
    pictures[i] = cameras_[i].frames->Take(stop);
    if (!pictures[i])
      throw Error(
          ErrorKind::kFile,
          fmt::format("camera '{}': footage '{}' has no frame {}, which is its picture {}; it is too "
                      "short, or not the one that was judged",
                      rig_file_.rig.cameras[i].name(), cameras_[i].location, *frames[i], *numbers[i]));
  }
  return pictures;
}

std::optional<FrameSet> RecordedRig::TryReadSet(FrameIndex index, const std::stop_token& stop) {
  const auto at = static_cast<std::size_t>(index);
  if (at >= sets_.size()) return std::nullopt;
  const StampedSet& stamped = sets_[at];
  for (core::CameraIndex i = 0; i < cameras_.size(); ++i)
    if (stamped.frames[i]) cameras_[i].SkipTo(stamped.frames[i]->frame, stop);
  FrameSet set{index, set_times_s_[at], {}};
  for (core::CameraIndex i = 0; i < cameras_.size(); ++i) {
    set.cameras.emplace_back();
    const std::optional<StampedFrame>& stamp = stamped.frames[i];
    if (!stamp) continue;
    std::optional<CameraFrame> frame = cameras_[i].frames->Take(stop);
    // The file promised more pictures than can be decoded.
    if (!frame) {
      sets_.resize(at);
      set_times_s_.resize(at);
      return std::nullopt;
    }
    set.cameras.back() = std::move(*frame);
    set.cameras.back().stamp = core::CameraStamp{cameras_[i].NumberOf(stamp->frame), stamp->time_s};
  }
  return set;
}

std::vector<BackgroundReference> RecordedRig::ReadBackgrounds(const core::Progress& progress,
                                                              std::stop_token stop) {
  return ReadBackgroundReferences(rig_file_, progress, stop);
}

}  // namespace elbowroom::recon
