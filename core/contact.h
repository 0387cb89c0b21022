// The answers about one part and the hull: in one frame, and for a touch over time.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/clearance.h"
#include "core/ids.h"

namespace elbowroom::core {

enum class Verdict { kContact, kNear, kClear, kUndecided };

[[nodiscard]] std::string_view ToString(Verdict verdict);  // "contact", "near", "clear", "undecided"
[[nodiscard]] std::optional<Verdict> ParseVerdict(std::string_view text);

// A sample of the part's surface that lies in the hull.
struct ContactPoint {
  Eigen::Vector3d position_in_world_mm = Eigen::Vector3d::Zero();
  double depth_mm = 0.0;  // certified lower bound of its distance to the hull's surface
  double area_mm2 = 0.0;  // area of the surface piece that the point represents
};

// The paper's response: how to move the part out of the hull along the way that its constraint allows
// (core::RecoveryRule). A hinge's way is an arc, and its V_rec is the arc's tangent at CP_obj.
struct Recovery {
  Eigen::Vector3d cp_obj_in_world_mm = Eigen::Vector3d::Zero();   // contact point farthest from RP_obj
  Eigen::Vector3d cp_hull_in_world_mm = Eigen::Vector3d::Zero();  // where CP_obj's way leaves the hull
  Eigen::Vector3d v_rec_in_world = Eigen::Vector3d::Zero();  // unit, the direction in which CP_obj starts
  double d_rec_mm = 0.0;                           // length of CP_obj's way; for a hinge along the arc
  std::optional<Eigen::Vector3d> n_hull_in_world;  // unit, out of the hull; nothing on a workspace face
  std::optional<double> angle_rad = {};            // for a hinge: signed about its axis
};

// docs/recovery.md says which outputs each status has.
enum class RecoveryStatus {
  kFound,
  kNoContact,
  kReferenceInsideHull,  // the hull holds RP_obj: V_rec is followed to the hull's end, past RP_obj if needed
  kNoDirection,          // CP_obj and RP_obj coincide, or CP_obj is on the hinge's axis: no recovery
  kNoExit,               // only the end of what the cameras see ends the way: D_rec is a lower bound
  kHullInsidePart,       // no face of the part is in the hull, so there is no CP_obj: no recovery
  kOnSurface,            // CP_obj is on the hull's surface: D_rec is 0
};

[[nodiscard]] std::string_view ToString(RecoveryStatus status);
[[nodiscard]] std::optional<RecoveryStatus> ParseRecoveryStatus(std::string_view text);

// How much work one answer took, and how much was skipped.
struct QueryCount {
  std::int64_t triangles = 0;  // of the part
  std::int64_t queries = 0;    // ball queries asked
  std::int64_t skipped = 0;    // triangles settled without a query of their own
};

struct PartContact {
  PartIndex part = 0;
  Verdict verdict = Verdict::kClear;
  std::vector<ContactPoint> points;      // bounded in number, spread over the contact
  std::int64_t contact_point_count = 0;  // before the bound
  double contact_area_mm2 = 0.0;
  std::optional<ContactPoint> deepest;
  // Only for a contact without points: a point of the hull inside the part, none of whose faces is touched.
  std::optional<Eigen::Vector3d> contained_in_world_mm;
  RecoveryStatus recovery_status = RecoveryStatus::kNoContact;
  std::optional<Recovery> recovery;
  double resolution_mm = 0.0;  // pieces of surface of this size were decided by their centres
  QueryCount count;
  std::optional<PartClearance> clearance;  // nothing: no clearance is required
};

// One touch of one part: frames that follow each other with gaps no longer than the tracker's rule.
struct ContactEpisode {
  EpisodeId id = 0;
  FindingId finding_id;  // empty until it is recorded
  PartIndex part = 0;
  FrameIndex begin_frame = 0;
  FrameIndex peak_frame = 0;  // deepest; ties go to the larger area, then the earlier frame
  FrameIndex end_frame = 0;   // last frame in contact
  double begin_time_s = 0.0;
  double peak_time_s = 0.0;
  double end_time_s = 0.0;
  std::int64_t frames_in_contact = 0;
  double peak_depth_mm = 0.0;
  double peak_area_mm2 = 0.0;  // of the peak frame
  Eigen::Vector3d peak_position_in_world_mm = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> peak_position_in_part_mm;  // nothing in sessions from before it was recorded
  std::vector<double> spacing_at_peak_mm;                   // in the layout's order
  std::vector<std::string> tools;  // marked in use in a frame in contact, in order of name
};

// A part came nearer to the hull than its required clearance, and moved away again without a touch.
struct NearMiss {
  EpisodeId id = 0;
  FindingId finding_id;  // empty until it is recorded
  PartIndex part = 0;
  FrameIndex begin_frame = 0;
  FrameIndex closest_frame = 0;  // least upper bound; ties go to the lower one, then the earlier frame
  FrameIndex end_frame = 0;      // last frame that wasn't clear
  double begin_time_s = 0.0;
  double closest_time_s = 0.0;
  double end_time_s = 0.0;
  std::int64_t frames_below = 0;                    // those that weren't clear
  Verdict verdict = Verdict::kUndecided;            // kNear: some frame was surely below
  PartClearance closest;                            // that of the closest frame
  std::optional<Eigen::Vector3d> place_in_part_mm;  // its witness on the part; nothing: not known
  std::vector<double> spacing_at_closest_mm;        // in the layout's order
  std::vector<std::string> tools;                   // marked in use meanwhile, in order of name
};

}  // namespace elbowroom::core
