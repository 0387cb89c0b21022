// What is wrong with the answers about a hard case: slow checks that are obviously right.
#pragma once

#include <cstdint>

#include "core/camera_model.h"
#include "core/contact.h"
#include "recon/hull/visual_hull.h"
#include "review/clearance.h"
#include "review/contact_heat.h"
#include "tests/accuracy/hard/hard_cases.h"

namespace elbowroom::accuracy {

inline constexpr double kTightMm = 1e-2;  // tolerance of the clearance that others are held to

// The middles of all patches, each asked of the hull on its own.
struct ContactErrors {
  bool is_missed = false;  // a middle is deeper than the contacts' resolution, but there is no contact
  std::int64_t points_outside = 0;   // contact points that aren't in the hull
  std::int64_t missing_patches = 0;  // of the heat map: their middles are in the hull
  std::int64_t extra_patches =
      0;  // of the heat map: neither their middles nor contact points are in the hull

  ContactErrors& operator+=(const ContactErrors& other);
  [[nodiscard]] std::int64_t sum() const {
    return (is_missed ? 1 : 0) + points_outside + missing_patches + extra_patches;
  }
};
[[nodiscard]] ContactErrors ErrorsOf(const core::PartContact& contact,
                                     const std::vector<review::TouchedPatch>& touched,
                                     const recon::VisualHull& hull, const HardCase& hard_case);

struct ClearanceErrors {
  bool bounds_hold = true;  // the clearance to kTightMm is between them
  double upper_mm = 0.0;    // the upper bound's distance to it
};
[[nodiscard]] ClearanceErrors ErrorsOf(const core::ClearanceInterval& interval, const recon::VisualHull& hull,
                                       const core::TriangleTree& tree,
                                       const core::RigidTransform& world_from_part);

// Of rays of the view, one in `every` a row and a column, against IntervalsInHull.
struct ViewErrors {
  std::int64_t rays = 0;
  std::int64_t hits = 0;
  std::int64_t wrong = 0;    // hit where there is no hull, or the reverse
  double depth_share = 0.0;  // the largest error of a depth, as a share of the depth
};
[[nodiscard]] ViewErrors ErrorsOfView(const recon::VisualHull& hull, const core::CameraModel& view,
                                      int every);

}  // namespace elbowroom::accuracy
