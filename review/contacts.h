// Where a virtual part is inside the real: its tree, then its triangles, through the ball query.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/ids.h"
#include "core/recovery_rule.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"
#include "review/inside_cells.h"

namespace elbowroom::review {

struct ContactOptions {
  // Pieces of surface no larger than this are decided by their centre. 0: half of the smallest pixel
  // footprint of the rig at the part's centre.
  double resolution_mm = 0.0;
  // Pieces wholly inside are cut down to this size, so that a large face yields many points.
  double point_spacing_mm = 10.0;
  int max_points = 64;          // kept of them, spread evenly
  core::RecoveryRule recovery;  // RP_obj, and which way the part may give way

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
};

// Hull that stands inside a closed part and touches no face of it is looked for in cells of this many
// resolutions: a ball of that radius is always found.
inline constexpr double kContainmentCell = 4.0;

// Contact of one part with the hull: verdict `contact` or `clear`, points, area, the deepest of all points,
// and the recovery (recovery.h) of CP_obj, of the part's points in the hull the farthest from RP_obj, to the
// resolution.
//
// Surface that the ball query calls outside or inside is certified; surface within one piece of `resolution`
// of the hull's boundary is decided by the piece's centre, so a contact smaller than that can be missed and
// the area is good to (boundary length x resolution). A hull that touches no face but stands inside a closed
// part is a contact without points (kContainmentCell says how small it may be). Held to a brute-force oracle
// by tests/review/contacts_test.cc. `inside`: the part's, from frame to frame; it saves work and changes
// nothing. Thread: any.
[[nodiscard]] core::PartContact FindContacts(const recon::VisualHull& hull, const core::TriangleTree& part,
                                             const core::RigidTransform& world_from_part,
                                             core::PartIndex part_index, const ContactOptions& options = {},
                                             InsideCells* inside = nullptr);

// Smallest width of a pixel at a point, over the cameras that look towards it; nothing if none does.
[[nodiscard]] std::optional<double> PixelFootprintMm(const core::Rig& rig, const Eigen::Vector3d& x_in_world);

}  // namespace elbowroom::review
