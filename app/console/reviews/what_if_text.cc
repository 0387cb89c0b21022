#include "app/console/reviews/what_if_text.h"

#include <QObject>
#include <QStringList>
#include <algorithm>
#include <cmath>

namespace elbowroom::console {
namespace {

QString Millimetres(double value_mm) { return QString::number(value_mm, 'g', 5); }

// One decimal, towards the safe side.
QString AtLeast(double value_mm) { return QString::number(std::floor(10.0 * value_mm) / 10.0, 'f', 1); }
QString AtMost(double value_mm) { return QString::number(std::ceil(10.0 * value_mm) / 10.0, 'f', 1); }

}  // namespace

QString GapsText(const control::HeldGaps& held_mm) {
  QStringList gaps;
  for (const auto& [name, value_mm] : held_mm)
    gaps << QObject::tr("%1 %2 mm").arg(QString::fromStdString(name), Millimetres(value_mm));
  return gaps.join(", ");
}

QString WhatIfText(const control::WhatIf& what_if, const core::SessionHeader& header) {
  const auto touches = static_cast<int>(what_if.outcome.episodes.size());
  QString text = QObject::tr("At %1: %2")
                     .arg(GapsText(what_if.held_mm),
                          touches == 1 ? QObject::tr("1 touch") : QObject::tr("%1 touches").arg(touches));
  if (what_if.DeepestMm() > 0.0) text += QObject::tr(", deepest ≥ %1 mm").arg(AtLeast(what_if.DeepestMm()));
  const auto clearance_mm = what_if.ClearanceMm();
  if (touches == 0 && clearance_mm && std::isfinite(*clearance_mm))
    text += QObject::tr(", clearance ≥ %1 mm").arg(AtLeast(*clearance_mm));
  if (header.trial.required_clearance_mm > 0.0)
    text += QObject::tr(" (%1 mm clearance required)").arg(Millimetres(header.trial.required_clearance_mm));
  return text;
}

QString SkippedText(const control::WhatIf& what_if) {
  const auto kept = std::ranges::count(what_if.parts, false, &control::WhatIfPart::is_moved);
  QString text = QObject::tr("%1 frames judged in %2 s").arg(what_if.frames).arg(what_if.time_s, 0, 'f', 1);
  if (kept > 0)
    text += QObject::tr("; %1 of %2 parts stay, and keep their verdicts").arg(kept).arg(what_if.parts.size());
  return text;
}

QString NeededText(const QString& spacing, const control::NeededGap& needed, double required_clearance_mm) {
  QStringList parts;
  if (needed.touched_mm) parts << QObject::tr("touched at %1 mm").arg(AtLeast(*needed.touched_mm));
  parts << (needed.free_mm ? QObject::tr("free of touches from %1 mm on").arg(AtMost(*needed.free_mm))
                           : QObject::tr("touched at the largest gap, too"));
  if (needed.clear_mm)
    parts << QObject::tr("%1 mm clearance from %2 mm on")
                 .arg(Millimetres(required_clearance_mm), AtMost(*needed.clear_mm));
  return QObject::tr("Needed %1: %2").arg(spacing, parts.join(", "));
}

}  // namespace elbowroom::console
