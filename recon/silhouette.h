// One camera's picture of what is object.
#pragma once

#include <memory>

#include "core/soft_mask.h"
#include "recon/contour_map.h"
#include "recon/picture_plane.h"

namespace elbowroom::recon {

// A mask and its contour. Convention, of every length and label below: pixel centres at integers, marching
// squares between them (TraceContour). Immutable. Thread: any.
class Silhouette {
 public:
  // Throws: PreconditionError when the mask's size isn't the camera's.
  Silhouette(std::shared_ptr<const PicturePlane> plane, core::SoftMask soft_mask, bool exterior_is_object);

  [[nodiscard]] const core::BitMask& mask() const { return soft_mask_.mask; }
  [[nodiscard]] const core::SoftMask& soft_mask() const { return soft_mask_; }
  [[nodiscard]] const PicturePlane& plane() const { return *plane_; }
  [[nodiscard]] const ContourMap& labels() const { return labels_; }

 private:
  std::shared_ptr<const PicturePlane> plane_;
  core::SoftMask soft_mask_;
  ContourMap labels_;
};

}  // namespace elbowroom::recon
