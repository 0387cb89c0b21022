// What the cameras see as object, side by side.
#pragma once

#include <QFrame>
#include <QImage>
#include <QString>
#include <vector>

#include "core/bit_mask.h"
#include "core/rig.h"
#include "core/session.h"

namespace elbowroom::console {

// One camera: its silhouette, its name and how many object pixels there are.
class CameraThumbnail : public QWidget {
 public:
  explicit CameraThumbnail(const core::CameraModel& camera, QWidget* parent = nullptr);

  void ShowMask(const core::BitMask& mask);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString name_;
  QSize camera_px_;
  QImage picture_;
  std::size_t object_px_ = 0;
};

// Thread: UI.
class CameraStrip : public QFrame {
 public:
  explicit CameraStrip(QWidget* parent = nullptr);

  void Open(const core::Rig& rig);
  void ShowMasks(const core::SharedMasks& masks);  // one a camera; those already shown cost nothing

 private:
  std::vector<CameraThumbnail*> thumbnails_;  // owned by Qt as children
  core::SharedMasks shown_;
};

}  // namespace elbowroom::console
