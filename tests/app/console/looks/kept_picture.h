// Pictures of windows and dialogs that a person looks at.
#pragma once

#include <QSize>
#include <QString>
#include <QWidget>

namespace elbowroom::console {

// Of the window: ELBOWROOM_SCREENSHOTS_SIZE (1920x1080), else 1280 x 720.
[[nodiscard]] QSize WantedSize();

// Into the folder ELBOWROOM_SCREENSHOTS, as NAME.png; without that variable it does nothing.
void KeepPicture(const char* name, QWidget& top);

}  // namespace elbowroom::console
