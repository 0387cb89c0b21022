// The light of live cameras against their backgrounds, while they are checked.
#pragma once

#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/bit_mask.h"
#include "core/progress.h"
#include "recon/capture/captured_picture.h"
#include "recon/light/light_watch.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

// Looks only if every camera of the rig has a background and none has ready masks. Thread: Keep() from any;
// the rest from one.
class LightCheck {
 public:
  // Reads the backgrounds. Throws: Error{kCancelled} on a stop.
  LightCheck(const recon::RigFile& rig_file, const core::Progress& progress, const std::stop_token& stop);

  // Why the light isn't looked at, although the rig names backgrounds: one line; else empty.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

  // Holds a picture for Look(). If Look() doesn't come for 64 pictures of a camera, the rest are left out.
  void Keep(core::CameraIndex camera, const recon::CapturedPicture& picture);
  void Forget();  // what is held
  void Look();    // at what is held; 0.1 ms a picture of 640 x 480

  // Nothing: it isn't looked at, or no picture came.
  [[nodiscard]] std::optional<recon::LightReport> Report(core::CameraIndex camera) const;

 private:
  struct Camera {
    recon::LightWatch watch;
    core::BitMask no_object;
    std::vector<recon::CapturedPicture> held;
    bool has_looked = false;
  };
  mutable std::mutex mutex_;     // for `held`
  std::vector<Camera> cameras_;  // empty: nothing is looked at
  std::string trouble_;
};

}  // namespace elbowroom::control
