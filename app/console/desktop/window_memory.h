// What the window keeps from one run of the program to the next.
#pragma once

#include <QMainWindow>

namespace elbowroom::console {

// Size, place and panels as SaveWindow() left them. Without these, or where the screen is another one: as
// large as `size`, but no larger than the screen has room for.
void RestoreWindow(QMainWindow* window, const QSize& size);
void SaveWindow(const QMainWindow& window);

}  // namespace elbowroom::console
