#include "recon/silhouette.h"

#include <utility>

namespace elbowroom::recon {

Silhouette::Silhouette(std::shared_ptr<const PicturePlane> plane, core::SoftMask soft_mask,
                       bool exterior_is_object)
    : plane_(std::move(plane)),
      soft_mask_(std::move(soft_mask)),
      labels_(TraceContour(soft_mask_, exterior_is_object, *plane_), exterior_is_object) {}

}  // namespace elbowroom::recon
