// The paper's collision method (docs/paper_collision.md) beside the exact one, on the same contacts.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "recon/paper_methods/triangle_viewports.h"
#include "recon/synthetic/view_scene.h"
#include "tests/accuracy/interleaved_timing.h"

namespace elbowroom::accuracy {

// In the order of every list below.
enum class CollisionMethod {
  kViewportsGl,   // viewports in OpenGL, then two triangles
  kViewportsCpu,  // their twin on the CPU, then two triangles
  kExact,         // review::FindContacts as it is by default
  kExactAtTwoMm,  // the same at the paper's resolution of tabletop objects
};
inline constexpr CollisionMethod kCollisionMethods[] = {
    CollisionMethod::kViewportsGl, CollisionMethod::kViewportsCpu, CollisionMethod::kExact,
    CollisionMethod::kExactAtTwoMm};
[[nodiscard]] std::string NameOf(CollisionMethod method);

// What is pushed into the hand, of 720 triangles each (curtain_scene.h).
enum class CollisionPart { kCurtain, kTabletopPanel };
inline constexpr CollisionPart kCollisionParts[] = {CollisionPart::kCurtain, CollisionPart::kTabletopPanel};
[[nodiscard]] std::string NameOf(CollisionPart part);  // with its sampling

struct CollisionCost {
  Timing frame;     // masks in memory to response
  Timing contacts;  // hull or textures at hand to contacts; of the exact methods, to response
  Timing response;  // two triangles alone
  std::int64_t contact_points = 0;
  recon::ViewportWork work;       // of the viewports
  double coarsest_step_mm = 0.0;  // likewise
};

// The part 10 mm in the hull of the demo's hand, on one thread; OpenGL may take more of its own.
[[nodiscard]] std::vector<CollisionCost> TimeCollisions(recon::ViewSceneRig rig, CollisionPart part,
                                                        const TimingEffort& effort = {});

// Contacts of one size: of a disc of the same area, mm across.
struct SmallContacts {
  double from_mm = 0.0, to_mm = 0.0;
  int contacts = 0;
  std::vector<int> missed;  // one a method
};

// The part at random places about the demo's hand, each time pushed up to 1.5 mm into its hull. Which are
// contacts, and how large: review::FindContacts at a tenth of a millimetre.
[[nodiscard]] std::vector<SmallContacts> CountMissed(recon::ViewSceneRig rig, CollisionPart part, int trials,
                                                     std::uint64_t seed);

struct ErrorShare {
  double median = 0.0, p95 = 0.0;
};

// Responses to contacts that deep along V_rec.
struct ResponseErrors {
  double from_mm = 0.0, to_mm = 0.0;
  int responses = 0;
  struct OfMethod {
    ErrorShare cp_hull_to_masks_mm;     // along V_rec, to the hull of the masks by brute force
    ErrorShare cp_hull_to_analytic_mm;  // to the hull that perfect cameras would have seen
    ErrorShare n_hull_deg;              // to that hull's normal, where one camera alone bounds it
    int without_normal = 0;
  };
  OfMethod two_triangles, exact;
};

// Points in the hulls of balls of 40 mm and round bars of 20 mm radius, at random depths below their
// surfaces, each backed out along a random V_rec. The first is all depths together.
[[nodiscard]] std::vector<ResponseErrors> MeasureResponses(recon::ViewSceneRig rig, int solids, int rays,
                                                           std::uint64_t seed);

}  // namespace elbowroom::accuracy
