// When a light went on and off, as far as one camera's brightness tells.
#pragma once

#include <optional>
#include <vector>

namespace elbowroom::recon {

// A picture whose share is within so many sigmas of dark or lit shows no change.
inline constexpr double kUnnoticedSigmas = 4.0;

// A camera's light over time: one entry a picture, in the order of stamps.
struct BlinkCurve {
  std::vector<double> stamp_s;     // of the middle of the exposure
  std::vector<double> brightness;  // in any unit
  bool is_linear = true;           // the brightness is proportional to the light: BlinkRegion::is_linear
};

// The light changed once between two pictures, or within one's exposure. The change was at
//   a partly lit picture:  stamp_s + side * (share - 1/2) * exposure, side = -1 for on and +1 for off;
//   else: after `after_s` and before `before_s`, each half an exposure from a picture that shows no change.
struct BlinkEdge {
  bool is_on = false;
  std::optional<double>
      share;              // of the exposure in which the light was on; nothing: no picture is partly lit
  double stamp_s = 0.0;   // of the partly lit picture; else the middle of the two
  double after_s = 0.0;   // stamp of the last picture before the change that shows none
  double before_s = 0.0;  // ... of the first after it
};

struct BlinkEdges {
  std::vector<BlinkEdge> edges;
  std::vector<double> share;  // of each picture: 0 dark, 1 lit
  double share_sigma = 0.0;   // noise of a share
  double period_s = 0.0;      // the median step between stamps
};

// Edges that are beyond doubt: of a partly lit picture the ones beside it show no change, and no picture
// between is lost. Elsewhere up to `longest_gap_s` may lie between two pictures: less than the light needs to
// go on and off again. Nothing: the curve has no two levels, far apart for its noise. Throws:
// PreconditionError for stamps that don't ascend, or another number of them.
[[nodiscard]] std::optional<BlinkEdges> FindBlinkEdges(const BlinkCurve& curve, double longest_gap_s);

}  // namespace elbowroom::recon
