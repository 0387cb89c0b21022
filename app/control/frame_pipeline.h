// Camera frames in, contacts out: one frame's way through recon and review.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "app/control/silhouette_pipeline.h"
#include "recon/footage/frame_set.h"
#include "recon/segmentation/frame_segmenter.h"

namespace elbowroom::control {

// Segments the pictures; a SilhouettePipeline does the rest. Thread: one frame at a time.
class FramePipeline {
 public:
  // Throws: what SilhouettePipeline throws.
  FramePipeline(core::Rig rig, core::Layout layout,
                const std::vector<recon::BackgroundReference>& backgrounds,
                const recon::SegmentationOptions& segmentation, const review::PartReviewOptions& review = {});

  [[nodiscard]] const std::shared_ptr<const core::Rig>& rig() const { return silhouettes_.rig(); }
  [[nodiscard]] const std::shared_ptr<const core::Layout>& layout() const { return silhouettes_.layout(); }
  [[nodiscard]] std::span<const core::TriangleTree> part_trees() const { return silhouettes_.part_trees(); }

  // As SilhouettePipeline::Process. The result shares the frames' pictures.
  [[nodiscard]] std::shared_ptr<FrameResult> Process(recon::FrameSet frames,
                                                     std::span<const double> spacing_mm,
                                                     const WithHull& beside = {});

 private:
  SilhouettePipeline silhouettes_;
  recon::FrameSegmenter segmenter_;
};

}  // namespace elbowroom::control
