#include "recon/contours/silhouette.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {

Silhouette::Silhouette(std::shared_ptr<const UndistortedPlane> plane, core::SoftMask soft_mask,
                       bool exterior_is_object)
    : plane_(std::move(plane)), soft_mask_(std::move(soft_mask)), exterior_is_object_(exterior_is_object) {
  const core::BitMask& mask = soft_mask_.mask;
  core::Require(
      mask.width_px() == plane_->camera().width_px() && mask.height_px() == plane_->camera().height_px(),
      "a silhouette has its camera's size");
  shows_object_ = mask.ShowsObject();
}

const ContourMap& Silhouette::labels() const {
  if (const ContourMap* ready = ready_.load(std::memory_order_acquire)) return *ready;
  std::call_once(once_, [this] {
    labels_ = std::make_shared<const ContourMap>(TraceContour(soft_mask_, exterior_is_object_, *plane_),
                                                 exterior_is_object_);
    ready_.store(labels_.get(), std::memory_order_release);
  });
  return *labels_;
}

void Silhouette::TakeLabels(std::shared_ptr<const ContourMap> labels) const {
  core::Require(labels != nullptr && labels->exterior_is_object() == exterior_is_object_,
                "a contour with the silhouette's exterior");
  std::call_once(once_, [&] {
    labels_ = std::move(labels);
    ready_.store(labels_.get(), std::memory_order_release);
  });
}

}  // namespace elbowroom::recon
