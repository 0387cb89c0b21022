// Many GigE Vision cameras in a process of their own, which can be switched off and on.
#pragma once

#include <sys/types.h>

#include <string>

#include "core/system/child_process.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::recon::testing {

// Forks in the constructor: this process has one thread then, and has its own network. The cameras send
// noise, 640 x 480, as fast as they are asked to.
class CameraFarm {
 public:
  explicit CameraFarm(int cameras);
  ~CameraFarm();
  CameraFarm(const CameraFarm&) = delete;
  CameraFarm& operator=(const CameraFarm&) = delete;

  // Returns once it is done.
  void Switch(int camera, bool is_on);
  void SetPacketLoss(int camera, double share);

  [[nodiscard]] RigFile Rig(double rate_hz) const;

 private:
  void Ask(const std::string& what);

  int cameras_;
  core::Descriptor to_, from_;
  pid_t process_ = -1;
};

}  // namespace elbowroom::recon::testing
