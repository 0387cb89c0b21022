#include "app/control/part_reactions.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <variant>

namespace elbowroom::control {

std::vector<core::RigidTransform> MotionsOf(const ReactionState& state) {
  std::vector<core::RigidTransform> rest_from_parts;
  for (const review::PushState& push : state.pushes) rest_from_parts.push_back(push.rest_from_part);
  const bool none = std::ranges::count(rest_from_parts, core::RigidTransform()) ==
                    static_cast<std::ptrdiff_t>(rest_from_parts.size());
  if (none) rest_from_parts.clear();
  return rest_from_parts;
}

PartReactions::PartReactions(const core::Layout& layout) : layout_(layout) {
  for (const core::Part& part : layout.parts) is_empty_ = is_empty_ && part.gives_way.index() == 0;
  is_empty_ = is_empty_ && layout.streams.empty();
  panels_.resize(layout.parts.size());
  surfaces_.resize(layout.parts.size());
  if (is_empty_) return;
  for (core::PartIndex i = 0; i < layout.parts.size(); ++i) {
    if (std::holds_alternative<core::ClothRule>(layout.parts[i].gives_way)) {
      panels_[i].emplace(layout.parts[i]);
    } else {
      surfaces_[i].emplace(layout.parts[i].mesh);
    }
  }
}

SharedReactions PartReactions::Step(const SharedReactions& last,
                                    std::span<const core::RigidTransform> world_from_rests,
                                    std::span<const core::PartContact> contacts,
                                    const std::shared_ptr<const recon::VisualHull>& hull, double dt_s) const {
  auto state = last ? std::make_shared<ReactionState>(*last) : std::make_shared<ReactionState>();
  const std::size_t parts = layout_.parts.size();
  state->cloths.resize(parts);
  state->pushes.resize(parts);
  state->meshes_in_world.resize(parts);
  state->streams.resize(layout_.streams.size());
  StepCloths(world_from_rests, hull, dt_s, state.get());
  StepPushes(world_from_rests, contacts, *hull, dt_s, state.get());
  const std::vector<core::RigidTransform> pushed = core::WithMotions(world_from_rests, MotionsOf(*state));
  std::vector<review::StreamObstacle> obstacles;
  for (core::PartIndex i = 0; i < parts; ++i)
    if (surfaces_[i]) obstacles.push_back({&surfaces_[i]->tree(), pushed[i]});
  for (std::size_t i = 0; i < layout_.streams.size(); ++i) {
    state->streams[i] =
        review::StepStream(layout_.streams[i], std::move(state->streams[i]), *hull, obstacles, dt_s);
  }
  return state;
}

void PartReactions::StepCloths(std::span<const core::RigidTransform> world_from_rests,
                               const std::shared_ptr<const recon::VisualHull>& hull, double dt_s,
                               ReactionState* state) const {
  tbb::parallel_for(std::size_t{0}, panels_.size(), [&](std::size_t i) {
    if (!panels_[i]) return;
    std::optional<review::ClothState>& cloth = state->cloths[i];
    if (!cloth) cloth = review::ClothAtRest(*panels_[i], world_from_rests[i]);
    cloth = review::StepCloth(*panels_[i], std::move(*cloth), world_from_rests[i], hull, dt_s);
    state->meshes_in_world[i] =
        std::make_shared<const core::TriangleMesh>(review::MeshInWorld(*panels_[i], *cloth));
  });
}

void PartReactions::StepPushes(std::span<const core::RigidTransform> world_from_rests,
                               std::span<const core::PartContact> contacts, const recon::VisualHull& hull,
                               double dt_s, ReactionState* state) const {
  for (core::PartIndex i = 0; i < layout_.parts.size(); ++i) {
    if (!std::holds_alternative<core::PushRule>(layout_.parts[i].gives_way)) continue;
    const std::vector<core::RigidTransform> pushed = core::WithMotions(world_from_rests, MotionsOf(*state));
    std::vector<review::StandingPart> others;
    for (core::PartIndex k = 0; k < pushed.size(); ++k)
      if (k != i && surfaces_[k]) others.push_back({&*surfaces_[k], pushed[k]});
    state->pushes[i] = review::StepPush(layout_.parts[i], contacts[i], state->pushes[i],
                                        {&*surfaces_[i], world_from_rests[i]}, others, hull, dt_s);
  }
}

}  // namespace elbowroom::control
