#include "recon/error_budget/motion_history.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

// The mean speed over more than this says nothing about the speed at its end.
constexpr double kLongestPeriodS = 0.25;

}  // namespace

std::shared_ptr<const SkewErrors> MotionHistory::Next(
    const VisualHull& hull, std::span<const std::optional<core::CameraStamp>> stamps, double time_s) {
  if (stamps.empty()) return nullptr;
  core::Require(stamps.size() == hull.silhouettes().size(), "one stamp a camera, or none");
  cameras_.resize(stamps.size());
  std::vector<std::optional<CameraLook>> looks(stamps.size());
  tbb::parallel_for(std::size_t{0}, stamps.size(), [&](std::size_t i) {
    if (!stamps[i]) return;
    Last& last = cameras_[i];
    Follow(hull.silhouettes()[i], stamps[i]->time_s, &last);
    looks[i] = last.look;
    looks[i]->skew_s = std::abs(stamps[i]->time_s - time_s);
  });
  return std::make_shared<const SkewErrors>(std::move(looks));
}

void MotionHistory::Follow(const std::shared_ptr<const Silhouette>& silhouette, double time_s, Last* last) {
  if (!last->silhouette) {
    *last = {silhouette, time_s, {}};
    return;
  }
  if (!(time_s > last->time_s)) return;  // the same picture again
  const double period_s = time_s - last->time_s;
  std::shared_ptr<const ContourMotion> motion;
  if (silhouette == last->silhouette) {
    motion = std::make_shared<const ContourMotion>();
  } else if (period_s <= kLongestPeriodS) {
    motion = std::make_shared<const ContourMotion>(last->silhouette->labels(), silhouette->labels());
  }
  *last = {silhouette,
           time_s,
           {.period_s = period_s,
            .motion = std::move(motion),
            .period_before_s = last->look.period_s,
            .motion_before = last->look.motion}};
}

}  // namespace elbowroom::recon
