// What the cameras see, side by side, and how well each does.
#pragma once

#include <QFrame>
#include <QImage>
#include <QString>
#include <vector>

#include "app/console/tile_text.h"
#include "app/control/tiles/tile_maker.h"
#include "core/rig.h"

namespace elbowroom::console {

// One camera: its picture with the silhouette's outline, and its figures below. Grey while it is gone.
class CameraThumbnail : public QWidget {
  Q_OBJECT

 public:
  explicit CameraThumbnail(const core::CameraModel& camera, QWidget* parent = nullptr);

  void ShowTile(const control::CameraTile& tile);
  [[nodiscard]] const TileText& text() const { return text_; }
  [[nodiscard]] const QImage& picture() const { return picture_; }
  [[nodiscard]] QSize PictureRoom() const;  // in the screen's pixels

 signals:
  void Chosen();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  [[nodiscard]] int CaptionHeight() const;
  void PaintPicture(QPainter& painter, const QRect& room) const;
  void PaintCaption(QPainter& painter, const QRect& room) const;

  QString name_;
  QSize camera_px_;
  QImage picture_;
  TileText text_;
};

// Hidden until a rig is opened. Tells how large a picture may be, so that nobody makes one that isn't seen.
// Thread: UI.
class CameraStrip : public QFrame {
  Q_OBJECT

 public:
  explicit CameraStrip(QWidget* parent = nullptr);

  void Open(const core::Rig& rig);
  void ShowTiles(const control::SharedTiles& tiles);
  void SetWindowMinimized(bool is_minimized);
  [[nodiscard]] QSize sizeHint() const override;
  [[nodiscard]] const std::vector<CameraThumbnail*>& thumbnails() const { return thumbnails_; }

 signals:
  void RoomChanged(const elbowroom::control::ThumbnailRoom& room);  // of one picture; empty: none is seen
  void CameraChosen(int camera);                                    // by a double click, or Enter

 protected:
  bool event(QEvent* event) override;

 private:
  void TellRoom();

  std::vector<CameraThumbnail*> thumbnails_;  // owned by Qt as children
  bool is_minimized_ = false;
  control::ThumbnailRoom told_;
};

}  // namespace elbowroom::console
