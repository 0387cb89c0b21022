#include "app/control/light/trial_light.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/error.h"

namespace elbowroom::control {

TrialLight::TrialLight(const core::Rig& rig, std::vector<recon::BackgroundReference> backgrounds,
                       const recon::SegmentationOptions& segmentation, OnLight on_light)
    : watches_(rig.cameras.size()), on_light_(std::move(on_light)), latest_(rig.cameras.size()) {
  core::Require(backgrounds.size() == rig.cameras.size(), "there is one background a camera");
  thread_ = std::jthread([this, rig, backgrounds = std::move(backgrounds), segmentation]() mutable {
    Prepare(rig, std::exchange(backgrounds, {}), segmentation);
    Watch();
  });
}

TrialLight::~TrialLight() { waiting_.Close(); }

void TrialLight::Offer(std::shared_ptr<const recon::FrameSet> frames, core::SharedMasks masks) {
  waiting_.Push({std::move(frames), std::move(masks)});
}

std::vector<std::string> TrialLight::TakeNotes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(notes_, {});
}

void TrialLight::Finish() {
  waiting_.Close();
  if (thread_.joinable()) thread_.join();
}

std::vector<recon::LightReport> TrialLight::reports() const {
  std::vector<recon::LightReport> reports;
  for (const auto& latest : latest_)
    if (latest) reports.push_back(*latest);
  return reports;
}

// On the watch's thread: choosing the pixels to look at takes longer than a frame.
void TrialLight::Prepare(const core::Rig& rig, const std::vector<recon::BackgroundReference>& backgrounds,
                         const recon::SegmentationOptions& segmentation) {
  const bool is_followed = segmentation.method == recon::SegmentationMethod::kAdaptive;
  for (std::size_t i = 0; i < backgrounds.size(); ++i) {
    if (backgrounds[i].mean_bgr.empty()) continue;
    const std::string& name = rig.cameras[i].name();
    const recon::CameraSegmentation* differing = segmentation.OfCamera(name);
    watches_[i].emplace(name, backgrounds[i], is_followed,
                        differing != nullptr ? differing->ignore : core::BitMask());
  }
}

void TrialLight::Watch() {
  while (const std::optional<Frame> frame = waiting_.Pop()) Look(*frame);
  for (std::size_t camera = 0; camera < watches_.size(); ++camera) Report(camera);
}

// Its own stamp is a picture's time: a lamp's pulse is told by milliseconds.
void TrialLight::Look(const Frame& frame) {
  const std::vector<recon::CameraFrame>& pictures = frame.frames->cameras;
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    if (!watches_[i] || pictures[i].image_bgr.empty()) continue;
    const double time_s = pictures[i].stamp ? pictures[i].stamp->time_s : frame.frames->time_s;
    watches_[i]->Add(pictures[i].image_bgr, (*frame.masks)[i].mask, time_s);
  }
  if (watches_.empty()) return;
  const double apart_s = kReportS / static_cast<double>(watches_.size());
  if (!next_report_s_) next_report_s_ = frame.frames->time_s + apart_s;
  if (frame.frames->time_s < *next_report_s_) return;
  next_report_s_ = frame.frames->time_s + apart_s;
  Report(std::exchange(next_camera_, (next_camera_ + 1) % watches_.size()));
}

void TrialLight::Report(std::size_t camera) {
  if (!watches_[camera]) return;
  const recon::LightReport& report = latest_[camera].emplace(watches_[camera]->Report());
  std::vector<std::string> notes = log_.Add(report.camera, report.advice, report.time_s);
  {
    const std::lock_guard lock(mutex_);
    std::ranges::move(notes, std::back_inserter(notes_));
  }
  if (on_light_) on_light_(report);
}

}  // namespace elbowroom::control
