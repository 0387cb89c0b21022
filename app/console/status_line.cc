#include "app/console/status_line.h"

#include <algorithm>

namespace elbowroom::console {
namespace {

constexpr qint64 kMostCounted = 99'999;  // more are told in per cent

QString PercentOf(std::int64_t share, std::int64_t whole) {
  return whole == 0 ? QString("–") : QString::number(100 * share / whole) + " %";
}

// The renderer of "vendor | renderer | version" without its remarks: "llvmpipe".
QString ShortDriver(const QString& driver) {
  const QString renderer = driver.section('|', 1, 1).section('(', 0, 0).trimmed();
  return renderer.isEmpty() ? driver : renderer;
}

}  // namespace

StatusLine::StatusLine(QWidget* parent) : QStatusBar(parent) {
  setSizeGripEnabled(false);
  frame_ = AddField("status_frame", 0);
  recorded_ = AddField("status_recorded", 0);
  times_ = AddField("status_times", 0);
  age_ = AddField("status_age", 0);
  skipped_ = AddField("status_skipped", 3);
  session_ = AddField("status_session", 1);
  driver_ = AddField("status_driver", 0);
  progress_ = new QProgressBar;
  progress_->setObjectName("status_progress");
  progress_->setFixedWidth(220);
  progress_->hide();
  addPermanentWidget(progress_);
  frame_->setText(tr("ready"));
}

QLabel* StatusLine::AddField(const QString& name, int stretch) {
  auto* field = new QLabel;
  field->setObjectName(name);
  field->setTextFormat(Qt::PlainText);
  field->setContentsMargins(4, 0, 10, 0);
  addWidget(field, stretch);
  return field;
}

void StatusLine::Open(const std::filesystem::path& session) {
  rate_.Clear();
  ages_ = {};
  age_->clear();
  age_->setMinimumWidth(0);
  session_->setText(QString::fromStdString(session.filename().string()));
  session_->setToolTip(QString::fromStdString(session.string()));
}

void StatusLine::ShowFrame(const control::FrameResult& result, const control::RecordedFrames& recorded) {
  rate_.Add(result.record.frame, FrameRate::Clock::now());
  const std::optional<double> frames_per_s = rate_.frames_per_s();
  frame_->setText(tr("frame %1   %2 s   %3 frames/s")
                      .arg(result.record.frame)
                      .arg(result.record.time_s, 0, 'f', 1)
                      .arg(frames_per_s ? QString::number(*frames_per_s, 'f', 1) : QString("–")));
  recorded_->setText(tr("on disk: %1 of %2 frames").arg(recorded.committed).arg(recorded.seen));
  const QString response =
      result.response ? tr("   response %1").arg(result.times.response_ms, 0, 'f', 0) : QString();
  times_->setText(tr("segmentation %1   hull %2   contacts %3%4   drawing %5 ms")
                      .arg(result.times.segmentation_ms, 0, 'f', 0)
                      .arg(result.times.hull_ms, 0, 'f', 0)
                      .arg(result.times.contacts_ms, 0, 'f', 0)
                      .arg(response)
                      .arg(picture_ms_, 0, 'f', 0));
  skipped_->setText(
      tr("skipped: %1 of pixels, %2 of %3 silhouettes, %4 of %5 parts, %6 of triangles")
          .arg(PercentOf(result.skipped.segmentation.skipped_pixels, result.skipped.segmentation.pixels))
          .arg(result.skipped.hull.unchanged_silhouettes)
          .arg(result.record.masks->size())
          .arg(result.skipped.unchanged_parts)
          .arg(result.record.contacts.size())
          .arg(PercentOf(result.skipped.triangles_skipped, result.skipped.triangles_in_all)));
  skipped_->setToolTip(skipped_->text());
  // A field never shrinks: texts of changing length would move the other fields with every frame.
  for (QLabel* field : {frame_, recorded_, times_}) {
    field->setMinimumWidth(std::max(field->minimumWidth(), field->sizeHint().width()));
  }
  FitFields();
}

QSize StatusLine::minimumSizeHint() const { return {320, QStatusBar::minimumSizeHint().height()}; }

void StatusLine::resizeEvent(QResizeEvent* event) {
  QStatusBar::resizeEvent(event);
  FitFields();
}

void StatusLine::FitFields() {
  constexpr int kBesideFieldPx = 8;
  int room_px = width();
  for (const QWidget* widget : {static_cast<QWidget*>(progress_), guest_})
    if (widget != nullptr && widget->isVisible())
      room_px -= std::max(widget->width(), widget->sizeHint().width()) + kBesideFieldPx;
  for (QLabel* field : {frame_, session_, recorded_, age_, times_, skipped_, driver_}) {
    const int wanted_px = std::max(field->minimumWidth(), field->sizeHint().width()) + kBesideFieldPx;
    const bool fits = wanted_px <= room_px;
    if (fits) room_px -= wanted_px;
    if (field->isHidden() == fits) field->setVisible(fits);
  }
}

void StatusLine::AddGuest(QWidget* guest) {
  guest_ = guest;
  addPermanentWidget(guest);
}

void StatusLine::ShowPicture(double drawing_ms, const QString& driver) {
  picture_ms_ = drawing_ms;
  if (driver_->toolTip() == driver) return;
  driver_->setToolTip(driver);
  driver_->setText(ShortDriver(driver));
  FitFields();
}

void StatusLine::ShowAge(double age_ms) {
  ages_.Add(age_ms);
  age_->setText(tr("picture %1 ms old").arg(age_ms, 0, 'f', 0));
  age_->setMinimumWidth(std::max(age_->minimumWidth(), age_->sizeHint().width()));
  age_->setToolTip(tr("From the exposure to the screen, ms: median %1, and at most %2 in 95 of 100")
                       .arg(ages_.MedianMs().value_or(0.0), 0, 'f', 0)
                       .arg(ages_.QuantileMs(0.95).value_or(0.0), 0, 'f', 0));
  FitFields();
}

void StatusLine::SetProgressVisible(bool is_visible) {
  if (progress_->isHidden() != is_visible) return;
  progress_->setVisible(is_visible);
  FitFields();
}

void StatusLine::ShowProgress(qint64 done, qint64 total, const QString& what) {
  SetProgressVisible(total > 0);
  if (total <= 0) return;
  progress_->setRange(0, 1000);  // in thousandths: totals may exceed the range of a progress bar
  progress_->setValue(static_cast<int>(1000 * std::clamp<qint64>(done, 0, total) / total));
  const QString share = total <= kMostCounted ? tr("%1 of %2").arg(done).arg(total) : QString("%p %");
  progress_->setFormat(what + " " + share);
}

}  // namespace elbowroom::console
