// Memory that a search along a ray or an arc leaves for the next one.
#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "recon/hull/ray_crossings.h"

namespace elbowroom::recon {

// A change of one camera's label along a ray.
struct RayCrossing {
  double t_mm = 0.0;
  core::CameraIndex camera = 0;
  std::uint32_t edge = 0;
  bool is_entry = false;
  bool is_outline = false;
};

// Where an arc meets what may bound the hull.
struct ArcMeeting {
  double angle_rad = 0.0;
  HullBoundary boundary;
};

// It holds no answer, only memory. Thread: one at a time.
struct CrossingScratch {
  std::vector<RayCrossing> crossings;
  std::vector<std::uint8_t> sides;     // a contour's vertices: on which side of the ray
  std::vector<std::uint8_t> objects;   // a camera: whether it labels the ray's present place object
  std::vector<std::uint8_t> outlines;  // a camera: whether it sees that place
  std::vector<HullInterval> intervals;
  std::vector<ArcMeeting> meetings;
};

}  // namespace elbowroom::recon
