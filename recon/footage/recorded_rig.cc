#include "recon/footage/recorded_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "recon/footage/background_reader.h"
#include "recon/footage/image_sequence.h"
#include "recon/footage/per_camera.h"
#include "recon/images/image_file.h"
#include "recon/images/mask_image.h"

namespace elbowroom::recon {
namespace {

using core::Error;
using core::ErrorKind;
using core::FrameIndex;

struct OpenedCamera {
  std::string location;
  std::optional<FrameIndex> frames;
  std::optional<double> frame_rate_hz;
  ReadAhead::ReadFrame read;
  std::shared_ptr<const ImageSource> source = nullptr;
};

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

OpenedCamera OpenMasks(const std::string& location, const core::CameraModel& camera) {
  const std::string who = fmt::format("camera '{}'", camera.name());
  const SourceKind kind = KindOf(location);
  if (kind == SourceKind::kDevice || kind == SourceKind::kUrl || kind == SourceKind::kVideo) {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: masks '{}' must be an image, a pattern such as mask_%04d.png or a "
                            "folder of images",
                            who, location));
  }
  std::vector<std::filesystem::path> files = FindImageFiles(location, who);
  const auto count = static_cast<FrameIndex>(files.size());
  const auto reader = std::make_shared<ImageReader>(who, cv::Size(camera.width_px(), camera.height_px()));
  const auto read = [files = std::move(files), reader, camera](FrameIndex index,
                                                               const std::stop_token& stop) {
    return CameraFrame{{}, ReadSizedMask(*reader, files[static_cast<std::size_t>(index)], camera, stop), {}};
  };
  return {location, count, std::nullopt, read};
}

OpenedCamera OpenCamera(const CameraSources& sources, const core::CameraModel& camera,
                        const std::stop_token& stop) {
  if (!sources.masks.empty()) return OpenMasks(sources.masks, camera);
  if (sources.frames.empty()) {
    throw Error(ErrorKind::kFormat,
                fmt::format("camera '{}': the rig names neither frames nor masks; add one", camera.name()));
  }
  const std::shared_ptr<ImageSource> source = OpenImageSource(sources.frames, camera, stop);
  const auto read = [source](FrameIndex index, const std::stop_token& reading) {
    SourcePicture picture = source->Read(index, reading);
    return CameraFrame{std::move(picture.image_bgr), std::nullopt, picture.captured_at};
  };
  return {sources.frames, source->frame_count(), source->frame_rate_hz(), read, source};
}

std::vector<OpenedCamera> OpenAll(const RigFile& rig_file, const std::stop_token& stop) {
  std::vector<OpenedCamera> opened(rig_file.rig.cameras.size());
  RunPerCamera(opened.size(), [&](core::CameraIndex i) {
    opened[i] = OpenCamera(rig_file.sources[i], rig_file.rig.cameras[i], stop);
  });
  return opened;
}

// The rate that all videos share; 25 Hz where none says.
double CommonFrameRateHz(const std::vector<OpenedCamera>& opened, const core::Rig& rig) {
  constexpr double kUnsaidRateHz = 25.0;
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < opened.size(); ++i) {
    if (!opened[i].frame_rate_hz) continue;
    if (!first) first = i;
    RequireOneRate({rig.cameras[*first].name(), *opened[*first].frame_rate_hz},
                   {rig.cameras[i].name(), *opened[i].frame_rate_hz});
  }
  return first ? *opened[*first].frame_rate_hz : kUnsaidRateHz;
}

std::optional<ShortestSource> FindShortest(const std::vector<OpenedCamera>& opened) {
  std::optional<ShortestSource> shortest;
  for (std::size_t i = 0; i < opened.size(); ++i) {
    if (opened[i].frames && (!shortest || *opened[i].frames < shortest->frames)) {
      shortest = ShortestSource{i, opened[i].location, *opened[i].frames};
    }
  }
  return shortest;
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

void AddWarningOf(const ImageSource& source, const std::string& camera, std::vector<std::string>* warnings) {
  if (const FrameIndex left_out = source.left_out(); left_out > 0) {
    warnings->push_back(fmt::format("camera '{}': {} damaged live {} left out", camera, left_out,
                                    left_out == 1 ? "picture was" : "pictures were"));
  }
}

RecordedRig::RecordedRig(RigFile rig_file, std::stop_token stop) : rig_file_(std::move(rig_file)) {
  core::Require(rig_file_.sources.size() == rig_file_.rig.cameras.size(),
                "a rig file has sources for every camera");
  rig_file_.rig.Validate();
  std::vector<OpenedCamera> opened = OpenAll(rig_file_, stop);
  shortest_source_ = FindShortest(opened);
  frame_rate_hz_ = CommonFrameRateHz(opened, rig_file_.rig);
  for (OpenedCamera& camera : opened) {
    const auto end = camera.frames ? frame_count() : std::nullopt;
    sources_.push_back(std::move(camera.source));
    cameras_.push_back(std::make_unique<ReadAhead>(std::move(camera.read), end));
  }
}

std::optional<FrameIndex> RecordedRig::frame_count() const {
  if (!shortest_source_) return std::nullopt;
  return shortest_source_->frames;
}

FrameSet RecordedRig::Read(FrameIndex index, std::stop_token stop) {
  if (index < 0 || (shortest_source_ && index >= shortest_source_->frames)) {
    const std::string why =
        shortest_source_
            ? fmt::format("the shortest source, '{}' of camera '{}', has {} frames (0 to {})",
                          shortest_source_->location, rig_file_.rig.cameras[shortest_source_->camera].name(),
                          shortest_source_->frames, shortest_source_->frames - 1)
            : std::string("frames count from 0");
    throw Error(ErrorKind::kRange, fmt::format("frame {} is out of range: {}", index, why));
  }
  for (const auto& camera : cameras_) camera->Expect(index);
  FrameSet set{index, static_cast<double>(index) / frame_rate_hz_, {}};
  for (const auto& camera : cameras_) {
    set.cameras.push_back(camera->Take(stop).frame);
  }
  if (const auto captured_at = set.cameras.front().captured_at; captured_at && !shortest_source_) {
    if (!first_capture_) first_capture_ = captured_at;
    set.time_s = std::chrono::duration<double>(*captured_at - *first_capture_).count();
  }
  return set;
}

std::vector<std::string> RecordedRig::Warnings() const {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < sources_.size(); ++i)
    if (sources_[i] != nullptr) AddWarningOf(*sources_[i], rig_file_.rig.cameras[i].name(), &warnings);
  return warnings;
}

std::vector<BackgroundReference> RecordedRig::ReadBackgrounds(const core::Progress& progress,
                                                              std::stop_token stop) {
  return ReadBackgroundReferences(rig_file_, progress, stop);
}

}  // namespace elbowroom::recon
