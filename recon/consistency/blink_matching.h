// Which edges of several cameras are the same change of the light.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "recon/consistency/blink_edges.h"

namespace elbowroom::recon {

// One change of the light, as all cameras that tell of it saw it.
struct SharedEdge {
  struct Seen {
    core::CameraIndex camera = 0;
    BlinkEdge edge;
  };
  std::vector<Seen> seen;  // two or more, each of another camera
};

// The offset of a curve against the first one at which their shares agree best, on a grid of a sixth of a
// period within `search_s`; 0 for the first. Nothing: nowhere do a hundred pictures overlap.
[[nodiscard]] std::optional<double> CoarseOffset(const BlinkCurve& first_curve, const BlinkEdges& first,
                                                 const BlinkCurve& curve, const BlinkEdges& edges,
                                                 double search_s);

// Edges of one kind within `shortest_blink_s`, with the coarse offsets: the next one of that kind is at least
// twice as far. A group in which a camera has two is left out.
[[nodiscard]] std::vector<SharedEdge> MatchEdges(std::span<const BlinkEdges> cameras,
                                                 std::span<const double> coarse_offset_s,
                                                 double shortest_blink_s);

}  // namespace elbowroom::recon
