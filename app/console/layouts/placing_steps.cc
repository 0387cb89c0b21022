#include "app/console/layouts/placing_steps.h"

#include "app/control/placing/cylinder_fit.h"
#include "app/control/placing/snap.h"
#include "app/control/placing/surface_patch.h"

namespace elbowroom::console {
namespace {

constexpr double kSmoothTurnDeg = 30.0;

// The axis of the hole or pin that was clicked on; nothing where that isn't round.
std::optional<control::AxisLine> AxisUnder(const core::Layout& layout,
                                           const std::vector<core::RigidTransform>& world_from_parts,
                                           const control::Pick& pick) {
  const core::TriangleMesh& mesh = *layout.parts[pick.part].mesh;
  const auto fit = control::FitCylinder(mesh, control::SmoothPatch(mesh, pick.triangle, kSmoothTurnDeg));
  if (!fit) return std::nullopt;
  const core::RigidTransform& pose = world_from_parts[pick.part];
  return control::AxisLine{pose * fit->point, pose.rotation * fit->direction};
}

}  // namespace

void PlacingSteps::Begin(Placing placing) {
  placing_ = placing;
  first_.reset();
  emit Changed();
}

QString PlacingSteps::Advice() const {
  switch (placing_) {
    case Placing::kNone:
      return {};
    case Placing::kFaceToFace:
      return first_ ? tr("Click on the face of another part that %1 is laid on; Esc: no").arg(first_->part)
                    : tr("Click on the face of the part that moves; Esc: no");
    case Placing::kHoleToHole:
      return first_
                 ? tr("Click into the hole, or on the pin, that %1 is brought to; Esc: no").arg(first_->part)
                 : tr("Click into the hole, or on the pin, of the part that moves; Esc: no");
    case Placing::kMeasuredPoints:
      return tr("Click on points of the part that were measured on the real one");
  }
  return {};
}

void PlacingSteps::Take(const core::Layout& layout, const std::vector<core::RigidTransform>& world_from_parts,
                        const control::Pick& pick) {
  if (placing_ == Placing::kMeasuredPoints) return emit PointTaken(pick);
  const QString part = QString::fromStdString(layout.parts[pick.part].name);
  const bool is_hole = placing_ == Placing::kHoleToHole;
  if (is_hole && !AxisUnder(layout, world_from_parts, pick))
    return emit Failed(tr("What was clicked on of %1 isn't round: click on the wall of a hole").arg(part));
  if (!first_) {
    first_ = {part, pick};
    return emit Changed();
  }
  if (first_->pick.part == pick.part)
    return emit Failed(tr("That is %1 itself: click on the part that stays").arg(part));
  const core::RigidTransform& pose = world_from_parts[first_->pick.part];
  const core::RigidTransform placed =
      is_hole ? control::AxisToAxis(pose, *AxisUnder(layout, world_from_parts, first_->pick),
                                    *AxisUnder(layout, world_from_parts, pick))
              : control::FaceToFace(pose, {first_->pick.point_in_world, first_->pick.normal_in_world},
                                    {pick.point_in_world, pick.normal_in_world});
  const QString moved = first_->part;
  End();
  emit Placed(moved, placed);
}

}  // namespace elbowroom::console
