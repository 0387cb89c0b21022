#include "app/console/reviews/session_facts.h"

#include <QDateTime>
#include <QLocale>
#include <QObject>
#include <QStringList>
#include <algorithm>

namespace elbowroom::console {
namespace {

QString StartOf(const core::SessionHeader& header) {
  const QDateTime at = QDateTime::fromString(QString::fromStdString(header.started_at_utc), Qt::ISODate);
  return at.isValid() ? QLocale().toString(at.toLocalTime(), QLocale::ShortFormat)
                      : QString::fromStdString(header.started_at_utc);
}

}  // namespace

QString TitleOf(const control::ReviewedSession& session) {
  const QString file = QString::fromStdString(session.path().filename().string());
  const QString task = QString::fromStdString(session.header().trial.task);
  return task.isEmpty() ? file : QString("%1 – %2").arg(file, task);
}

QString FactsOf(const control::ReviewedSession& session) {
  const core::SessionHeader& header = session.header();
  QStringList facts;
  if (!header.trial.participant.empty()) facts << QString::fromStdString(header.trial.participant);
  facts << StartOf(header);
  const double seconds = session.frames().back().time_s - session.frames().front().time_s;
  facts << QObject::tr("%1 frames, %2 s").arg(session.frames().size()).arg(seconds, 0, 'f', 1);
  facts << QObject::tr("%1 cameras").arg(header.rig.cameras.size());
  if (header.trial.required_clearance_mm > 0.0)
    facts << QObject::tr("%1 mm clearance required").arg(header.trial.required_clearance_mm, 0, 'g', 5);
  if (session.status() == sessions::SessionStatus::kCutOff) facts << QObject::tr("cut off");
  if (session.status() == sessions::SessionStatus::kRecording) facts << QObject::tr("being recorded");
  if (header.origin) facts << QObject::tr("a replay");
  return facts.join(", ");
}

}  // namespace elbowroom::console
