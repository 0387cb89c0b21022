// The search for the pieces of a part's surface that are in the hull.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/review_scratch.h"

namespace elbowroom::review {

struct ContactSearchRule {
  double resolution_mm = 1.0;      // pieces no larger are decided by their centres
  double point_spacing_mm = 10.0;  // stretches of surface no larger become one contact point each
  Eigen::Vector3d rp_obj = Eigen::Vector3d::Zero();  // in world
  // Only contact points that are deeper than this are wanted: stretches of surface that hold none are left
  // out, and the points that are found have their depths.
  std::optional<double> deeper_than_mm = {};
  bool ends_with_first = false;  // one contact point is enough
};

struct FoundContacts {
  std::vector<core::ContactPoint> points;
  // The point of the part in the hull that is farthest from RP_obj. A piece wholly inside offers its
  // vertices, one of which is its farthest point. A piece that its centre decides offers its centre.
  Eigen::Vector3d farthest = Eigen::Vector3d::Zero();
  core::QueryCount count;
};

// The part must have triangles, the hull mustn't be empty. The points are the same, in the same order, on any
// number of threads, and in the memory of `scratch->points`; who is done with them may give it back.
// `stretches`: those of this part and point spacing, or null; a rule that wants all points finds the same
// ones in less time. Only the point of a stretch that is wholly inside, and has several triangles or is
// larger than 8 resolutions, may stand elsewhere on it. Rules and limits: FindContacts (contacts.h). Thread:
// any.
[[nodiscard]] FoundContacts SearchContacts(const recon::VisualHull& hull, const core::TriangleTree& part,
                                           const core::RigidTransform& world_from_part,
                                           const ContactSearchRule& rule, ContactSearchScratch* scratch,
                                           const ContactStretches* stretches = nullptr);

}  // namespace elbowroom::review
