#include "app/control/cameras/time_offsets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/error.h"
#include "recon/capture/live_rig.h"
#include "recon/capture/rig_source.h"
#include "recon/consistency/blink_offsets.h"
#include "recon/consistency/blink_region.h"
#include "recon/consistency/silhouette_offsets.h"
#include "recon/segmentation/frame_segmenter.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;
using recon::CameraFrame;
using recon::FrameSet;

// What the cameras show, one picture at a time. Both ways to find offsets are fed like this.
class OffsetFinder {
 public:
  virtual ~OffsetFinder() = default;
  // A picture that is new, with its stamp: `time_s`.
  virtual void Add(core::CameraIndex camera, const CameraFrame& picture, double time_s) = 0;
  // Once all pictures of a set were added.
  virtual void FinishSet(const FrameSet&) {}
  // Fills in what was found, by camera. Throws: Error{kGeometry} if the pictures don't tell.
  virtual void Find(TimeOffsets* result) = 0;
};

void SetChanges(const std::vector<double>& offset_s, const std::vector<double>& sigma_s,
                TimeOffsets* result) {
  for (std::size_t i = 0; i < result->cameras.size(); ++i) {
    result->cameras[i].change_s = offset_s[i];
    result->cameras[i].sigma_s = sigma_s[i];
  }
}

class SilhouetteFinder : public OffsetFinder {
 public:
  SilhouetteFinder(recon::FrameSetSource* source, const core::Progress& progress, const std::stop_token& stop)
      : rig_(source->rig()),
        pairs_(rig_, recon::MakeUndistortedPlanes(rig_)),
        segmenter_(source->ReadBackgrounds(progress, stop), recon::SegmentationOptions(), rig_),
        footage_(rig_.cameras.size()) {}

  void Add(core::CameraIndex camera, const CameraFrame&, double time_s) override {
    new_.emplace_back(camera, time_s);
  }

  void FinishSet(const FrameSet& frames) override {
    const std::vector<core::SoftMask> masks = segmenter_.SegmentSoft(frames);
    for (const auto& [camera, time_s] : std::exchange(new_, {}))
      footage_[camera].push_back({time_s, recon::FindTangents(pairs_, camera, masks[camera])});
  }

  void Find(TimeOffsets* result) override {
    const auto found = recon::FindSilhouetteOffsets(pairs_, footage_);
    if (!found)
      throw Error(
          ErrorKind::kGeometry,
          "the silhouettes don't tell the time offsets: move hands to and fro in view of all cameras, "
          "without a stop, for 10 s or longer");
    SetChanges(found->offset_s, found->sigma_s, result);
    result->rms_px = found->rms_px;
  }

 private:
  const core::Rig& rig_;
  recon::EpipolarPairs pairs_;
  recon::FrameSegmenter segmenter_;
  std::vector<std::pair<core::CameraIndex, double>> new_;  // of this set
  std::vector<std::vector<recon::StampedTangents>> footage_;
};

// The first pictures are kept to find the light in them.
class LightFinder : public OffsetFinder {
 public:
  LightFinder(const core::Rig& rig, std::vector<double> exposure_s) : exposure_s_(std::move(exposure_s)) {
    std::size_t set_bytes = 0;
    for (const core::CameraModel& camera : rig.cameras) {
      cameras_.emplace_back().name = camera.name();
      set_bytes += std::size_t{3} * static_cast<std::size_t>(camera.width_px()) *
                   static_cast<std::size_t>(camera.height_px());
    }
    constexpr std::size_t kMostBytes = 1'000'000'000, kLeast = 20, kMost = 90;
    searched_pictures_ = std::clamp(kMostBytes / set_bytes, kLeast, kMost);
  }

  void Add(core::CameraIndex index, const CameraFrame& picture, double time_s) override {
    Camera& camera = cameras_[index];
    if (picture.image_bgr.empty())
      throw Error(ErrorKind::kFormat,
                  fmt::format("camera '{}' has ready masks, which show no light", camera.name));
    camera.curve.stamp_s.push_back(time_s);
    if (camera.region) {
      camera.curve.brightness.push_back(recon::BrightnessIn(picture.image_bgr, *camera.region));
      return;
    }
    camera.searched.push_back(picture.image_bgr.clone());  // a live picture is lent
    if (camera.searched.size() == searched_pictures_) Search(&camera);
  }

  void Find(TimeOffsets* result) override {
    recon::BlinkOffsetOptions options;
    options.exposure_s = exposure_s_;
    std::vector<recon::BlinkCurve> curves;
    for (Camera& camera : cameras_) {
      if (!camera.region) Search(&camera);
      if (!camera.curve.is_linear)
        throw Error(
            ErrorKind::kGeometry,
            fmt::format("camera '{}': the light is at the highest level: expose less, or turn the lamp "
                        "away so that its halo shows",
                        camera.name));
      curves.push_back(std::move(camera.curve));
    }
    const auto found = recon::FindBlinkOffsets(curves, options);
    if (!found)
      throw Error(
          ErrorKind::kGeometry,
          "the light doesn't tell the time offsets: let it go on and off irregularly, for 0.05 to 0.5 s "
          "each, in view of all cameras for 20 s or longer");
    SetChanges(found->offset_s, found->sigma_s, result);
    result->edges = found->edges;
  }

 private:
  struct Camera {
    std::string name;
    std::vector<cv::Mat> searched;
    std::optional<recon::BlinkRegion> region;
    recon::BlinkCurve curve;
  };

  static void Search(Camera* camera) {
    constexpr std::size_t kLeast = 20;
    if (camera->searched.size() >= kLeast) camera->region = recon::FindBlinkingRegion(camera->searched);
    if (!camera->region)
      throw Error(
          ErrorKind::kGeometry,
          fmt::format("camera '{}' sees no blinking light in its first {} pictures: let a lamp go on and "
                      "off irregularly, for 0.05 to 0.5 s each, in view of all cameras",
                      camera->name, camera->searched.size()));
    camera->curve.is_linear = camera->region->is_linear;
    for (const cv::Mat& picture : std::exchange(camera->searched, {}))
      camera->curve.brightness.push_back(recon::BrightnessIn(picture, *camera->region));
  }

  std::vector<double> exposure_s_;  // by camera; 0: unknown
  std::size_t searched_pictures_ = 0;
  std::vector<Camera> cameras_;
};

// As the cameras read them back; of footage, as the rig file asked for them.
std::vector<double> ExposuresOf(const recon::FrameSetSource& source, const recon::RigFile& rig_file) {
  constexpr double kSPerUs = 1e-6;
  std::vector<double> exposure_s;
  for (const recon::CameraSources& sources : rig_file.sources)
    exposure_s.push_back(kSPerUs * sources.capture.exposure_us.value_or(0.0));
  if (const auto* live = dynamic_cast<const recon::LiveRig*>(&source); live != nullptr) {
    const std::vector<recon::CameraState> states = live->states();
    for (std::size_t i = 0; i < states.size(); ++i)
      exposure_s[i] = kSPerUs * states[i].report.exposure_us.value_or(0.0);
  }
  return exposure_s;
}

// Feeds the finder with each picture once, in the order of its camera's stamps.
class Feed {
 public:
  Feed(OffsetFinder* finder, TimeOffsets* result)
      : finder_(finder), result_(result), last_s_(result->cameras.size()) {}

  void Add(const FrameSet& frames) {
    const bool has_stamps =
        std::ranges::any_of(frames.cameras, [](const CameraFrame& f) { return f.stamp.has_value(); });
    lacks_stamps_ |= !has_stamps;
    if (sets_++ == 0) begin_s_ = frames.time_s;
    result_->seconds = frames.time_s - begin_s_;
    for (core::CameraIndex i = 0; i < frames.cameras.size(); ++i) {
      const CameraFrame& picture = frames.cameras[i];
      if (has_stamps && !picture.stamp) continue;
      const double time_s = has_stamps ? picture.stamp->time_s : frames.time_s;
      if (last_s_[i] && time_s <= *last_s_[i]) continue;
      last_s_[i] = time_s;
      ++result_->cameras[i].pictures;
      finder_->Add(i, picture, time_s);
    }
    finder_->FinishSet(frames);
  }

  [[nodiscard]] bool lacks_stamps() const { return lacks_stamps_; }

 private:
  OffsetFinder* finder_;
  TimeOffsets* result_;
  std::vector<std::optional<double>> last_s_;  // by camera
  std::int64_t sets_ = 0;
  double begin_s_ = 0.0;  // of the first set
  bool lacks_stamps_ = false;
};

}  // namespace

TimeOffsets MeasureTimeOffsets(const recon::RigFile& rig_file, const OffsetRequest& request,
                               const core::Progress& progress, const std::stop_token& stop) {
  constexpr double kLiveS = 30.0;
  TimeOffsets result;
  result.rig_file = rig_file;
  for (const core::CameraModel& camera : rig_file.rig.cameras)
    result.cameras.emplace_back().name = camera.name();
  if (result.cameras.size() < 2) throw Error(ErrorKind::kGeometry, "a rig of one camera has no time offsets");
  const std::shared_ptr<recon::FrameSetSource> source = recon::OpenRig(rig_file, stop);
  std::unique_ptr<OffsetFinder> finder;
  if (request.method == OffsetMethod::kSilhouettes)
    finder = std::make_unique<SilhouetteFinder>(source.get(), progress, stop);
  else
    finder = std::make_unique<LightFinder>(rig_file.rig, ExposuresOf(*source, rig_file));

  std::optional<double> until_s = request.seconds;
  if (!until_s && recon::IsLiveRig(rig_file)) until_s = kLiveS;
  Feed feed(finder.get(), &result);
  for (core::FrameIndex frame = 0; !until_s || result.seconds < *until_s; ++frame) {
    core::ThrowIfStopped(stop, "measuring time offsets");
    const std::optional<FrameSet> frames = source->TryRead(frame, stop);
    if (!frames) break;
    feed.Add(*frames);
    if (until_s)
      progress.Report(static_cast<std::int64_t>(result.seconds), static_cast<std::int64_t>(*until_s),
                      "measuring time offsets, second");
    else
      progress.Report(frame + 1, source->frame_count().value_or(0), "measuring time offsets, frame");
  }
  finder->Find(&result);
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    double& time_offset_s = result.rig_file.sources[i].time_offset_s;
    // Footage without stamps is read as if all pictures of a number were of one instant.
    time_offset_s = (feed.lacks_stamps() ? 0.0 : time_offset_s) + result.cameras[i].change_s;
    result.cameras[i].time_offset_s = time_offset_s;
  }
  result.warnings = source->Warnings();
  if (feed.lacks_stamps())
    result.warnings.emplace_back(
        "the footage has no stamps (timestamps in RIG.yml), so frames stay put together by their number, "
        "whatever the time offsets are");
  return result;
}

}  // namespace elbowroom::control
