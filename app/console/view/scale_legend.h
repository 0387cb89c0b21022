// What the colours of the 3-D view's layers mean.
#pragma once

#include <QColor>
#include <QPainter>
#include <QRect>
#include <QString>
#include <span>
#include <vector>

#include "app/control/scene_composer.h"

namespace elbowroom::console {

struct ScaleLegend {
  QString title;                // the quantity, with its unit
  std::vector<QColor> colours;  // from the scale's beginning to its end; empty: no scale
  QStringList labels;           // evenly from the first colour to the last; as many as colours: one on each
  QString note;                 // "": none
};

// One for each layer that the look shows. `heat_of`: what the heat is of, such as "this trial".
[[nodiscard]] std::vector<ScaleLegend> LegendsOf(const control::SceneLook& look, const QString& heat_of);

// The same in words, for those who don't see it.
[[nodiscard]] QString TextOf(std::span<const ScaleLegend> legends);

// One below the other, in the upper right corner.
void PaintLegends(QPainter& painter, const QRect& room, std::span<const ScaleLegend> legends);

}  // namespace elbowroom::console
