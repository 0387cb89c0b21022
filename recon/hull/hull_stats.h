// What making the hull of a frame could skip.
#pragma once

namespace elbowroom::recon {

// The work that a frame's hull could do without.
struct HullStats {
  int unchanged_silhouettes = 0;  // taken over from the last frame, with all that was built for them
  int empty_silhouettes = 0;      // without object
  int untraced_silhouettes = 0;   // contour not needed: under `outside` an empty one empties the hull
};

}  // namespace elbowroom::recon
