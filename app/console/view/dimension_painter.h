// Lengths and places, written over the 3-D view's picture.
#pragma once

#include <QPainter>
#include <QPoint>
#include <span>

#include "app/control/measuring/dimension.h"
#include "recon/appearance/scene_view.h"

namespace elbowroom::console {

// `view`: of a picture in the painter's pixels, whose upper left corner is at `origin`. A line has a mark at
// either end and its text beside its middle; what is behind the eye is left out. Texts lie over lines; they
// make room for marks and for one another, and a dotted line leads to those that are farther away.
void PaintDimensions(QPainter& painter, const recon::SceneView& view, const QPoint& origin,
                     std::span<const control::Dimension> dimensions);

}  // namespace elbowroom::console
