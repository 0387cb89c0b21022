#include "tests/adversary/sample_trial_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <thread>

#include "core/bit_mask.h"
#include "recon/images/mask_image.h"
#include "recon/rig_files/rig_file.h"
#include "tests/app/mask_rig.h"
#include "tests/support/text_file.h"

namespace elbowroom::adversary {
namespace {

namespace fs = std::filesystem;

// The mask `shift` pixels to the right: so the silhouettes of neighbouring frames differ.
core::BitMask Shifted(const core::BitMask& mask, int shift_px) {
  core::BitMask shifted(mask.width_px(), mask.height_px());
  for (int y = 0; y < mask.height_px(); ++y) {
    for (int x = std::max(0, shift_px); x < std::min(mask.width_px(), mask.width_px() + shift_px); ++x) {
      if (mask.At(x - shift_px, y)) shifted.Set(x, y, true);
    }
  }
  return shifted;
}

fs::path WriteTrialWithABox(const fs::path& folder) {
  test_support::WriteBoxStl(folder / "box.stl", 60.0);
  test_support::WriteText(
      folder / "layout.toml",
      "unit = \"mm\"\n[[part]]\nname = \"box\"\nfile = \"box.stl\"\nposition_mm = [60, 0, 200]\n");
  test_support::WriteText(folder / "trial.toml", "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n");
  return folder / "trial.toml";
}

// The picture as a network camera sends it, at the camera's rate.
recon::testing::MjpegServer::Part AtItsRate(const fs::path& picture) {
  static constexpr std::chrono::milliseconds kBetweenPictures(40);
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", cv::imread(picture.string()), jpeg);
  return [begin = std::chrono::steady_clock::now(),
          bytes = std::string(jpeg.begin(), jpeg.end())](int index) -> std::optional<std::string> {
    std::this_thread::sleep_until(begin + index * kBetweenPictures);
    return bytes;
  };
}

}  // namespace

LiveTrialFiles::LiveTrialFiles(const fs::path& folder) {
  fs::create_directories(folder);
  const fs::path rig = test_support::WriteBallFootage(folder);
  recon::RigFile file = recon::ReadRigFile(rig);
  for (std::size_t i = 0; i < file.sources.size(); ++i) {
    const fs::path picture = folder / file.rig.cameras[i].name() / "ball_0000.png";
    cameras_.push_back(std::make_unique<recon::testing::MjpegServer>(AtItsRate(picture)));
    file.sources[i].frames = cameras_.back()->url();
  }
  recon::WriteRigFile(file, rig);
  trial_ = WriteTrialWithABox(folder);
}

fs::path WriteMaskTrial(const fs::path& folder, int frames) {
  constexpr int kDifferent = 16;
  fs::create_directories(folder);
  const fs::path rig = test_support::WriteBallRig(folder);
  for (const core::CameraModel& camera : recon::ReadRigFile(rig).rig.cameras) {
    const fs::path first = folder / camera.name() / "mask_0000.png";
    const core::BitMask mask = recon::ReadMaskImage(first, camera.name());
    for (int frame = 1; frame < frames; ++frame) {
      const fs::path file = folder / camera.name() / fmt::format("mask_{:04d}.png", frame);
      if (frame < kDifferent) {
        recon::WriteMaskPng(Shifted(mask, frame - kDifferent / 2), file);
      } else {
        fs::create_hard_link(folder / camera.name() / fmt::format("mask_{:04d}.png", frame % kDifferent),
                             file);
      }
    }
  }
  return WriteTrialWithABox(folder);
}

}  // namespace elbowroom::adversary
