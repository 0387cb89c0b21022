#include "app/console/layouts/placing_steps.h"

#include <utility>

#include "app/control/placing/cylinder_fit.h"
#include "app/control/placing/snap.h"
#include "app/control/placing/surface_patch.h"

namespace elbowroom::console {
namespace {

constexpr double kSmoothTurnDeg = 30.0;

// The axis of the hole or pin that was clicked on, in the mesh's frame; nothing where that isn't round.
std::optional<control::AxisLine> AxisUnder(const core::TriangleMesh& mesh, std::uint32_t triangle,
                                           const std::stop_token& stop) {
  const auto fit = control::FitCylinder(mesh, control::SmoothPatch(mesh, triangle, kSmoothTurnDeg, stop));
  return fit ? std::optional(control::AxisLine{fit->point, fit->direction}) : std::nullopt;
}

}  // namespace

PlacingSteps::PlacingSteps(QObject* parent) : QObject(parent) {}

PlacingSteps::~PlacingSteps() = default;

void PlacingSteps::Begin(Placing placing) {
  placing_ = placing;
  first_.reset();
  ++runs_;
  if (finding_) finding_->Cancel();
  emit Changed();
}

QString PlacingSteps::Advice() const {
  if (finding_ && placing_ == Placing::kHoleToHole) return tr("Looking at what was clicked on …; Esc: no");
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
  if (placing_ == Placing::kNone || finding_) return;
  const core::Part& part = layout.parts[pick.part];
  const Click click{QString::fromStdString(part.name), world_from_parts[pick.part], pick, {}};
  if (placing_ == Placing::kHoleToHole) return FindAxis(part.mesh, click);
  TakeClick(click);
}

void PlacingSteps::FindAxis(const core::SharedMesh& mesh, const Click& click) {
  auto found = std::make_shared<std::optional<control::AxisLine>>();
  finding_ = std::make_unique<BackgroundJob>(
      bridge_,
      [mesh, triangle = click.pick.triangle, found](const std::stop_token& stop) {
        *found = AxisUnder(*mesh, triangle, stop);
      },
      [this, found, click, run = runs_](const std::string& error) {
        finding_.reset();
        emit Changed();
        if (run != runs_) return;
        if (!error.empty()) return emit Failed(QString::fromStdString(error));
        if (!*found)
          return emit Failed(
              tr("What was clicked on of %1 isn't round: click on the wall of a hole").arg(click.part));
        Click with_axis = click;
        with_axis.axis = {click.world_from_part * (*found)->point_in_world,
                          click.world_from_part.rotation * (*found)->direction_in_world};
        TakeClick(with_axis);
      });
  emit Changed();
}

void PlacingSteps::TakeClick(const Click& click) {
  if (!first_) {
    first_ = click;
    return emit Changed();
  }
  if (first_->pick.part == click.pick.part)
    return emit Failed(tr("That is %1 itself: click on the part that stays").arg(click.part));
  const Click first = *first_;
  const core::RigidTransform placed =
      placing_ == Placing::kHoleToHole
          ? control::AxisToAxis(first.world_from_part, first.axis, click.axis)
          : control::FaceToFace(first.world_from_part,
                                {first.pick.point_in_world, first.pick.normal_in_world},
                                {click.pick.point_in_world, click.pick.normal_in_world});
  End();
  emit Placed(first.part, placed);
}

}  // namespace elbowroom::console
