// The handles at a part that it is dragged by: an arrow along each axis of the world, and a ring about it.
#pragma once

#include <QPainter>
#include <QPolygonF>
#include <array>
#include <optional>
#include <vector>

#include "app/control/placing/drag.h"
#include "core/rigid_transform.h"

namespace elbowroom::console {

struct GizmoHandle {
  bool is_ring = false;
  int axis = 0;  // of the world: 0 x, 1 y, 2 z

  [[nodiscard]] bool operator==(const GizmoHandle&) const = default;
};

// Of about the same size in any picture. Thread: UI.
class PartGizmo {
 public:
  // `may_move`: along which axes; the others have no arrow.
  PartGizmo(const recon::SceneView& view, const Eigen::Vector3d& center_in_world,
            const std::array<bool, 3>& may_move);

  // The handle within a few pixels; of several the nearest.
  [[nodiscard]] std::optional<GizmoHandle> HandleAt(const QPointF& position) const;
  // Where the middle of a handle is seen; nothing where it isn't.
  [[nodiscard]] std::optional<QPointF> MiddleOf(const GizmoHandle& handle) const;
  void Paint(QPainter& painter, const std::optional<GizmoHandle>& hot) const;

 private:
  struct Drawn {
    GizmoHandle handle;
    QPolygonF line;
  };
  std::vector<Drawn> drawn_;
};

// From the press on a handle to its release.
class GizmoDrag {
 public:
  // Nothing where the handle can't be dragged from there: the eye looks along it.
  [[nodiscard]] static std::optional<GizmoDrag> Begin(const GizmoHandle& handle,
                                                      const Eigen::Vector3d& center_in_world,
                                                      const core::RigidTransform& world_from_part,
                                                      const control::PickRay& ray);

  // Where the part is to stand now. In whole millimetres or steps of 5 degrees from where it stood, if so
  // asked.
  [[nodiscard]] core::RigidTransform At(const control::PickRay& ray, bool in_steps) const;
  [[nodiscard]] const core::RigidTransform& start() const { return start_; }

 private:
  [[nodiscard]] std::optional<double> ValueOf(const control::PickRay& ray) const;

  GizmoHandle handle_;
  control::AxisLine axis_;
  core::RigidTransform start_;
  double first_ = 0.0;  // mm or radians
};

}  // namespace elbowroom::console
