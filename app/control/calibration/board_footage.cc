#include "app/control/calibration/board_footage.h"

#include <fmt/format.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <utility>

#include "core/error.h"
#include "recon/boards/board_finder.h"
#include "recon/footage/image_source.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;
using core::FrameIndex;

struct OpenedCamera {
  recon::UncalibratedSource frames;
  std::optional<recon::UncalibratedSource> photos;
  recon::FrameStamps stamps;  // empty: none
};

OpenedCamera Open(const CameraFootage& camera, const std::stop_token& stop) {
  OpenedCamera opened{recon::OpenUncalibratedSource(camera.frames, camera.name, stop), std::nullopt, {}};
  if (!camera.intrinsics.empty()) {
    opened.photos = recon::OpenUncalibratedSource(camera.intrinsics, camera.name, stop);
    if (opened.photos->size_px != opened.frames.size_px) {
      throw Error(
          ErrorKind::kCamera,
          fmt::format("camera '{}': its intrinsics are pictures of {} x {} px, but its frames are {} x {}; "
                      "take both at one size",
                      camera.name, opened.photos->size_px.width, opened.photos->size_px.height,
                      opened.frames.size_px.width, opened.frames.size_px.height));
    }
  }
  if (!camera.timestamps.empty())
    opened.stamps = recon::ReadFrameStamps(camera.timestamps, fmt::format("camera '{}'", camera.name));
  return opened;
}

// Frame i of each camera, as far as the longest footage goes.
std::vector<recon::StampedSet> SetsByNumber(const std::vector<OpenedCamera>& cameras,
                                            const std::optional<double>& period_s) {
  FrameIndex longest = 0;
  for (const OpenedCamera& camera : cameras)
    longest = std::max(longest, camera.frames.pictures->frame_count());
  std::vector<recon::StampedSet> sets(static_cast<std::size_t>(longest));
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const double time_s = static_cast<double>(i) * period_s.value_or(0.0);
    for (const OpenedCamera& camera : cameras) {
      const auto frame = static_cast<FrameIndex>(i);
      const bool has = frame < camera.frames.pictures->frame_count();
      sets[i].frames.push_back(has ? std::optional(recon::StampedFrame{frame, time_s}) : std::nullopt);
    }
  }
  return sets;
}

// Runs of three in a row, evenly spread, unless all can be kept.
std::vector<recon::StampedSet> Chosen(std::vector<recon::StampedSet> sets) {
  constexpr std::size_t kRun = 3;
  if (sets.size() <= kMostBoardSets) return sets;
  std::vector<recon::StampedSet> chosen;
  const std::size_t runs = kMostBoardSets / kRun;
  for (std::size_t i = 0; i < runs; ++i) {
    const std::size_t first = i * (sets.size() - kRun) / (runs - 1);
    for (std::size_t k = first; k < first + kRun; ++k) chosen.push_back(std::move(sets[k]));
  }
  return chosen;
}

// Pictures of one source, of which the board is looked for in some.
class Search {
 public:
  Search(recon::ImageSource* pictures, std::vector<FrameIndex> wanted, const recon::BoardFinder& finder,
         std::stop_token stop)
      : pictures_(pictures), wanted_(std::move(wanted)), finder_(finder), stop_(std::move(stop)) {}

  // `report(done)` is called in order.
  template <typename Report>
  std::vector<BoardPicture> Run(const Report& report) {
    std::vector<BoardPicture> found;
    FrameIndex done = 0;
    const auto tokens = static_cast<std::size_t>(2 * tbb::this_task_arena::max_concurrency());
    tbb::parallel_pipeline(
        tokens,
        tbb::make_filter<void, Picture>(tbb::filter_mode::serial_in_order, [this](
                                                                               tbb::flow_control& control) {
          return Next(control);
        }) & tbb::make_filter<Picture, Looked>(tbb::filter_mode::parallel, [this](const Picture& picture) {
          return Looked{picture.frame, finder_.Find(picture.image_bgr)};
        }) & tbb::make_filter<Looked, void>(tbb::filter_mode::serial_in_order, [&](const Looked& looked) {
          if (looked.sighting) found.push_back({looked.frame, *looked.sighting});
          report(++done);
        }));
    return found;
  }

  // The first wanted frame that the source promised and didn't have.
  [[nodiscard]] std::optional<FrameIndex> missing_from() const { return missing_from_; }

 private:
  struct Picture {
    FrameIndex frame = 0;
    cv::Mat image_bgr;
  };
  struct Looked {
    FrameIndex frame = 0;
    std::optional<recon::BoardSighting> sighting;
  };

  Picture Next(tbb::flow_control& control) {
    core::ThrowIfStopped(stop_, "looking for the board");
    if (next_ < wanted_.size()) {
      const FrameIndex frame = wanted_[next_++];
      if (auto picture = pictures_->Read(frame, stop_)) return {frame, std::move(picture->image_bgr)};
      missing_from_ = frame;
    }
    control.stop();
    return {};
  }

  recon::ImageSource* pictures_;
  std::vector<FrameIndex> wanted_;
  std::size_t next_ = 0;
  std::optional<FrameIndex> missing_from_;
  const recon::BoardFinder& finder_;
  std::stop_token stop_;
};

std::vector<FrameIndex> All(const recon::ImageSource& pictures) {
  std::vector<FrameIndex> all(static_cast<std::size_t>(pictures.frame_count()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<FrameIndex>(i);
  return all;
}

std::vector<FrameIndex> Wanted(const std::vector<recon::StampedSet>& sets, std::size_t camera) {
  std::vector<FrameIndex> wanted;
  for (const recon::StampedSet& set : sets)
    if (set.frames[camera]) wanted.push_back(set.frames[camera]->frame);
  std::ranges::sort(wanted);
  const auto twice = std::ranges::unique(wanted);
  wanted.erase(twice.begin(), twice.end());
  return wanted;
}

void RequireStampsOfAll(const CalibrationFile& file, const std::vector<OpenedCamera>& cameras) {
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].stamps.empty()) {
      throw Error(
          ErrorKind::kCamera,
          fmt::format(
              "camera '{}' has no timestamps, but others have; give stamps for all cameras or for none",
              file.cameras[i].name));
    }
    const FrameIndex frames = cameras[i].frames.pictures->frame_count();
    const auto stamps = static_cast<FrameIndex>(cameras[i].stamps.size());
    if (stamps > frames) {
      throw Error(
          ErrorKind::kCamera,
          fmt::format("camera '{}': there are stamps for {} frames, but '{}' has {}; use the stamps of this "
                      "recording",
                      file.cameras[i].name, stamps, file.cameras[i].frames, frames));
    }
  }
}

// Frame i goes with frame i: footage that begins at other instants is not seen here, but other lengths tell
// of it.
void WarnOfLengths(const CalibrationFile& file, const std::vector<OpenedCamera>& cameras,
                   BoardFootage* footage) {
  const auto length = [&](std::size_t i) { return cameras[i].frames.pictures->frame_count(); };
  std::size_t shortest = 0, longest = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (length(i) < length(shortest)) shortest = i;
    if (length(i) > length(longest)) longest = i;
  }
  if (length(shortest) == length(longest)) return;
  footage->warnings.push_back(fmt::format(
      "camera '{}' has {} frames and camera '{}' {}; without timestamps frame 0 of one is taken at the "
      "instant of "
      "frame 0 of the other: make sure that they begin together",
      file.cameras[shortest].name, length(shortest), file.cameras[longest].name, length(longest)));
}

// Which frames belong together, and how far apart they are in time.
void FormSets(const CalibrationFile& file, std::vector<OpenedCamera>* cameras, BoardFootage* footage) {
  const bool has_stamps =
      std::ranges::any_of(*cameras, [](const OpenedCamera& camera) { return !camera.stamps.empty(); });
  if (!has_stamps) {
    const auto rate_hz = cameras->front().frames.pictures->frame_rate_hz();
    if (rate_hz && *rate_hz > 0.0) footage->period_s = 1.0 / *rate_hz;
    WarnOfLengths(file, *cameras, footage);
    footage->sets = Chosen(SetsByNumber(*cameras, footage->period_s));
    return;
  }
  RequireStampsOfAll(file, *cameras);
  std::vector<recon::FrameStamps> stamps;
  for (OpenedCamera& camera : *cameras) stamps.push_back(std::move(camera.stamps));
  footage->sets = Chosen(recon::SetsByNearestStamp(stamps));
  for (const recon::FrameStamps& of_camera : stamps)
    footage->period_s =
        std::max(footage->period_s.value_or(0.0), recon::MedianPeriod(of_camera).value_or(0.0));
}

// Looks for the board in the pictures of all cameras, and counts them for the progress.
class BoardSearch {
 public:
  BoardSearch(const recon::Board& board, const core::Progress& progress, std::stop_token stop)
      : finder_(board), progress_(progress), stop_(std::move(stop)) {}

  void Expect(FrameIndex pictures) { total_ += pictures; }

  std::vector<BoardPicture> Run(recon::ImageSource* pictures, std::vector<FrameIndex> frames,
                                const std::string& camera) {
    const FrameIndex count = std::ssize(frames);
    const FrameIndex promised = pictures->frame_count();
    Search search(pictures, std::move(frames), finder_, stop_);
    std::vector<BoardPicture> found = search.Run([&](FrameIndex looked_at) {
      progress_.Report(done_ + looked_at, total_, "looking for the board, " + camera);
    });
    done_ += count;
    // Containers are often off by a frame or two; that isn't a loss.
    constexpr FrameIndex kOftenMissing = 3;
    const auto missing_from = search.missing_from();
    if (missing_from && promised - *missing_from > kOftenMissing) {
      warnings_.push_back(
          fmt::format("camera '{}': its footage promises {} frames, but has none from about frame {} on: it "
                      "was cut short, and "
                      "the rest is missing",
                      camera, promised, *missing_from));
    }
    return found;
  }

  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  recon::BoardFinder finder_;
  const core::Progress& progress_;
  std::stop_token stop_;
  FrameIndex done_ = 0;
  FrameIndex total_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace

BoardFootage FindBoards(const CalibrationFile& file, const core::Progress& progress,
                        const std::stop_token& stop) {
  std::vector<OpenedCamera> cameras;
  for (const CameraFootage& camera : file.cameras) cameras.push_back(Open(camera, stop));
  BoardFootage footage;
  FormSets(file, &cameras, &footage);
  BoardSearch search(file.board, progress, stop);
  std::vector<std::vector<FrameIndex>> wanted;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    wanted.push_back(Wanted(footage.sets, i));
    search.Expect(std::ssize(wanted.back()));
    if (cameras[i].photos) search.Expect(cameras[i].photos->pictures->frame_count());
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    OpenedCamera& camera = cameras[i];
    CameraSightings sightings;
    sightings.name = file.cameras[i].name;
    sightings.width_px = camera.frames.size_px.width;
    sightings.height_px = camera.frames.size_px.height;
    sightings.looked_at = std::ssize(wanted[i]);
    sightings.in_frames = search.Run(camera.frames.pictures.get(), std::move(wanted[i]), sightings.name);
    if (camera.photos) {
      recon::ImageSource& photos = *camera.photos->pictures;
      sightings.photos = photos.frame_count();
      sightings.in_photos = search.Run(&photos, All(photos), sightings.name);
    }
    footage.cameras.push_back(std::move(sightings));
  }
  footage.warnings.insert(footage.warnings.end(), search.warnings().begin(), search.warnings().end());
  return footage;
}

std::vector<recon::StampedSet> SetsAfterOffsets(const BoardFootage& footage,
                                                const std::vector<double>& offsets_s) {
  std::vector<recon::FrameStamps> stamps(footage.cameras.size()), scene_times(footage.cameras.size());
  for (const recon::StampedSet& set : footage.sets) {
    for (std::size_t i = 0; i < set.frames.size(); ++i) {
      if (!set.frames[i]) continue;
      const auto frame = static_cast<std::size_t>(set.frames[i]->frame);
      if (frame >= stamps[i].size()) stamps[i].resize(frame + 1), scene_times[i].resize(frame + 1);
      stamps[i][frame] = set.frames[i]->time_s;
      scene_times[i][frame] = set.frames[i]->time_s + offsets_s[i];
    }
  }
  std::vector<recon::StampedSet> sets = recon::SetsByNearestStamp(scene_times);
  for (recon::StampedSet& set : sets)
    for (std::size_t i = 0; i < set.frames.size(); ++i)
      if (auto& frame = set.frames[i]) frame->time_s = *stamps[i][static_cast<std::size_t>(frame->frame)];
  return sets;
}

}  // namespace elbowroom::control
