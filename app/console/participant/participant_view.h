// The participant's window: the latest picture, and a small sign where tracking is lost.
#pragma once

#include <QImage>
#include <QWidget>
#include <chrono>
#include <cstdint>
#include <optional>

#include "app/control/participant/participant_pictures.h"

namespace elbowroom::console {

// A window of its own, that fills a display or a part of it. Nothing of the operator's is in it. F11 changes
// between the whole display and a part of it, Escape closes it. Thread: UI.
class ParticipantView : public QWidget {
  Q_OBJECT

 public:
  explicit ParticipantView(QWidget* parent = nullptr);

  void ShowPicture(const control::ParticipantPicture& picture);
  void Clear();
  // The picture stays; the sign says that the head isn't followed.
  void ShowTracking(bool is_lost);
  void SetStereo(bool is_stereo);  // the sign is shown to each eye

  void FillDisplay(const QScreen* screen);
  [[nodiscard]] bool is_lost() const { return is_lost_; }
  [[nodiscard]] const QImage& picture() const { return picture_; }
  // The pixels that a picture should have.
  [[nodiscard]] QSize PictureSize() const;

 signals:
  // A picture was painted, so long after its pose was measured.
  void PictureSeen(double age_ms);
  void Resized();
  void Closed();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void PaintSign(QPainter& painter, const QRect& room) const;
  void TellAge();

  QImage picture_;
  // Of the picture's pose; nothing: its age was told, an earlier picture was of it, or it is a fixed point's.
  std::optional<std::chrono::steady_clock::time_point> measured_at_;
  std::int64_t serial_ = 0;  // of that pose
  bool is_lost_ = false;
  bool is_stereo_ = false;
};

}  // namespace elbowroom::console
