// One tile's part of the picture while planes are swept over it.
#pragma once

#include <array>

#include "recon/paper_methods/plane_sweep.h"
#include "recon/paper_methods/plane_sweep_kernel.h"

namespace elbowroom::recon {

struct SweptTile {
  int x0 = 0, y0 = 0;  // its first pixel
  SweepTile rays;
  // 1: a pixel of the view that has a ray and isn't hit yet.
  alignas(64) std::array<float, kSweepTilePixels> open{};
  std::array<float, kSweepTilePixels> depth_mm{};  // 0: not hit
  int open_pixels = 0;

  // Pixels that are still open after the plane was asked, and that some camera sees, are hit on it.
  void TakeHits(const SweepMarks& marks, double plane_mm);

  // Writes the depths of the pixels that the picture has.
  void CopyTo(DepthMap* picture) const;
};

// The tile whose first pixel is (x0, y0), multiples of kSweepTilePx: nothing is hit yet.
SweptTile MakeSweptTile(const SweepRays& rays, int x0, int y0);

}  // namespace elbowroom::recon
