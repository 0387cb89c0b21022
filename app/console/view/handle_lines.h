// The lines of handles that are painted over a 3-D picture, to be grabbed by the mouse.
#pragma once

#include <Eigen/Core>
#include <QPainter>
#include <QPolygonF>
#include <optional>
#include <vector>

#include "recon/appearance/scene_view.h"

namespace elbowroom::console {

inline constexpr double kHandlePx = 78.0;         // an arrow's length
inline constexpr double kHandleReachPx = 7.0;     // of the pointer
inline constexpr double kHandleRingShare = 0.72;  // of the arrow's length

// How long an arrow at that place is, so that it has about the same length in any picture; nothing behind the
// eye.
[[nodiscard]] std::optional<double> HandleLengthMm(const recon::SceneView& view,
                                                   const Eigen::Vector3d& at_in_world);

// An arrow of that length, and a ring about the axis.
[[nodiscard]] std::vector<Eigen::Vector3d> ArrowAlong(const Eigen::Vector3d& at_in_world,
                                                      const Eigen::Vector3d& direction_in_world,
                                                      double length_mm);
[[nodiscard]] std::vector<Eigen::Vector3d> RingAcross(const Eigen::Vector3d& at_in_world,
                                                      const Eigen::Vector3d& first_in_world,
                                                      const Eigen::Vector3d& second_in_world,
                                                      double length_mm);

// In the picture's pixels, whose centres are at halves; without the points behind the eye.
[[nodiscard]] QPolygonF Projected(const recon::SceneView& view, const std::vector<Eigen::Vector3d>& line);

[[nodiscard]] double DistanceTo(const QPolygonF& line, const QPointF& position);

// A place on the line that is well away from other handles' lines.
[[nodiscard]] std::optional<QPointF> GripOf(const QPolygonF& line, bool is_ring);

void PaintHandle(QPainter& painter, const QPolygonF& line, bool is_ring, const QColor& ink, bool is_hot);

}  // namespace elbowroom::console
