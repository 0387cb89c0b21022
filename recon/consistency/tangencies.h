// How well the silhouettes of one instant agree: epipolar planes that touch one must touch the other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/soft_mask.h"
#include "recon/consistency/tangents.h"

namespace elbowroom::recon {

// An outermost epipolar plane as both cameras of a pair see it. Where it touches is a frontier point: both
// cameras see the surface edge-on there.
struct Tangency {
  std::size_t pair = 0;  // place in EpipolarPairs::pairs()
  TangentSide side = TangentSide::kLowest;
  Tangent in_a, in_b;
  // The angle in a less that in b, as the least shift of both pictures together that makes them agree:
  // difference / sqrt(1 / px_per_rad_a^2 + 1 / px_per_rad_b^2).
  double residual_px = 0.0;
  double sigma_px = 0.0;  // standard uncertainty of the residual, from the noise of both boundaries
};

struct FrameTangencies {
  std::vector<Tangency> found;  // by pair, then side: two for each pair at most
  // How many comparisons were skipped, by TangencySkip. Of both cameras' reasons the first camera's counts.
  std::array<std::size_t, kTangencySkips> skipped{};

  [[nodiscard]] std::size_t SkippedAll() const;
};

// Compares the tangents of one instant. If both silhouettes are whole, the tangents are of the same object.
// Else they are used only if each camera sees all of the other's sight within the workspace, the two sights
// meet in the workspace, and no other camera refutes the point where they meet by background all around it
// (docs/consistency.md says what these rules can't exclude). What the other pairs of both cameras contradict
// is left out, too. Throws: PreconditionError when there aren't tangents and a silhouette for each camera.
[[nodiscard]] FrameTangencies CompareTangents(const EpipolarPairs& pairs,
                                              std::span<const CameraTangents> tangents,
                                              std::span<const core::SoftMask> masks);

// Traces all silhouettes, finds their tangents and compares them.
[[nodiscard]] FrameTangencies FindTangencies(const EpipolarPairs& pairs,
                                             std::span<const core::SoftMask> masks,
                                             const TangentOptions& options = {});

}  // namespace elbowroom::recon
