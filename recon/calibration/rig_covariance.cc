#include "recon/calibration/rig_covariance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "recon/calibration/bundle.h"

namespace elbowroom::recon {
namespace {

[[noreturn]] void FailAtUndecided(const std::string& name) {
  throw core::Error(core::ErrorKind::kCamera,
                    fmt::format("camera '{}': the views don't decide all of its parameters; next, take views "
                                "with it of the board, tilted by 30 degrees, in all parts of its picture",
                                name));
}

// The camera of which the fewest points are used.
std::size_t LeastSeenCamera(const Adjustment& a) {
  std::vector<std::ptrdiff_t> points(a.cameras.size(), 0);
  for (const AdjustedView& view : a.views)
    if (view.is_used)
      points[static_cast<std::size_t>(view.camera)] +=
          std::ranges::count_if(view.points, &AdjustedPoint::is_used);
  return static_cast<std::size_t>(std::ranges::min_element(points) - points.begin());
}

// A focal length or a rotation that is known to half of itself, or to half a radian, isn't known.
bool IsDecided(const AdjustedCamera& camera, const ParameterBlock& block, const Eigen::MatrixXd& covariance) {
  constexpr double kMost = 0.5;
  const auto sigma = [&](int i) { return std::sqrt(covariance(i, i)); };
  if (!camera.is_lens_fixed && !(sigma(block.first) <= kMost * camera.lens.values[0])) return false;
  for (int i = 0; i < 3; ++i)
    if (!camera.is_pose_fixed && !(sigma(block.rotation() + i) <= kMost)) return false;
  return true;
}

}  // namespace

Eigen::MatrixXd CovarianceOf(const Adjustment& a, double noise_scale, const CalibrationInput& input) {
  BundleOptions options;
  options.noise_scale = noise_scale;
  const std::optional<Eigen::MatrixXd> inverse = InverseOfCameras(EquationsOf(a, options));
  if (!inverse) FailAtUndecided(input.cameras[LeastSeenCamera(a)].name);
  Eigen::MatrixXd covariance = noise_scale * noise_scale * *inverse;
  for (int i = 0; i < static_cast<int>(a.cameras.size()); ++i)
    if (!IsDecided(a.cameras[static_cast<std::size_t>(i)], a.BlockOf(i), covariance))
      FailAtUndecided(input.cameras[static_cast<std::size_t>(i)].name);
  for (const auto& [first, count] : a.kept_parameters()) {
    covariance.middleRows(first, count).setZero();
    covariance.middleCols(first, count).setZero();
  }
  return covariance;
}

}  // namespace elbowroom::recon
