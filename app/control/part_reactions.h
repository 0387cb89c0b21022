// The parts of a layout that give way, and its streams, from frame to frame.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/layout.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/cloth.h"
#include "review/particle_stream.h"
#include "review/pushed_part.h"
#include "review/surface_model.h"

namespace elbowroom::control {

// A value; parts and streams in the layout's order.
struct ReactionState {
  std::vector<std::optional<review::ClothState>> cloths;  // nothing: the part is no cloth
  std::vector<review::PushState> pushes;                  // at rest for parts that aren't pushed
  std::vector<review::StreamState> streams;
  std::vector<core::SharedMesh> meshes_in_world;  // of the cloths as they hang; null for other parts
};

using SharedReactions = std::shared_ptr<const ReactionState>;

// How far parts were pushed from where they rest, one a part; empty if none was.
[[nodiscard]] std::vector<core::RigidTransform> MotionsOf(const ReactionState& state);

// Immutable. Thread: any.
class PartReactions {
 public:
  // Throws: what review::ClothPanel throws. The layout must outlive it.
  explicit PartReactions(const core::Layout& layout);

  // No part gives way and nothing flows.
  [[nodiscard]] bool is_empty() const { return is_empty_; }

  // The state `dt_s` after `last`; null: after rest. Cloths move in parallel, then pushed parts one after the
  // other, each against the others where they are by then, then the streams. Cloth stops neither parts nor
  // streams. The result is the same for any number of threads. world_from_rests: before any pushing;
  // contacts: of the parts where `last` has pushed them.
  [[nodiscard]] SharedReactions Step(const SharedReactions& last,
                                     std::span<const core::RigidTransform> world_from_rests,
                                     std::span<const core::PartContact> contacts,
                                     const std::shared_ptr<const recon::VisualHull>& hull, double dt_s) const;

 private:
  void StepCloths(std::span<const core::RigidTransform> world_from_rests,
                  const std::shared_ptr<const recon::VisualHull>& hull, double dt_s,
                  ReactionState* state) const;
  void StepPushes(std::span<const core::RigidTransform> world_from_rests,
                  std::span<const core::PartContact> contacts, const recon::VisualHull& hull, double dt_s,
                  ReactionState* state) const;

  const core::Layout& layout_;
  bool is_empty_ = true;
  std::vector<std::optional<review::ClothPanel>> panels_;
  std::vector<std::optional<review::SurfaceModel>> surfaces_;  // of what isn't cloth
};

}  // namespace elbowroom::control
