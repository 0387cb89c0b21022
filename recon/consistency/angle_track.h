// The angle of one tangent over time, between the samples too.
#pragma once

#include <optional>
#include <vector>

#include "recon/consistency/tangents.h"

namespace elbowroom::recon {

struct AngleSample {
  double stamp_s = 0.0;
  Tangent tangent;
};

struct AngleAtTime {
  double angle_rad = 0.0;
  double rate_rad_s = 0.0;
  const Tangent* nearest = nullptr;  // of the samples; valid as long as the track lives
};

// Samples of one camera, pair and side. Immutable once filled.
class AngleTrack {
 public:
  AngleTrack() = default;
  // The samples' stamps ascend.
  explicit AngleTrack(std::vector<AngleSample> samples);

  [[nodiscard]] const std::vector<AngleSample>& samples() const { return samples_; }
  // The median of the steps from sample to sample.
  [[nodiscard]] double period_s() const { return period_s_; }

  // By a parabola through the samples within 3.5 periods, weighted by how near they are (tricube, as LOWESS).
  // It is as wide on either side, so it shifts nothing in time, and its noise hardly depends on where between
  // two samples the time is. Nothing: fewer than six samples there, or than two on one side.
  [[nodiscard]] std::optional<AngleAtTime> At(double stamp_s) const;

 private:
  std::vector<AngleSample> samples_;
  double period_s_ = 0.0;
};

}  // namespace elbowroom::recon
