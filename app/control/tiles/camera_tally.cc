#include "app/control/tiles/camera_tally.h"

namespace elbowroom::control {
namespace {

constexpr double kRateWindowS = 2.0;
constexpr double kMsPerS = 1000.0;

// From the oldest of these stamps to the newest.
std::optional<double> RateOf(const std::deque<core::CameraStamp>& stamps) {
  if (stamps.size() < 2) return std::nullopt;
  const double seconds = stamps.back().time_s - stamps.front().time_s;
  if (!(seconds > 0.0)) return std::nullopt;
  return static_cast<double>(stamps.back().picture - stamps.front().picture) / seconds;
}

}  // namespace

void CameraTally::Add(const core::FrameRecord& record, bool is_live) {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    Camera& camera = cameras_[i];
    if (is_live && !camera.figures.lost) camera.figures.lost = 0;
    camera.figures.skew_ms.reset();
    if (i >= record.stamps.size() || !record.stamps[i]) continue;
    const core::CameraStamp& stamp = *record.stamps[i];
    camera.figures.skew_ms = kMsPerS * (stamp.time_s - record.time_s);
    camera.recent.push_back(stamp);
    while (stamp.time_s - camera.recent.front().time_s > kRateWindowS) camera.recent.pop_front();
    camera.figures.rate_hz = RateOf(camera.recent);
  }
  for (const core::PictureLoss& loss : record.losses) {
    if (!is_live || loss.reason == core::LossReason::kUnpaired) continue;
    *cameras_.at(loss.camera).figures.lost += static_cast<std::int64_t>(loss.count());
  }
}

void CameraTally::AddLight(std::size_t camera, const recon::LightReport& report) {
  const std::lock_guard lock(mutex_);
  cameras_.at(camera).figures.light = report;
}

std::vector<CameraFigures> CameraTally::Figures() const {
  const std::lock_guard lock(mutex_);
  std::vector<CameraFigures> figures;
  for (const Camera& camera : cameras_) figures.push_back(camera.figures);
  return figures;
}

}  // namespace elbowroom::control
