#include "app/console/reviews/timeline_view.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/console/desktop/theme.h"

namespace elbowroom::console {
namespace {

constexpr double kMarginPx = 8.0;
constexpr double kMarksPx = 16.0;  // height of the row of marks
constexpr double kScalePx = 16.0;  // and of the row of seconds
constexpr double kTallestRowPx = 18.0;
constexpr double kLeastSpanPx = 4.0;  // a touch of one frame can be seen and hit
constexpr std::size_t kMostRows = 5;  // more parts than these: those that were touched come first
constexpr double kSecondsApartPx = 70.0;

// The least of 1, 2, 5, 10, ... seconds that are far enough apart.
double SecondsBetween(double px_per_s) {
  double step_s = 0.1;
  for (int i = 0; step_s * px_per_s < kSecondsApartPx; ++i) {
    constexpr std::array kFactors = {2.0, 2.5, 2.0};
    step_s *= kFactors.at(static_cast<std::size_t>(i) % kFactors.size());
  }
  return step_s;
}

}  // namespace

TimelineView::TimelineView(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(false);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void TimelineView::Open(const control::SessionTimeline& timeline) {
  timeline_ = timeline;
  rows_.clear();
  std::vector<const control::TimelineRow*> rows;
  for (const control::TimelineRow& row : timeline.rows) rows.push_back(&row);
  std::ranges::stable_sort(rows, {}, [](const auto* row) { return row->spans.empty(); });
  if (rows.size() > kMostRows) {
    const auto touched = static_cast<std::size_t>(
        std::ranges::count_if(rows, [](const auto* row) { return !row->spans.empty(); }));
    rows.resize(std::max(kMostRows, touched));
  }
  for (const control::TimelineRow* row : rows)
    rows_.push_back({QString::fromStdString(row->part), row->spans, {}});
  chosen_.reset();
  vanished_.clear();
  time_s_ = timeline.begin_s;
  updateGeometry();
  update();
}

void TimelineView::ShowTime(double time_s) {
  time_s_ = time_s;
  update();
}

void TimelineView::ShowVanished(std::set<std::size_t> vanished) {
  vanished_ = std::move(vanished);
  update();
}

void TimelineView::ShowTried(const std::vector<control::TimelineRow>& rows) {
  for (Row& row : rows_) {
    const auto of_part = std::ranges::find(rows, row.name.toStdString(), &control::TimelineRow::part);
    row.tried = of_part == rows.end() ? std::vector<control::TimelineSpan>() : of_part->spans;
  }
  update();
}

void TimelineView::ShowChosen(std::optional<std::size_t> chosen) {
  chosen_ = chosen;
  update();
}

QSize TimelineView::sizeHint() const { return {600, HeightOf(std::max<std::size_t>(rows_.size(), 1))}; }

int TimelineView::HeightOf(std::size_t rows) {
  return static_cast<int>(std::ceil(kTallestRowPx * static_cast<double>(rows) + kMarksPx + kScalePx + 4.0));
}

QSize TimelineView::minimumSizeHint() const { return {300, sizeHint().height()}; }

double TimelineView::NameWidth() const {
  double widest_px = 0.0;
  for (const Row& row : rows_)
    widest_px = std::max(widest_px, static_cast<double>(fontMetrics().horizontalAdvance(row.name)));
  return std::min(widest_px, 0.2 * width()) + 2.0 * kMarginPx;
}

double TimelineView::RowHeight() const {
  if (rows_.empty()) return kTallestRowPx;
  return std::min(kTallestRowPx, (height() - kMarksPx - kScalePx) / static_cast<double>(rows_.size()));
}

double TimelineView::XOf(double time_s) const {
  const double left_px = NameWidth();
  const double length_s = std::max(timeline_.end_s - timeline_.begin_s, 1e-3);
  return left_px + (time_s - timeline_.begin_s) / length_s * (width() - kMarginPx - left_px);
}

double TimelineView::TimeAt(double x_px) const {
  const double left_px = NameWidth();
  const double part = std::clamp((x_px - left_px) / std::max(width() - kMarginPx - left_px, 1.0), 0.0, 1.0);
  return timeline_.begin_s + part * (timeline_.end_s - timeline_.begin_s);
}

QRectF TimelineView::SpanRect(std::size_t row, const control::TimelineSpan& span) const {
  const double left_px = XOf(span.begin_s);
  const double width_px = std::max(XOf(span.end_s) - left_px, kLeastSpanPx);
  const double height_px = RowHeight();
  const double inset_px = span.kind == core::FindingKind::kTouch ? 0.12 : 0.32;  // near misses are thinner
  return {left_px, kMarksPx + height_px * (static_cast<double>(row) + inset_px), width_px,
          height_px * (1.0 - 2.0 * inset_px)};
}

QRectF TimelineView::MarkRect(const control::TimelineMark& mark) const {
  return {XOf(mark.time_s) - 5.0, 2.0, 10.0, kMarksPx - 4.0};
}

QRectF TimelineView::PlaceOf(std::size_t finding) const {
  for (std::size_t row = 0; row < rows_.size(); ++row)
    for (const control::TimelineSpan& span : rows_[row].spans)
      if (span.finding == finding) return SpanRect(row, span);
  return {};
}

const control::TimelineSpan* TimelineView::SpanAt(const QPointF& at) const {
  for (std::size_t row = 0; row < rows_.size(); ++row)
    for (const control::TimelineSpan& span : rows_[row].spans)
      if (SpanRect(row, span).adjusted(-2, -2, 2, 2).contains(at)) return &span;
  return nullptr;
}

QString TimelineView::TextAt(const QPointF& at) const {
  if (const control::TimelineSpan* span = SpanAt(at))
    return tr("%1, %2 to %3 s")
        .arg(span->kind == core::FindingKind::kTouch ? tr("Touch") : tr("Near miss"))
        .arg(span->begin_s, 0, 'f', 2)
        .arg(span->end_s, 0, 'f', 2);
  QStringList lines;
  for (const control::TimelineMark& mark : timeline_.marks)
    if (MarkRect(mark).contains(at))
      lines << tr("%1 s: %2").arg(mark.time_s, 0, 'f', 2).arg(QString::fromStdString(mark.text));
  return lines.isEmpty() ? tr("%1 s").arg(TimeAt(at.x()), 0, 'f', 2) : lines.join('\n');
}

bool TimelineView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), TextAt(help->pos()), this);
  return true;
}

void TimelineView::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  if (const control::TimelineSpan* span = SpanAt(event->position())) {
    emit FindingChosen(span->finding);
  } else {
    GoTo(event->position().x());
  }
}

void TimelineView::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons() & Qt::LeftButton) GoTo(event->position().x());
}

void TimelineView::GoTo(double x_px) { emit Scrubbed(TimeAt(x_px)); }

void TimelineView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  PaintScale(painter);
  PaintRows(painter);
  PaintMarks(painter);
  const double x_px = XOf(time_s_);
  painter.setPen(QPen(palette().color(QPalette::Highlight), 2.0));
  painter.drawLine(QPointF(x_px, 0.0), QPointF(x_px, height() - 2.0));
  if (!hasFocus()) return;
  painter.setPen(QPen(palette().color(QPalette::Highlight), 1.0));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
}

void TimelineView::PaintScale(QPainter& painter) const {
  const double px_per_s = XOf(timeline_.begin_s + 1.0) - XOf(timeline_.begin_s);
  const double step_s = SecondsBetween(px_per_s);
  painter.setPen(ThemeColors().quiet_text);
  for (double at_s = std::ceil(timeline_.begin_s / step_s) * step_s; at_s <= timeline_.end_s;
       at_s += step_s) {
    const QRectF room(XOf(at_s) - 0.5 * kSecondsApartPx, height() - kScalePx, kSecondsApartPx, kScalePx);
    if (room.right() > width()) break;
    painter.drawText(room, Qt::AlignHCenter | Qt::AlignVCenter, tr("%1 s").arg(at_s, 0, 'g', 5));
  }
}

void TimelineView::PaintRows(QPainter& painter) const {
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const QRectF room(kMarginPx, kMarksPx + RowHeight() * static_cast<double>(row), width() - 2.0 * kMarginPx,
                      RowHeight());
    if (row % 2 == 0) painter.fillRect(room, palette().color(QPalette::AlternateBase));
    painter.setPen(palette().color(QPalette::WindowText));
    painter.drawText(room, Qt::AlignVCenter | Qt::AlignLeft,
                     fontMetrics().elidedText(rows_[row].name, Qt::ElideRight,
                                              static_cast<int>(NameWidth() - 2.0 * kMarginPx) + 1));
    PaintSpans(painter, row);
  }
}

void TimelineView::PaintSpans(QPainter& painter, std::size_t row) const {
  const Colors& colors = ThemeColors();
  for (const control::TimelineSpan& span : rows_[row].spans) {
    const bool is_gone = vanished_.contains(span.finding);
    const bool is_touch = span.kind == core::FindingKind::kTouch;
    const QColor ink = is_gone ? colors.quiet_text : is_touch ? colors.contact : colors.attention;
    painter.setPen(chosen_ == span.finding ? QPen(palette().color(QPalette::WindowText), 2.0)
                                           : QPen(ink, 1.0));
    painter.setBrush(is_gone ? QBrush(Qt::NoBrush) : QBrush(ink));
    painter.drawRoundedRect(SpanRect(row, span), 2.0, 2.0);
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(palette().color(QPalette::Highlight));
  for (const control::TimelineSpan& span : rows_[row].tried) {
    const double thick_px = span.kind == core::FindingKind::kTouch ? 4.0 : 2.0;
    QRectF line = SpanRect(row, span);
    line.setTop(kMarksPx + RowHeight() * static_cast<double>(row + 1) - thick_px);
    line.setHeight(thick_px);
    painter.drawRect(line);
  }
}

// A triangle for a gap, a square for a tool, a bar for a step, a diamond for a bookmark, a disc for what was
// said.
void TimelineView::PaintMarks(QPainter& painter) const {
  painter.setPen(Qt::NoPen);
  painter.setBrush(palette().color(QPalette::WindowText));
  for (const control::TimelineMark& mark : timeline_.marks) {
    const QRectF room = MarkRect(mark).adjusted(1, 1, -1, -1);
    switch (mark.kind) {
      case control::MarkKind::kGap:
        painter.drawPolygon(QPolygonF({room.topLeft(), room.topRight(), {room.center().x(), room.bottom()}}));
        break;
      case control::MarkKind::kTool:
        painter.drawRect(room.adjusted(1, 1, -1, -1));
        break;
      case control::MarkKind::kStep:
        painter.drawRect(QRectF(room.center().x() - 1.0, room.top(), 2.0, room.height()));
        break;
      case control::MarkKind::kBookmark:
        painter.drawPolygon(QPolygonF({{room.center().x(), room.top()},
                                       {room.right(), room.center().y()},
                                       {room.center().x(), room.bottom()},
                                       {room.left(), room.center().y()}}));
        break;
      case control::MarkKind::kAnswer:
      case control::MarkKind::kNote:
        painter.drawEllipse(room.adjusted(1, 1, -1, -1));
        break;
    }
  }
}

}  // namespace elbowroom::console
