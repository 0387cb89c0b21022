// Where a part's surface is in the hull: ball queries down the part's tree, then of its triangles.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/ids.h"
#include "core/recovery_rule.h"
#include "core/rig.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/inside_cells.h"
#include "review/review_scratch.h"

namespace elbowroom::review {

struct ContactOptions {
  // Pieces of surface no larger than this are decided by their centres. 0: half of the smallest pixel
  // footprint of the rig at the part's centre.
  double resolution_mm = 0.0;
  // Pieces wholly inside are cut down to this size, so that a large face yields many points.
  double point_spacing_mm = 10.0;
  int max_points = 64;          // how many contact points are kept, spread evenly
  core::RecoveryRule recovery;  // RP_obj, and along which way the part may leave the hull

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
};

// A hull that stands inside a closed part and touches no face of it is searched for in cells of this many
// resolutions. A ball of hull with that radius is always found.
inline constexpr double kContainmentCell = 4.0;

// Contact of one part with the hull: verdict `contact` or `clear`, points, area, the deepest of all points,
// and the recovery (recovery.h) of CP_obj. CP_obj is, to the resolution, the point of the part in the hull
// that is farthest from RP_obj. Surface that the ball query calls outside or inside is certain; within one
// piece of `resolution` of the hull's boundary the piece's centre decides, so a smaller contact can be missed
// and the area is good to (boundary length x resolution). A hull that touches no face but stands inside a
// closed part is a contact without points (for its size see kContainmentCell). Held to a brute-force oracle
// by tests/review/contacts_test.cc. `inside`: the part's cells, kept from frame to frame; they save work and
// don't change the result. `scratch`: the part's memory, kept likewise. Thread: any.
[[nodiscard]] core::PartContact FindContacts(const recon::VisualHull& hull, const core::TriangleTree& part,
                                             const core::RigidTransform& world_from_part,
                                             core::PartIndex part_index, const ContactOptions& options = {},
                                             InsideCells* inside = nullptr, ReviewScratch* scratch = nullptr);

// FindContacts' verdict, found with the first contact point.
struct PartTouch {
  bool touches = false;
  // A point of the part's surface in the hull. Nothing if the hull stands inside the part and touches no
  // face.
  std::optional<Eigen::Vector3d> surface_in_world_mm;
  std::int64_t queries = 0;
};
[[nodiscard]] PartTouch FindTouch(const recon::VisualHull& hull, const core::TriangleTree& part,
                                  const core::RigidTransform& world_from_part, const ContactOptions& options,
                                  InsideCells* inside = nullptr);

// The depth of FindContacts' deepest point, if it is more than `least_mm` (>= 0). Surface that is certainly
// not so deep isn't searched. Adds its queries of the hull to `*queries`. Thread: any.
[[nodiscard]] std::optional<double> FindDeeper(const recon::VisualHull& hull, const core::TriangleTree& part,
                                               const core::RigidTransform& world_from_part,
                                               const ContactOptions& options, double least_mm,
                                               std::int64_t* queries);

// The size of the pieces of a part's surface that are decided by their centres. The part has triangles.
[[nodiscard]] double ContactResolutionMm(const recon::VisualHull& hull, const core::TriangleTree& part,
                                         const core::RigidTransform& world_from_part,
                                         const ContactOptions& options);

// Smallest width of a pixel at a point, over the cameras that have the point in front of them. Nothing: none
// has.
[[nodiscard]] std::optional<double> PixelFootprintMm(const core::Rig& rig, const Eigen::Vector3d& x_in_world);

}  // namespace elbowroom::review
