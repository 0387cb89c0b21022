#include "app/control/replay/replay_segmentation.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "app/control/segmentation/segmentation_settings.h"
#include "app/control/segmentation/segmentation_table.h"
#include "core/error.h"
#include "recon/images/mask_image.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;

// Where a session keeps which files its silhouettes come from, if they were segmented again.
constexpr const char* kPicturesKey = "segmentation.pictures";
constexpr const char* kBackgroundsKey = "segmentation.backgrounds";

std::vector<std::optional<std::uint64_t>> NumbersOf(const core::FrameRecord& frame, std::size_t cameras) {
  if (frame.stamps.empty())
    return std::vector<std::optional<std::uint64_t>>(cameras, static_cast<std::uint64_t>(frame.frame));
  std::vector<std::optional<std::uint64_t>> numbers;
  for (const std::optional<core::CameraStamp>& stamp : frame.stamps)
    numbers.push_back(stamp ? std::optional(stamp->picture) : std::nullopt);
  return numbers;
}

}  // namespace

SegmentingCount& SegmentingCount::operator+=(const SegmentingCount& other) {
  pictures += other.pictures;
  missing += other.missing;
  silhouettes_that_differ += other.silhouettes_that_differ;
  stats += other.stats;
  return *this;
}

ReplaySegmentation::ReplaySegmentation(const sessions::SessionReader& recorded,
                                       const SegmentingOptions& options, const core::Progress& progress,
                                       const std::stop_token& stop)
    : recorded_(recorded),
      footage_(FindFootage(recorded, options.rig, progress, stop)),
      pictures_(footage_.rig_file, stop) {
  if (!footage_.new_backgrounds.empty()) backgrounds_ = absolute(options.rig);
  FindSettings(options);
  TellChanges();
  segmenter_.emplace(pictures_.ReadBackgrounds(progress, stop), settings_, recorded.header().rig);
}

void ReplaySegmentation::FindSettings(const SegmentingOptions& options) {
  const core::SessionHeader& header = recorded_.header();
  const auto segmented_before = header.settings.find(kBackgroundsKey);
  if (footage_.is_named && options.rig.empty() && segmented_before != header.settings.end())
    throw Error(ErrorKind::kFormat,
                fmt::format("session '{}': its silhouettes come from the backgrounds of '{}'; give that rig, "
                            "or another one, with --rig",
                            recorded_.path().string(), segmented_before->second));
  if (!options.settings.empty()) {
    SegmentationTable table = ReadSegmentationFile(options.settings, header.rig);
    settings_ = std::move(table.options);
    boundary_sigma_px_ = table.boundary_sigma_px;
    return;
  }
  try {
    settings_ = OptionsFrom(header.settings, header.rig);
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("session '{}': {}; give all of them with --segmentation",
                                          recorded_.path().string(), error.what()));
  }
  ReadIgnoredPixels();
}

// The masks beside the footage, if the recorded settings have any.
void ReplaySegmentation::ReadIgnoredPixels() {
  const core::SessionHeader& header = recorded_.header();
  for (core::CameraIndex i = 0; i < header.rig.cameras.size(); ++i) {
    const core::CameraModel& camera = header.rig.cameras[i];
    const std::int64_t ignored = IgnoredPixelsOf(header.settings, camera);
    if (ignored == 0) continue;
    const std::filesystem::path file = IgnoredPixelsFile(footage_.location.parent_path(), i);
    core::BitMask mask;
    if (footage_.is_named && exists(file))
      mask = recon::ReadMaskImage(file, fmt::format("the ignore mask of camera '{}'", camera.name()));
    if (static_cast<std::int64_t>(mask.CountObjectPixels()) != ignored)
      throw Error(ErrorKind::kFormat,
                  fmt::format("session '{}': {} pixels of camera '{}' were ignored, and the mask that says "
                              "which isn't kept; give the trial's file with --segmentation",
                              recorded_.path().string(), ignored, camera.name()));
    std::ranges::find(settings_.cameras, camera.name(), &recon::CameraSegmentation::camera)->ignore =
        std::move(mask);
  }
}

void ReplaySegmentation::TellChanges() {
  const core::SessionHeader& header = recorded_.header();
  Settings before = SettingsOf(recon::SegmentationOptions());  // what an older session doesn't have
  for (const auto& [key, value] : header.settings)
    if (key != kPicturesKey && key != kBackgroundsKey) before[key] = value;
  const Settings now = SettingsOf(settings_);
  Settings all = before;
  all.insert(now.begin(), now.end());
  const auto text = [](const Settings& settings, const std::string& key) {
    const auto found = settings.find(key);
    return found == settings.end() ? std::string("not set") : found->second;
  };
  for (const auto& [key, unused] : all)
    if (text(before, key) != text(now, key))
      changes_.push_back(fmt::format("{}: {} instead of {}", key, text(now, key), text(before, key)));
  const std::optional<core::RigErrors>& errors = header.rig_quality.errors;
  if (errors && boundary_sigma_px_ && *boundary_sigma_px_ != errors->boundary_sigma_px)
    changes_.push_back(fmt::format("segmentation.boundary_sigma_px: {} instead of {}", *boundary_sigma_px_,
                                   errors->boundary_sigma_px));
  const auto segmented_before = header.settings.find(kBackgroundsKey);
  if (segmented_before == header.settings.end()) {
    changes_.insert(changes_.end(), footage_.new_backgrounds.begin(), footage_.new_backgrounds.end());
  } else if (segmented_before->second != backgrounds_) {
    changes_.push_back(fmt::format("backgrounds of {} instead of '{}'",
                                   backgrounds_.empty() ? "the recording" : "'" + backgrounds_.string() + "'",
                                   segmented_before->second));
  }
}

void ReplaySegmentation::Describe(core::SessionHeader* header) const {
  std::erase_if(header->settings,
                [](const auto& setting) { return setting.first.starts_with("segmentation."); });
  header->settings.merge(SettingsOf(settings_));
  header->settings[kPicturesKey] = footage_.location.string();
  if (!backgrounds_.empty()) header->settings[kBackgroundsKey] = backgrounds_.string();
  if (header->rig_quality.errors && boundary_sigma_px_)
    header->rig_quality.errors->boundary_sigma_px = *boundary_sigma_px_;
}

recon::FrameSet ReplaySegmentation::ReadFrames(core::FrameRecord* frame, SegmentingCount* count,
                                               const std::stop_token& stop) {
  const core::Rig& rig = recorded_.header().rig;
  const std::vector<std::optional<std::uint64_t>> numbers = NumbersOf(*frame, rig.cameras.size());
  std::vector<std::optional<recon::CameraFrame>> pictures = pictures_.ReadPictures(numbers, stop);
  recon::FrameSet set{frame->frame, frame->time_s, {}};
  for (core::CameraIndex i = 0; i < pictures.size(); ++i) {
    set.cameras.push_back(pictures[i] ? *std::move(pictures[i]) : recon::CameraFrame());
    if (!frame->stamps.empty() && !pictures[i] && numbers[i]) {
      if (!footage_.is_named)
        throw Error(ErrorKind::kFile,
                    fmt::format("camera '{}': the footage of '{}' has no picture {}, by which frame {} of "
                                "session '{}' was judged; give the footage of that trial",
                                rig.cameras[i].name(), footage_.location.string(), *numbers[i], frame->frame,
                                recorded_.path().string()));
      frame->stamps[i].reset();
      ++count->missing;
    }
    if (!frame->stamps.empty()) set.cameras.back().stamp = frame->stamps[i];
    count->pictures += set.cameras.back().image_bgr.empty() ? 0 : 1;
  }
  return set;
}

SegmentingCount ReplaySegmentation::Segment(core::FrameRecord* frame, const std::stop_token& stop) {
  SegmentingCount count;
  const recon::FrameSet set = ReadFrames(frame, &count, stop);
  if (!frame->stamps.empty() &&
      std::ranges::none_of(frame->stamps, [](const auto& stamp) { return stamp.has_value(); }))
    throw Error(ErrorKind::kRange,
                fmt::format("frame {} of session '{}': none of its pictures is in the footage '{}'; choose "
                            "frames before or after it with --frames",
                            frame->frame, recorded_.path().string(), footage_.location.string()));
  std::vector<core::SoftMask> masks = segmenter_->SegmentSoft(set, &count.stats);
  for (core::CameraIndex i = 0; i < masks.size(); ++i)
    count.silhouettes_that_differ += masks[i] == (*frame->masks)[i] ? 0 : 1;
  if (count.silhouettes_that_differ > 0)
    frame->masks = std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
  return count;
}

}  // namespace elbowroom::control
