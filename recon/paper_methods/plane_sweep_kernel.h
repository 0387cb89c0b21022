// The inner loop of the CPU plane sweep: the points of one tile on one plane, asked of one camera.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "recon/paper_methods/sweep_space.h"

namespace elbowroom::recon {

enum class SweepLens { kIdeal, kPolynomial, kFisheye };

// A tile's points on a plane, mm: origin + dx * along_x + dy * along_y.
struct SweepPoints {
  std::array<float, 3> origin{}, along_x{}, along_y{};
};

// One camera as the loop takes it; picture positions count from the first texel of its coverage.
struct SweepAsker {
  SweepPoints points;  // in cam
  float max_radius_squared = 0.0F;
  SweepLens lens = SweepLens::kIdeal;
  SweepLensCoefficients coefficients;
  float fx = 0.0F, skew = 0.0F, cx = 0.0F, fy = 0.0F, cy = 0.0F;
  std::array<float, 2> valid_min{}, valid_max{};      // CoverageTexture::valid_px
  std::array<float, 2> picture_min{}, picture_max{};  // where the camera sees
  bool exterior_is_object = false;
  const std::uint8_t* texels = nullptr;
  std::int32_t stride = 0;
};

// Axis-aligned bounds in the world.
struct SweepBox {
  SweepPoints points;  // in world
  std::array<float, 3> min{}, max{};
};

// 1 or 0 for each pixel. open: it isn't hit yet, and its point is object to all cameras asked so far. seen:
// one of these cameras sees the point.
struct SweepMarks {
  alignas(64) std::array<float, kSweepTilePixels> open{};
  alignas(64) std::array<float, kSweepTilePixels> seen{};
};

// Closes what is background to the camera, and marks what it sees. In single precision, by the widest
// vectors that the processor has; returns false when nothing is open any more.
bool AskSweepCamera(const SweepTile& tile, const SweepAsker& asker, SweepMarks* marks);

// Closes what is outside the box.
bool AskSweepBox(const SweepTile& tile, const SweepBox& box, SweepMarks* marks);

}  // namespace elbowroom::recon
