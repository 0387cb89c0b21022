// Whether views by themselves agree with their camera's lens.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "recon/calibration/adjustment.h"

namespace elbowroom::recon {

// Places, in the adjustment, of used views that contradict the lens: a board of which all points are shifted
// alike still has a pose that fits within the noise of a few pixels, but wants another principal point. Only
// views whose board no other view shows (`is_alone`, by view) are asked.
//
// At the minimum of the plain least squares a right view's pull on the lens, its gradient g, has the
// covariance C = M - M S M, with M its information and S the covariance of the lens. g' C^-1 g is asked, in
// the directions of which the view knows a thousandth of what is known, and measured by the camera's median
// where that is more than it should be. Of a camera's views only those go that pull half as much as the
// worst, as the others may pull against it. `covariance`: as CovarianceOf.
[[nodiscard]] std::vector<std::size_t> ContradictingViews(const Adjustment& adjustment,
                                                          const std::vector<bool>& is_alone,
                                                          const Eigen::MatrixXd& covariance,
                                                          double noise_scale);

}  // namespace elbowroom::recon
