// The handles at a section plane: an arrow along its normal, and two rings that it is turned by.
#pragma once

#include <QPainter>
#include <QPolygonF>
#include <array>
#include <optional>

#include "app/control/placing/drag.h"
#include "app/control/section/section_list.h"

namespace elbowroom::console {

enum class PlaneHandle { kNormal, kFirstRing, kSecondRing };

// A plane within a box: where its handles are, and its outline. Thread: UI.
class PlaneHandles {
 public:
  // Nothing where the plane doesn't meet the box.
  [[nodiscard]] static std::optional<PlaneHandles> Of(const control::Section& section,
                                                      const Eigen::AlignedBox3d& box_in_world);

  // The middle of the outline, at which the handles are.
  [[nodiscard]] const Eigen::Vector3d& middle_in_world() const { return middle_in_world_; }
  // The axis along which the arrow moves the plane, or about which the ring turns it. The first ring's is
  // level.
  [[nodiscard]] control::AxisLine AxisOf(PlaneHandle handle) const;

  [[nodiscard]] std::optional<PlaneHandle> HandleAt(const recon::SceneView& view,
                                                    const QPointF& position) const;
  // Where a handle is seen; nothing where it isn't.
  [[nodiscard]] std::optional<QPointF> GripOn(const recon::SceneView& view, PlaneHandle handle) const;
  void Paint(QPainter& painter, const recon::SceneView& view, const std::optional<PlaneHandle>& hot) const;

 private:
  [[nodiscard]] QPolygonF LineOf(const recon::SceneView& view, PlaneHandle handle) const;

  std::vector<Eigen::Vector3d> outline_in_world_;
  Eigen::Vector3d middle_in_world_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_in_world_ = Eigen::Vector3d::UnitX();
};

// From the press on a handle to its release.
class PlaneDrag {
 public:
  // Nothing where the handle can't be dragged from there: the eye looks along it.
  [[nodiscard]] static std::optional<PlaneDrag> Begin(PlaneHandle handle, const PlaneHandles& handles,
                                                      const control::Section& section,
                                                      const control::PickRay& ray);

  // Where the plane is to be now. In whole millimetres or steps of 5 degrees from where it was, if so asked.
  [[nodiscard]] control::Section At(const control::PickRay& ray, bool in_steps) const;
  [[nodiscard]] const control::Section& start() const { return start_; }
  [[nodiscard]] PlaneHandle handle() const { return handle_; }

 private:
  [[nodiscard]] std::optional<double> ValueOf(const control::PickRay& ray) const;

  PlaneHandle handle_ = PlaneHandle::kNormal;
  control::AxisLine axis_;
  control::Section start_;
  double first_ = 0.0;  // mm or radians
};

}  // namespace elbowroom::console
