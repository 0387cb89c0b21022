// The files of a small trial, on disk.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "tests/recon/footage/mjpeg_server.h"

namespace elbowroom::adversary {

// A trial of four cameras of the network, on this machine: each sends a picture of a ball, 25 a second, for
// as long as this lives.
class LiveTrialFiles {
 public:
  explicit LiveTrialFiles(const std::filesystem::path& folder);
  [[nodiscard]] const std::filesystem::path& trial() const { return trial_; }

 private:
  std::filesystem::path trial_;
  std::vector<std::unique_ptr<recon::testing::MjpegServer>> cameras_;
};

// A trial of so many frames on ready masks: a ball comes to a box and goes again, in four cameras of
// 320 x 240. Returns the path of trial.toml in `folder`, which is made.
std::filesystem::path WriteMaskTrial(const std::filesystem::path& folder, int frames);

}  // namespace elbowroom::adversary
