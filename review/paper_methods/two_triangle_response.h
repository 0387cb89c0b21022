// The paper's response to a collision: where to back the part out to, and the hull's normal there, by two
// triangles.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/contact.h"
#include "core/units.h"
#include "recon/paper_methods/coverage_hull.h"

namespace elbowroom::review {

struct TwoTriangleOptions {
  double apex_rad = core::RadiansFromDegrees(10.0);  // angle BAC, in (0, pi/2); the paper's
  double height_mm = 50.0;                           // from A to BC, > 0; the paper's
  int window_px = 400;  // square, 2 to 4096; the paper's: CP_hull to height / window = 0.125 mm
  // V_rec of a part with constrained motion, unit. Nothing: the direction from CP_obj to RP_obj.
  std::optional<Eigen::Vector3d> v_rec_in_world = std::nullopt;

  // Throws: PreconditionError naming the field out of range.
  void Validate() const;
};

enum class TwoTriangleStatus {
  kFound,
  kNoContact,
  kNoDirection,          // CP_obj and RP_obj coincide
  kReferenceInsideHull,  // the search from RP_obj begins inside the hull: the paper doesn't define it
  kDeeperThanTriangle,   // the hull reaches past the triangle's base: the paper's answer would be the base
};

[[nodiscard]] std::string_view ToString(TwoTriangleStatus status);

struct TwoTriangleResponse {
  TwoTriangleStatus status = TwoTriangleStatus::kNoContact;
  // Only with kFound. It has no normal if a side of a triangle ends inside the hull, or IJ and KL don't span
  // a plane.
  std::optional<core::Recovery> recovery;
  double step_mm = 0.0;        // between samples along V_rec: CP_hull may be off by up to this
  std::int64_t triangles = 0;  // the paper's work: 2 for a response
  std::int64_t pixels = 0;     // the paper's work: n u v, for n cameras and a window of u x v
};

// The paper's "Recovery from Interpenetration"; the status says where it fails. CP_obj is the contact point
// farthest from RP_obj. The isosceles triangle ABC has A = CP_obj, its base BC across V_rec. A scan line of
// the window runs along V_rec: its first sample in the hull, coming from RP_obj (or, beyond it, from the
// base), is CP_hull. The sides BA and CA, walked from B and C in as many steps, meet the hull at I and J;
// those of DAE, the same triangle turned by 90 degrees about V_rec, at K and L. N_hull is IJ x KL, taken to
// the side that V_rec points to. The paper leaves open how ABC is turned about V_rec: here BC is
// perpendicular to the world's axis along which V_rec is least. Labels are CoverageHull::Contains. Its errors
// against the exact recovery of contacts.h: docs/paper_collision.md, two_triangle_response_test. Throws:
// PreconditionError for options out of range. Thread: any.
[[nodiscard]] TwoTriangleResponse RespondByTwoTriangles(const recon::CoverageHull& hull,
                                                        std::span<const Eigen::Vector3d> contacts_in_world,
                                                        const Eigen::Vector3d& rp_obj_in_world,
                                                        const TwoTriangleOptions& options = {});

}  // namespace elbowroom::review
