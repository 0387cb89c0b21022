#include "app/console/tile_text.h"

#include <QLocale>
#include <QObject>
#include <QStringList>
#include <cmath>

namespace elbowroom::console {
namespace {

QString LightText(const recon::LightReport& light) {
  QString text = QObject::tr("light %1 %").arg(100.0 * light.gain, 0, 'f', 0);
  if (light.pulse && light.pulse->matters)
    text += QObject::tr(", flicker %1 %").arg(100.0 * light.pulse->amplitude_share, 0, 'f', 0);
  return text;
}

QString TroubleOf(const control::CameraTile& tile) {
  if (!tile.gone.empty()) return QObject::tr("gone: %1").arg(QString::fromStdString(tile.gone));
  return tile.is_missing ? QObject::tr("no picture") : QString();
}

}  // namespace

TileText TextOf(const control::CameraTile& tile) {
  const control::CameraFigures& figures = tile.figures;
  TileText text;
  const QString size_px = QLocale().toString(static_cast<qlonglong>(tile.object_px)) + " px";
  text.rate = figures.rate_hz ? QObject::tr("%1 Hz").arg(*figures.rate_hz, 0, 'f', 1) : size_px;
  if (figures.lost) text.lost = QObject::tr("lost %1").arg(*figures.lost);
  if (figures.skew_ms) {
    constexpr double kTenths = 10.0;
    const double shown_ms = std::round(*figures.skew_ms * kTenths) / kTenths + 0.0;  // no "-0.0"
    text.skew = QObject::tr("skew %1%2 ms").arg(shown_ms > 0.0 ? "+" : "").arg(shown_ms, 0, 'f', 1);
  }
  if (figures.light) text.light = LightText(*figures.light);
  text.trouble = TroubleOf(tile);
  QStringList tip = {QString::fromStdString(tile.name), QObject::tr("object: %1").arg(size_px)};
  if (!text.trouble.isEmpty()) tip << text.trouble;
  if (figures.light && !figures.light->advice.empty()) {
    text.advice = QObject::tr("▲ advice");
    for (const std::string& line : figures.light->advice) tip << "▲ " + QString::fromStdString(line);
  }
  text.tool_tip = tip.join('\n');
  return text;
}

}  // namespace elbowroom::console
