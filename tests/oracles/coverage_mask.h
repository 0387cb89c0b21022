// How much of each pixel solids cover: the soft mask that a perfect segmentation of a noise-free picture
// yields.
#pragma once

#include <span>

#include "core/camera_model.h"
#include "core/soft_mask.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::oracles {

// Coverage is counted on kCoverageSamples^2 rays a pixel (within three pixels of where the labels of the
// centre rays differ; elsewhere it is that label), to 1/255; object from 128. `footprint_px` is the side of
// the square that a pixel gathers light from: 1 is its own, with which the boundary by marching squares lies
// up to 0.09 px beside the true one (a pixel that the edge doesn't touch has nothing to say of it); 2 is that
// of a lens as sharp as its sensor, with which a straight edge along the grid is exact. Something thinner
// than a pixel that no centre ray meets is lost. Throws: core::Error{kCamera} when the lens has no ray for
// some pixel.
inline constexpr int kCoverageSamples = 12;
[[nodiscard]] core::SoftMask CoverageMask(const core::CameraModel& camera,
                                          std::span<const recon::Solid> solids, double footprint_px = 1.0);

// The same mask without levels: its boundary is halfway between pixel centres, or on their squares' sides.
[[nodiscard]] core::BitMask CenterMask(const core::CameraModel& camera, std::span<const recon::Solid> solids);

}  // namespace elbowroom::oracles
