// For how long and how deep each patch of a part was touched, over all frames.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/heat_map.h"
#include "core/rigid_transform.h"
#include "core/surface_patches.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::review {

struct TouchedPatch {
  std::size_t patch = 0;
  double depth_mm = 0.0;  // certified lower bound
};

// The patches whose middle is in the hull, and those of the contact's points, each once, in order of number.
// known_mm: a depth for each patch, or nothing. Where the depth found here can't exceed it, it isn't worked
// out, and is 0. Thread: any.
[[nodiscard]] std::vector<TouchedPatch> FindTouchedPatches(const recon::VisualHull& hull,
                                                           const core::TriangleTree& part,
                                                           const core::RigidTransform& world_from_part,
                                                           const core::SurfacePatches& patches,
                                                           const core::PartContact& contact,
                                                           std::span<const double> known_mm = {});

// Heat maps from all frames, added in order of time, by the rules of docs/contact_tracking.md. A patch that
// is touched in a frame dwells until the next one; the last frame lasts as long as the mean one. Thread: one.
class ContactHeat {
 public:
  // One tree a part, which must outlive this.
  explicit ContactHeat(std::span<const core::TriangleTree> parts);

  // If neither a part nor the hull has changed since the frame before, that frame's patches are used again.
  void Add(double time_s, const std::shared_ptr<const recon::VisualHull>& hull,
           std::span<const core::RigidTransform> world_from_parts,
           std::span<const core::PartContact> contacts);

  // The maps of the parts that were touched, in the layout's order.
  [[nodiscard]] std::vector<core::HeatMap> Maps() const;

  // Grows whenever a part's map may have changed; 0: it was never touched.
  [[nodiscard]] std::int64_t changes(core::PartIndex part) const { return parts_[part].changes; }
  // Of a part that was touched, as Maps() has it. Throws: PreconditionError: it wasn't.
  [[nodiscard]] core::HeatMap MapOf(core::PartIndex part) const;

 private:
  struct PartHeat {
    std::shared_ptr<const core::SurfacePatches> patches;  // null: never touched
    std::vector<double> dwell_s;
    std::vector<double> peak_depth_mm;
    std::vector<TouchedPatch> touched;  // in the last frame
    core::RigidTransform world_from_part;
    std::int64_t changes = 0;
  };
  [[nodiscard]] double LastFrameS() const;
  [[nodiscard]] static core::HeatMap MapOf(const PartHeat& heat, core::PartIndex part, double last_frame_s);

  std::span<const core::TriangleTree> trees_;
  std::vector<PartHeat> parts_;
  std::shared_ptr<const recon::VisualHull> hull_;
  std::int64_t frames_ = 0;
  double first_time_s_ = 0.0;
  double last_time_s_ = 0.0;
};

}  // namespace elbowroom::review
