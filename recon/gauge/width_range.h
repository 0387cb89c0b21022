// The radii, and the bows, that one camera's ready mask allows.
#pragma once

#include <span>

namespace elbowroom::recon {

// A crossing on a side of the rod: its error and how far off it may be, mm across the line of sight, and
// where it is along the axis.
struct SidePoint {
  int side = 1;  // 1 or -1
  double along_mm = 0.0;
  double error_mm = 0.0;  // farther from the fitted axis than the fitted radius
  double limit_mm = 0.0;  // > 0
};

struct RadiusRange {
  double low_mm = 0.0;  // what may be added to the fitted radius
  double high_mm = 0.0;
  double excess_mm = 0.0;  // by so much the limits were too small for any straight rod; 0: they weren't
};

// Over all straight rods, shifted and turned in the camera's picture, whose every crossing is within its
// limit: the least and the largest radius (docs/gauge.md; width_range_test holds it to a search). Where no
// rod is, the limits are first raised to those of the rod that fits best, and once more by as much. Throws:
// PreconditionError when a side has fewer than two points.
[[nodiscard]] RadiusRange RadiiWithin(std::span<const SidePoint> points);

struct BowRange {
  double low_mm = 0.0;
  double high_mm = 0.0;
};

// The same for the bow b of a rod whose sides are off by side * b * (along / half)^2, besides shift, turn and
// radius, where `half_mm` > 0. Throws: as RadiiWithin.
[[nodiscard]] BowRange BowsWithin(std::span<const SidePoint> points, double half_mm);

}  // namespace elbowroom::recon
