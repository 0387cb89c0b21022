#include "app/console/desktop/window_memory.h"

#include <QScreen>
#include <QSettings>

namespace elbowroom::console {
namespace {

constexpr const char* kGeometryKey = "window/geometry";
constexpr const char* kPanelsKey = "window/panels";
constexpr int kPanelsVersion = 1;  // to be raised where the panels are others

}  // namespace

void RestoreWindow(QMainWindow* window, const QSize& size) {
  const QSettings settings;
  const QSize room = window->screen()->availableGeometry().size();
  window->resize(size.boundedTo(room));
  if (window->restoreGeometry(settings.value(kGeometryKey).toByteArray()) && !window->isMaximized() &&
      !window->isFullScreen())
    window->resize(window->size().boundedTo(room));
  window->restoreState(settings.value(kPanelsKey).toByteArray(), kPanelsVersion);
}

void SaveWindow(const QMainWindow& window) {
  QSettings settings;
  settings.setValue(kGeometryKey, window.saveGeometry());
  settings.setValue(kPanelsKey, window.saveState(kPanelsVersion));
}

}  // namespace elbowroom::console
