// What is known of each camera while a trial runs: its rate, its losses, its skew, its light.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "core/session.h"
#include "recon/light/light_report.h"

namespace elbowroom::control {

// Nothing: not known, as of recorded footage without stamps.
struct CameraFigures {
  std::optional<double> rate_hz;     // over the last two seconds, from the pictures' numbers and stamps
  std::optional<std::int64_t> lost;  // pictures since the trial began; of live cameras only
  std::optional<double> skew_ms;     // its stamp less the time of the last frame, if that has its picture
  std::optional<recon::LightReport> light;  // the last one; of live cameras only
};

// Counts every frame, shown or not. Thread: any.
class CameraTally {
 public:
  explicit CameraTally(std::size_t cameras) : cameras_(cameras) {}

  void Add(const core::FrameRecord& record, bool is_live);
  void AddLight(std::size_t camera, const recon::LightReport& report);

  [[nodiscard]] std::vector<CameraFigures> Figures() const;  // one a camera

 private:
  struct Camera {
    std::deque<core::CameraStamp> recent;
    CameraFigures figures;
  };
  mutable std::mutex mutex_;
  std::vector<Camera> cameras_;
};

}  // namespace elbowroom::control
