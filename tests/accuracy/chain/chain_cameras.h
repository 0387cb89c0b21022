// Live cameras before the simulated chain's objects: sensors, lamps, clocks, frame sets.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/rig.h"
#include "recon/capture/frame_set_assembler.h"
#include "recon/footage/frame_set.h"
#include "recon/synthetic/camera_view.h"
#include "recon/synthetic/solids.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::accuracy {

// The light at a time, as a factor on that of a still day: lamps on mains of 50 Hz, and a level that drifts.
struct ChainLight {
  double pulse_phase_rad = 0.0;
  double level = 1.0;
  double drift_per_s = 0.0;

  [[nodiscard]] double GainAt(double time_s) const;
};

// The true cameras of a rig: what they see, as pictures. Immutable. Thread: any.
class ChainCameras {
 public:
  // `seed` picks the cloth on the table.
  ChainCameras(core::Rig truth, std::uint64_t seed);

  [[nodiscard]] const core::Rig& rig() const { return rig_; }

  // What a camera sees at one instant, 8-bit BGR: edges mixed from 16 rays a pixel, blurred by the lens,
  // under a light, with noise of its own for each seed.
  [[nodiscard]] cv::Mat Take(core::CameraIndex camera, std::span<const recon::Solid> solids, double gain,
                             std::uint64_t seed) const;

  // The empty scene under the lamps' pulse, measured as the program does.
  [[nodiscard]] std::vector<recon::BackgroundReference> TakeBackgrounds(std::uint64_t seed) const;

 private:
  core::Rig rig_;
  std::vector<recon::CameraView> views_;
  std::vector<cv::Mat> empty_bgr_;  // CV_32FC3, as the lens shows it
  std::vector<float> noise_;        // standard normal; each row of a picture takes a stretch of it
};

// Free-running cameras and their stamps, put together by the program's assembler. Thread: one at a time.
class ChainClock {
 public:
  ChainClock(std::size_t cameras, std::uint64_t seed);

  struct Instant {
    double true_s = 0.0;      // of the exposure
    core::CameraStamp stamp;  // what the program is told of it
  };
  struct Set {
    double time_s = 0.0;  // as the program takes it: the median of the stamps
    std::vector<Instant> cameras;
  };
  // The next set in which no camera is missing.
  [[nodiscard]] Set Next();

 private:
  struct Camera {
    double phase_s = 0.0, period_s = 0.0, stamp_bias_s = 0.0;
    std::vector<Instant> instants;  // by number
  };
  void TakeNextPicture();

  recon::Random random_;
  std::vector<Camera> cameras_;
  recon::FrameSetAssembler assembler_;
  recon::CaptureClock::time_point now_;
};

}  // namespace elbowroom::accuracy
