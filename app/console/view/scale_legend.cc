#include "app/console/view/scale_legend.h"

#include <QCoreApplication>
#include <QFontMetrics>
#include <QStringList>
#include <algorithm>

#include "app/control/layers/hull_colors.h"
#include "app/control/palette/scale_color.h"

namespace elbowroom::console {
namespace {

constexpr int kWidthPx = 208;
constexpr int kPadPx = 8;
constexpr int kBarPx = 13;
constexpr std::size_t kMostBoxes = 8;  // of cameras; more are a scale
constexpr int kSmooth = 48;            // colours of a scale without steps
const QColor kInk(20, 24, 29);

class LegendWords {
  Q_DECLARE_TR_FUNCTIONS(elbowroom::console::LegendWords)
};

QColor ColorAt(double share) {
  const control::Color color = control::ScaleColor(share);
  return QColor::fromRgbF(color.x(), color.y(), color.z());
}

QString Number(double value) { return QLocale().toString(value, 'g', 3); }

ScaleLegend HeatLegend(const control::HeatLayer& heat, const QString& heat_of) {
  ScaleLegend legend{LegendWords::tr("Touched for, s"), {}, {}, heat_of};
  if (heat.parts.empty()) {
    legend.note = LegendWords::tr("nothing was touched: %1").arg(heat_of);
    return legend;
  }
  for (int shade = 1; shade <= control::kHeatShades; ++shade)
    legend.colours.push_back(ColorAt((shade - 0.5) / control::kHeatShades));
  legend.labels = {"0", Number(0.5 * heat.most_s), Number(heat.most_s)};
  return legend;
}

ScaleLegend CoverageLegend(const control::RigKnowledge& knowledge) {
  ScaleLegend legend{LegendWords::tr("Cameras that see the place"), {}, {}, {}};
  const std::size_t cameras = knowledge.rig.cameras.size();
  const auto share = [&](double seeing) { return 1.0 - seeing / static_cast<double>(cameras); };
  if (cameras <= kMostBoxes) {
    for (std::size_t seeing = 1; seeing <= cameras; ++seeing) {
      legend.colours.push_back(ColorAt(share(static_cast<double>(seeing))));
      legend.labels.push_back(QString::number(seeing));
    }
    return legend;
  }
  for (int i = 0; i <= kSmooth; ++i)
    legend.colours.push_back(ColorAt(share(1.0 + (static_cast<double>(cameras) - 1.0) * i / kSmooth)));
  legend.labels = {"1", QString::number(cameras)};
  return legend;
}

ScaleLegend UncertaintyLegend(const control::RigKnowledge& knowledge) {
  ScaleLegend legend{LegendWords::tr("Surface may be off by, mm"), {}, {}, {}};
  for (int i = 0; i <= kSmooth; ++i) legend.colours.push_back(ColorAt(static_cast<double>(i) / kSmooth));
  legend.labels = {"0", Number(0.5 * knowledge.most_mm),
                   LegendWords::tr("≥ %1").arg(Number(knowledge.most_mm))};
  if (knowledge.is_refuted) {
    legend.note = LegendWords::tr("2 sigma. The rig's gauge failed: it may be more");
  } else if (knowledge.has_covariance) {
    legend.note = LegendWords::tr("2 sigma, of calibration and pixels");
  } else {
    legend.note = LegendWords::tr("2 sigma, of pixels alone: the cameras are taken as exact");
  }
  return legend;
}

// Left, middle and right, or in the middle of each box.
void PaintLabels(QPainter& painter, const QRect& bar, const QStringList& labels, bool is_on_boxes) {
  const auto count = static_cast<int>(labels.size());
  const int height_px = painter.fontMetrics().height();
  for (int i = 0; i < count; ++i) {
    const double at = is_on_boxes ? (i + 0.5) / count : static_cast<double>(i) / std::max(count - 1, 1);
    const int width_px = painter.fontMetrics().horizontalAdvance(labels[i]) + 2;
    const int middle_px = bar.left() + static_cast<int>(at * bar.width());
    const int left_px =
        std::clamp(middle_px - width_px / 2, bar.left(), std::max(bar.left(), bar.right() - width_px));
    painter.drawText(QRect(left_px, bar.bottom() + 2, width_px, height_px), Qt::AlignCenter, labels[i]);
  }
}

// Its height, px; painted only if `paints`.
int PaintOne(QPainter& painter, const QPoint& corner, const ScaleLegend& legend, bool paints) {
  const QFontMetrics metrics = painter.fontMetrics();
  const QRect inside(corner + QPoint(kPadPx, kPadPx), QSize(kWidthPx - 2 * kPadPx, 10'000));
  const int wraps = Qt::AlignLeft | Qt::TextWordWrap;
  int y = inside.top();
  const auto write = [&](const QString& text) {
    const QRect needed = metrics.boundingRect(QRect(inside.left(), y, inside.width(), 1000), wraps, text);
    if (paints) painter.drawText(QRect(inside.left(), y, inside.width(), needed.height()), wraps, text);
    y += needed.height();
  };
  write(legend.title);
  if (!legend.colours.empty()) {
    const QRect bar(inside.left(), y + 3, inside.width(), kBarPx);
    if (paints) {
      const auto count = static_cast<int>(legend.colours.size());
      for (int i = 0; i < count; ++i) {
        const int left = bar.width() * i / count, right = bar.width() * (i + 1) / count;
        painter.fillRect(QRect(bar.left() + left, bar.top(), right - left, bar.height()),
                         legend.colours[static_cast<std::size_t>(i)]);
      }
      PaintLabels(painter, bar, legend.labels, legend.labels.size() == count);
    }
    y = bar.bottom() + 2 + metrics.height();
  }
  if (!legend.note.isEmpty()) write(legend.note);
  return y + kPadPx - corner.y();
}

}  // namespace

std::vector<ScaleLegend> LegendsOf(const control::SceneLook& look, const QString& heat_of) {
  std::vector<ScaleLegend> legends;
  if (look.heat != nullptr) legends.push_back(HeatLegend(*look.heat, heat_of));
  if (look.knowledge == nullptr || !control::ShowsKnowledge(look.hull)) return legends;
  legends.push_back(look.hull == recon::HullAppearance::kCoverage ? CoverageLegend(*look.knowledge)
                                                                  : UncertaintyLegend(*look.knowledge));
  return legends;
}

QString TextOf(std::span<const ScaleLegend> legends) {
  QStringList lines;
  for (const ScaleLegend& legend : legends) {
    QString line = legend.title;
    if (!legend.labels.isEmpty())
      line += LegendWords::tr(", from %1 to %2").arg(legend.labels.front(), legend.labels.back());
    if (!legend.note.isEmpty()) line += "; " + legend.note;
    lines.push_back(line);
  }
  return lines.join(". ");
}

void PaintLegends(QPainter& painter, const QRect& room, std::span<const ScaleLegend> legends) {
  constexpr int kApartPx = 10;
  painter.save();
  QPoint corner(std::max(room.left(), room.right() - kWidthPx - kApartPx), room.top() + kApartPx);
  for (const ScaleLegend& legend : legends) {
    const int height_px = PaintOne(painter, corner, legend, false);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(255, 255, 255, 225));  // on the picture, which is light whatever the theme is
    painter.drawRoundedRect(QRect(corner, QSize(kWidthPx, height_px)), 4, 4);
    painter.setPen(kInk);
    (void)PaintOne(painter, corner, legend, true);
    corner.ry() += height_px + kApartPx / 2;
  }
  painter.restore();
}

}  // namespace elbowroom::console
