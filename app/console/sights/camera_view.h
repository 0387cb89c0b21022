// One camera's live picture, large, with the virtual parts in it.
#pragma once

#include <QImage>
#include <QString>
#include <QWidget>

#include "app/control/tiles/tile_maker.h"

namespace elbowroom::console {

// Shows the picture at the size that it has, smaller if there is no room, never larger than the camera's own.
// Esc and a double click close it. Thread: UI.
class CameraView : public QWidget {
  Q_OBJECT

 public:
  explicit CameraView(QWidget* parent = nullptr);

  void Open(const QString& camera);  // its picture comes with its next tile
  void ShowTile(const control::CameraTile& tile);
  [[nodiscard]] control::ThumbnailRoom Room() const;  // in the screen's pixels
  [[nodiscard]] const QImage& picture() const { return picture_; }

 signals:
  void RoomChanged();
  void Closed();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  QString camera_;
  QString trouble_;
  QImage picture_;
};

}  // namespace elbowroom::console
