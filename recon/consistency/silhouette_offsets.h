// Time offsets of cameras that run freely, from the silhouettes of moving hands alone.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "recon/consistency/epipolar_pairs.h"
#include "recon/consistency/tangents.h"

namespace elbowroom::recon {

// The tangents of one picture of one camera.
struct StampedTangents {
  double stamp_s = 0.0;
  CameraTangents tangents;
};

struct SilhouetteOffsetOptions {
  double search_s = 0.1;         // offsets of two cameras differ by less; > 0
  double search_step_s = 0.005;  // of the coarse search; > 0
  double steady_sigma_px = 0.5;  // of what each pair and side is off steadily: calibration, dilation; > 0
  double calibration_sigma_px = 0.3;  // by which a camera's turn, or its shift, may be off; > 0
  double block_s = 1.0;               // residuals farther apart are independent; > 0
  int least_blocks = 7;               // of the footage; >= 5
  double least_motion_px_s = 5.0;     // root mean square of the tangents' rates: noise alone has about 1; > 0

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

struct SilhouetteOffsets {
  // A picture of camera i with the stamp t shows the scene at t + offset_s[i], on the clock of camera 0,
  // whose offset is 0.
  std::vector<double> offset_s;
  std::vector<double> sigma_s;    // standard uncertainty, serial correlation included; 0 for camera 0
  Eigen::MatrixXd covariance_s2;  // of cameras 1, 2, ...
  std::size_t residuals = 0;      // compared
  double rms_px = 0.0;            // of them, when all is fitted, outliers weighted down
};

// The tangent angles of camera a at its stamps are held against those of camera b between its samples, for
// all pairs and sides at once: a robust (Cauchy) least squares fit of the offsets and of a steady residual
// for each pair and side. The uncertainty is by the jackknife over blocks of time (docs/consistency.md;
// silhouette_offsets_test counts how often it holds). `footage`: for each camera, in the order of stamps;
// used are tangents of whole silhouettes, and those whose sight the other camera sees. Nothing: too little
// footage, or hands too still to tell: little motion, or an offset with a sigma above search_s / 4. Throws:
// PreconditionError when there isn't one footage a camera, or stamps don't ascend.
[[nodiscard]] std::optional<SilhouetteOffsets> FindSilhouetteOffsets(
    const EpipolarPairs& pairs, std::span<const std::vector<StampedTangents>> footage,
    const SilhouetteOffsetOptions& options = {});

}  // namespace elbowroom::recon
