#include "tests/accuracy/synthetic_segmentation.h"

#include "core/error.h"
#include "recon/footage/background.h"
#include "recon/segmentation/segmentation.h"
#include "recon/synthetic/camera_view.h"
#include "recon/synthetic/sensor_noise.h"

namespace elbowroom::accuracy {

std::vector<core::SoftMask> SegmentSights(const core::Rig& rig, std::span<const oracles::Sight> sights,
                                          double noise_levels, std::uint64_t seed) {
  core::Require(rig.cameras.size() == sights.size(), "one sight a camera");
  std::vector<core::SoftMask> masks;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const recon::CameraView view(rig.cameras[i], seed);
    const auto capture = [&](std::int64_t frame, std::span<const recon::Solid> solids) {
      return view.Render(solids, {.noise_sigma_levels = noise_levels,
                                  .noise_seed = recon::StreamSeed(seed, frame, i, 0),
                                  .samples_per_pixel_side = kRaysPerPixelSide});
    };
    recon::BackgroundAccumulator background;
    for (int frame = 1; frame <= kBackgroundFrames; ++frame) background.Add(capture(-frame, {}));
    masks.push_back(recon::Segmenter(background.Reference(), {}).SegmentSoft(capture(0, sights[i].solids)));
  }
  return masks;
}

}  // namespace elbowroom::accuracy
