#include "recon/gl/scene/still_content.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace elbowroom::recon::gl {
namespace {

template <typename Box>
bool AreSameBoxes(const std::optional<Box>& a, const std::optional<Box>& b) {
  return a.has_value() == b.has_value() && (!a || (a->min() == b->min() && a->max() == b->max()));
}

bool AreSameSurroundings(const Scene& a, const Scene& b) {
  return a.view == b.view && a.lamp == b.lamp && a.table_grid_mm == b.table_grid_mm &&
         AreSameBoxes(a.table_in_world, b.table_in_world) &&
         AreSameBoxes(a.workspace_in_world, b.workspace_in_world) && a.cameras == b.cameras &&
         a.background_top == b.background_top && a.background_bottom == b.background_bottom;
}

bool ThrowSameShadow(const StillPart& a, const StillPart& b) {
  return a.mesh.lock() == b.mesh.lock() && a.world_from_part == b.world_from_part && a.level == b.level &&
         a.is_decal == b.is_decal;
}

bool LookSame(const StillPart& a, const StillPart& b) {
  if (a.is_opaque != b.is_opaque) return false;
  return !a.is_opaque || (ThrowSameShadow(a, b) && a.color == b.color && a.in_contact == b.in_contact &&
                          a.is_cut_face == b.is_cut_face);
}

bool AreSame(const StillPart& a, const StillPart& b) { return ThrowSameShadow(a, b) && LookSame(a, b); }

void AddBoxes(const StillPart& part, bool looks_other, bool throws_other, StillChange& change) {
  if (looks_other && part.is_opaque && !part.in_picture.isEmpty())
    change.in_picture.push_back(part.in_picture);
  if (throws_other && !part.in_lamp.isEmpty()) change.in_lamp.push_back(part.in_lamp);
}

// Parts are drawn in order, so that lists of different lengths are compared from both of their ends.
StillChange ChangeOfAll(std::span<const StillPart> before, std::span<const StillPart> after) {
  while (!before.empty() && !after.empty() && AreSame(before.front(), after.front())) {
    before = before.subspan(1);
    after = after.subspan(1);
  }
  while (!before.empty() && !after.empty() && AreSame(before.back(), after.back())) {
    before = before.first(before.size() - 1);
    after = after.first(after.size() - 1);
  }
  StillChange change;
  for (const auto& parts : {before, after})
    for (const StillPart& part : parts) AddBoxes(part, /*looks_other=*/true, /*throws_other=*/true, change);
  return change;
}

}  // namespace

StillContent::StillContent(const Scene& scene, const PartPainter& painter) {
  surroundings_.view = scene.view;
  surroundings_.lamp = scene.lamp;
  surroundings_.table_in_world = scene.table_in_world;
  surroundings_.table_grid_mm = scene.table_grid_mm;
  surroundings_.workspace_in_world = scene.workspace_in_world;
  surroundings_.cameras = scene.cameras;
  surroundings_.background_top = scene.background_top;
  surroundings_.background_bottom = scene.background_bottom;
  const SceneView from_lamp = scene.lamp.ShadowView(1);
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart& part = scene.parts[i];
    if (part.opacity <= 0.0F) continue;
    parts_.push_back({part.mesh, part.world_from_part, part.color, part.in_contact, part.is_cut_face,
                      part.is_decal, part.opacity >= 1.0F, painter.levels().at(i),
                      painter.BoundsIn(part, scene.view),
                      part.is_decal ? Eigen::AlignedBox2f() : painter.BoundsIn(part, from_lamp)});
  }
}

bool StillContent::operator==(const StillContent& other) const {
  return AreSameSurroundings(surroundings_, other.surroundings_) &&
         std::ranges::equal(parts_, other.parts_, AreSame);
}

std::optional<StillChange> StillContent::ChangeTo(const StillContent& other) const {
  if (!AreSameSurroundings(surroundings_, other.surroundings_)) return std::nullopt;
  if (parts_.size() != other.parts_.size()) return ChangeOfAll(parts_, other.parts_);
  StillChange change;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const bool looks_other = !LookSame(parts_[i], other.parts_[i]);
    const bool throws_other = !ThrowSameShadow(parts_[i], other.parts_[i]);
    AddBoxes(parts_[i], looks_other, throws_other, change);
    AddBoxes(other.parts_[i], looks_other, throws_other, change);
  }
  return change;
}

}  // namespace elbowroom::recon::gl
