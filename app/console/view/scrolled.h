// A panel that scrolls where its window is too low for it.
#pragma once

#include <QScrollArea>

namespace elbowroom::console {

// Owns the content. Its width is the panel's. Thread: UI.
[[nodiscard]] inline QScrollArea* Scrolled(QWidget* content) {
  auto* area = new QScrollArea;
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setWidget(content);
  return area;
}

}  // namespace elbowroom::console
