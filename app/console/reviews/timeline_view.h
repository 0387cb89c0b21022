// A session over time, painted: touches and near misses a part, marks of what happened, and where we are.
#pragma once

#include <QWidget>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "app/control/reviewing/session_timeline.h"

namespace elbowroom::console {

// Click or drag goes to that time; a click on a touch chooses it. Thread: UI.
class TimelineView : public QWidget {
  Q_OBJECT

 public:
  explicit TimelineView(QWidget* parent = nullptr);

  void Open(const control::SessionTimeline& timeline);
  void ShowTime(double time_s);
  // Places in the list of findings.
  void ShowVanished(std::set<std::size_t> vanished);  // at the gaps that are tried
  // What was found at the gaps that are tried, below what was recorded; empty: nothing is tried.
  void ShowTried(const std::vector<control::TimelineRow>& rows);
  void ShowChosen(std::optional<std::size_t> chosen);

  [[nodiscard]] QSize sizeHint() const override;
  [[nodiscard]] QSize minimumSizeHint() const override;
  [[nodiscard]] static int HeightOf(std::size_t rows);  // with marks and scale, px

  // Where that time is, in px from the left; and which touch or mark is at a point.
  [[nodiscard]] double XOf(double time_s) const;
  [[nodiscard]] QRectF PlaceOf(std::size_t finding) const;  // empty: it has none

 signals:
  void Scrubbed(double time_s);
  void FindingChosen(std::size_t finding);

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;

 private:
  struct Row {
    QString name;
    std::vector<control::TimelineSpan> spans;
    std::vector<control::TimelineSpan> tried;
  };
  [[nodiscard]] double TimeAt(double x_px) const;
  [[nodiscard]] QRectF SpanRect(std::size_t row, const control::TimelineSpan& span) const;
  [[nodiscard]] QRectF MarkRect(const control::TimelineMark& mark) const;
  [[nodiscard]] double RowHeight() const;
  [[nodiscard]] double NameWidth() const;
  [[nodiscard]] const control::TimelineSpan* SpanAt(const QPointF& at) const;
  [[nodiscard]] QString TextAt(const QPointF& at) const;
  void PaintScale(QPainter& painter) const;
  void PaintRows(QPainter& painter) const;
  void PaintSpans(QPainter& painter, std::size_t row) const;
  void PaintMarks(QPainter& painter) const;
  void GoTo(double x_px);

  control::SessionTimeline timeline_;
  std::vector<Row> rows_;  // those that are shown
  double time_s_ = 0.0;
  std::set<std::size_t> vanished_;
  std::optional<std::size_t> chosen_;
};

}  // namespace elbowroom::console
