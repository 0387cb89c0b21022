// Connected regions of a bit mask, run by run, and the small ones taken away.
#pragma once

#include <cstdint>
#include <vector>

#include "core/bit_mask.h"

namespace elbowroom::recon {

// Pixels [x0, x1) of row y, all of one label and no longer on either side.
struct Run {
  int y = 0;
  int x0 = 0;
  int x1 = 0;
  std::uint32_t region = 0;  // index into Regions::area_px
};

struct Regions {
  std::vector<Run> runs;  // by row, then from the left
  std::vector<std::int64_t> area_px;
};

// The 8-connected regions of object pixels.
[[nodiscard]] Regions ObjectRegions(const core::BitMask& mask);

// 8-connected object regions of fewer than `least_px` pixels become background.
void RemoveSmallBlobs(core::BitMask& mask, int least_px);

// 4-connected background regions of fewer than `least_px` pixels become object. A region that reaches the
// picture's edge counts with the pixels that it has in the picture.
void FillSmallHoles(core::BitMask& mask, int least_px);

// Both: first the blobs, then the holes. Quicker than one after the other, since holes lie between the runs
// of the blobs that stay.
void CleanUp(core::BitMask& mask, int least_blob_px, int least_hole_px);

// All runs of a region that `keep` (one a region) is false for become background.
void ClearRegions(core::BitMask& mask, const Regions& regions, const std::vector<bool>& keep);

}  // namespace elbowroom::recon
