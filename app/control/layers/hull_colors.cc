#include "app/control/layers/hull_colors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/control/layers/color_scale.h"
#include "app/control/palette/scale_color.h"
#include "recon/calibration/lens_projection.h"
#include "recon/error_budget/hull_errors.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {
namespace {

using recon::CameraColor;
using recon::HullAppearance;

constexpr float kUnknownGrey = 0.62F;
// Of a colour's light, how much depends on which way the surface faces: enough to show its shape, and little
// enough to leave the colour readable.
constexpr float kShading = 0.25F;

// Of all cameras' parameters, as core::RigErrors orders them.
Eigen::Index ParametersOf(const core::Rig& rig) {
  Eigen::Index count = 0;
  for (const core::CameraModel& camera : rig.cameras)
    count += recon::ParameterBlock{0, recon::LensParametersOf(camera.calibration()).count()}.size();
  return count;
}

// How far along the scale a value is, from pale to dark.
struct Scale {
  double most = 1.0;
  bool more_is_better = false;

  [[nodiscard]] double ShareOf(double value) const {
    const double share = std::clamp(value / most, 0.0, 1.0);
    return more_is_better ? 1.0 - share : share;
  }
};

std::vector<CameraColor> Colored(const recon::SurfaceValues& values, const Scale& scale,
                                 const recon::HullView& picture, const recon::ViewRays& rays) {
  std::vector<CameraColor> colors(values.size());
  const Eigen::Matrix3d view_from_world = rays.view_from_world().rotation;
  tbb::parallel_for(picture.hits.y, picture.hits.bottom, [&](int y) {
    for (int x = picture.hits.x; x < picture.hits.right; ++x) {
      const auto at = static_cast<std::size_t>(y * picture.width_px + x);
      if (!(picture.depth_mm[at] > 0.0F)) continue;
      const Color color = values[at] ? ScaleColor(scale.ShareOf(static_cast<double>(*values[at])))
                                     : Color(Color::Constant(kUnknownGrey));
      const Eigen::Vector3d ray = recon::PlaceInView(rays, x, y, 1.0).normalized();
      const auto facing =
          static_cast<float>(std::abs(ray.dot(view_from_world * picture.normal_in_world[at].cast<double>())));
      const float light = 255.0F * (1.0F - kShading + kShading * std::min(facing, 1.0F));
      for (std::size_t i = 0; i < 3; ++i)
        colors[at][i] = static_cast<std::uint8_t>(std::lround(light * color[static_cast<Eigen::Index>(i)]));
      colors[at][3] = 255;
    }
  });
  return colors;
}

}  // namespace

SharedRigKnowledge KnowledgeOf(const core::Rig& rig, const core::RigQuality& quality) {
  auto knowledge = std::make_shared<RigKnowledge>();
  knowledge->rig = rig;
  knowledge->is_refuted = quality.is_refuted();
  knowledge->has_covariance = quality.errors.has_value();
  if (quality.errors) {
    knowledge->errors = *quality.errors;
  } else {
    const Eigen::Index parameters = ParametersOf(rig);
    knowledge->errors.covariance = Eigen::MatrixXd::Zero(parameters, parameters);
  }
  const recon::HullErrors errors(rig, knowledge->errors);
  double middle_mm = errors.WorstAt(rig.workspace_mm.center()).ExpandedMm();
  if (!(middle_mm > 0.0)) middle_mm = errors.WorstIn(rig.workspace_mm).ExpandedMm();
  if (middle_mm > 0.0) knowledge->most_mm = RoundedUp(2.0 * middle_mm);
  return knowledge;
}

bool ShowsKnowledge(HullAppearance appearance) {
  switch (appearance) {
    case HullAppearance::kFlat:
    case HullAppearance::kByNormal:
    case HullAppearance::kOneCamera:
    case HullAppearance::kRigCameras:
      return false;
    case HullAppearance::kCoverage:
    case HullAppearance::kUncertainty:
      return true;
  }
  return false;
}

std::vector<CameraColor> HullColors::Of(HullAppearance appearance, const SharedRigKnowledge& knowledge,
                                        const std::shared_ptr<const recon::VisualHull>& whole,
                                        const recon::VisualHull& shown, const recon::HullView& picture,
                                        const recon::ViewRays& rays) {
  if (!ShowsKnowledge(appearance) || knowledge == nullptr ||
      knowledge->rig.cameras.size() != whole->rig().cameras.size())
    return {};
  if (knowledge_ != knowledge) {
    knowledge_ = knowledge;
    coverage_.reset();
    uncertainty_.reset();
  }
  if (appearance == HullAppearance::kUncertainty) {
    if (!uncertainty_) uncertainty_.emplace(knowledge->rig, knowledge->errors);
    return Colored(uncertainty_->Of(shown, picture, rays), {knowledge->most_mm, false}, picture, rays);
  }
  const bool is_new = !coverage_;
  if (is_new) coverage_.emplace(knowledge->rig);
  if (is_new || looked_at_.lock() != whole) {
    coverage_->LookAt(*whole);
    looked_at_ = whole;
    ++looks_;
  }
  const auto cameras = static_cast<double>(knowledge->rig.cameras.size());
  return Colored(coverage_->Of(shown, picture, rays), {cameras, true}, picture, rays);
}

}  // namespace elbowroom::control
