// The hull of the next frame, with contours that were kept somewhere.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

// Gets all silhouettes of a frame before the contours of new ones are traced, and may give them theirs
// (Silhouette::TakeLabels).
using ContourGiver = std::function<void(std::span<const std::shared_ptr<const Silhouette>>)>;

// NextHull of visual_hull.h; `give` is called if some silhouette is new.
[[nodiscard]] FrameHull NextHull(const std::shared_ptr<const VisualHull>& last,
                                 const std::shared_ptr<const core::Rig>& rig, const UndistortedPlanes& planes,
                                 std::span<const core::SoftMask> masks, const ContourGiver& give);

}  // namespace elbowroom::recon
