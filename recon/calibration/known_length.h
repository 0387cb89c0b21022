// A length that is known from elsewhere tells whether the rig's scale is right.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recon/calibration/calibration_result.h"

namespace elbowroom::recon {

// Reprojection doesn't see the scale: a board whose squares are 2 % larger than stated fits as well, in a
// world that is 2 % too small.
struct KnownLength {
  struct Sight {
    int camera = 0;
    Eigen::Vector2d pixel;
    double sigma_px = 0.5;  // of each coordinate
  };
  std::string name;  // for messages: "between cam1 and cam2", "table edge"
  double length_mm = 0.0;
  double tolerance_mm = 0.0;  // of the statement itself
  // Between two cameras' centres; or between two points, each seen in two pictures or more.
  std::optional<std::pair<int, int>> cameras;
  std::vector<Sight> first;
  std::vector<Sight> second;
};

enum class LengthVerdict { kAgrees, kMismatch, kCannotTell };

struct LengthCheck {
  double measured_mm = 0.0;
  double sigma_mm = 0.0;  // from the rig's covariance and the sights' noise
  LengthVerdict verdict = LengthVerdict::kCannotTell;
  std::string message;  // one plain line
};

// kMismatch: measured and stated length differ by more than the tolerance and three sigma. kCannotTell: they
// don't, but a wrong scale of 2 % wouldn't show either. The scale is checked if all lengths agree.
// Throws: Error{kCamera} naming the length: a point seen in fewer than two pictures, or that can't be
// triangulated; PreconditionError: a camera that isn't there, or a length that isn't positive.
[[nodiscard]] LengthCheck CheckLength(const CalibrationResult& result, const KnownLength& known);

}  // namespace elbowroom::recon
