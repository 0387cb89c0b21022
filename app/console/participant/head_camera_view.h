// The picture of a camera on the head, with marks, as it is registered.
#pragma once

#include <QImage>
#include <QWidget>
#include <optional>
#include <vector>

namespace elbowroom::console {

// Tells of drags and clicks in pixels of the picture. Thread: UI.
class HeadCameraView : public QWidget {
  Q_OBJECT

 public:
  struct Mark {
    QPointF corner;               // where the part's corner is drawn
    std::optional<QPointF> seen;  // where the picture has it; nothing: not marked yet
    bool is_chosen = false;
  };

  explicit HeadCameraView(QWidget* parent = nullptr);

  void ShowPicture(const QImage& picture);
  void ShowMarks(std::vector<Mark> marks);
  void SetMarking(bool is_marking);  // clicks are told, and nothing is dragged
  [[nodiscard]] QSize picture_size() const { return picture_.size(); }
  // Of a picture pixel, for tests.
  [[nodiscard]] QPoint WidgetPointOf(const QPointF& pixel) const;
  [[nodiscard]] QSize sizeHint() const override { return {800, 600}; }

 signals:
  void Dragged(const QPointF& by_px);
  void Clicked(const QPointF& pixel);
  void Wheeled(int steps);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  [[nodiscard]] QRectF PictureRect() const;
  [[nodiscard]] QPointF PixelAt(const QPointF& at) const;
  [[nodiscard]] double Scale() const;  // widget pixels for one of the picture's

  QImage picture_;
  std::vector<Mark> marks_;
  bool is_marking_ = false;
  std::optional<QPointF> dragged_from_;
};

}  // namespace elbowroom::console
