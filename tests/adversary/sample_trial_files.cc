#include "tests/adversary/sample_trial_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/bit_mask.h"
#include "recon/mask_image.h"
#include "recon/rig_file.h"
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

}  // namespace

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
  test_support::WriteBoxStl(folder / "box.stl", 60.0);
  test_support::WriteText(
      folder / "layout.toml",
      "unit = \"mm\"\n[[part]]\nname = \"box\"\nfile = \"box.stl\"\nposition_mm = [60, 0, 200]\n");
  test_support::WriteText(folder / "trial.toml", "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n");
  return folder / "trial.toml";
}

}  // namespace elbowroom::adversary
