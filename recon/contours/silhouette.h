// One camera's object region.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "core/soft_mask.h"
#include "recon/contours/contour_map.h"
#include "recon/contours/undistorted_plane.h"

namespace elbowroom::recon {

// A mask and its contour. All lengths and labels below follow one convention: pixel centres are at integers,
// with marching squares between them (TraceContour). The contour is traced at the first call of labels().
// Immutable. Thread: any.
class Silhouette {
 public:
  // Throws: PreconditionError when the mask's size isn't the camera's.
  Silhouette(std::shared_ptr<const UndistortedPlane> plane, core::SoftMask soft_mask,
             bool exterior_is_object);

  [[nodiscard]] const core::BitMask& mask() const { return soft_mask_.mask; }
  [[nodiscard]] const core::SoftMask& soft_mask() const { return soft_mask_; }
  [[nodiscard]] const UndistortedPlane& plane() const { return *plane_; }
  [[nodiscard]] bool exterior_is_object() const { return exterior_is_object_; }
  [[nodiscard]] bool shows_object() const { return shows_object_; }  // some pixel is
  [[nodiscard]] const ContourMap& labels() const;
  // What labels() would trace, from where it was kept. Changes nothing if it was traced already.
  void TakeLabels(std::shared_ptr<const ContourMap> labels) const;
  [[nodiscard]] bool is_traced() const { return ready_.load(std::memory_order_acquire) != nullptr; }

 private:
  std::shared_ptr<const UndistortedPlane> plane_;
  core::SoftMask soft_mask_;
  bool exterior_is_object_;
  bool shows_object_;
  mutable std::once_flag once_;
  mutable std::shared_ptr<const ContourMap> labels_;
  mutable std::atomic<const ContourMap*> ready_ = nullptr;  // labels_, once it is there
};

}  // namespace elbowroom::recon
