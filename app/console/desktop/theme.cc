#include "app/console/desktop/theme.h"

#include <QApplication>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QSettings>
#include <QStyleFactory>
#include <QStyleOption>
#include <algorithm>

namespace elbowroom::console {
namespace {

constexpr const char* kThemeKey = "window/theme";

constexpr Colors kLightColors = {
    .view_background = {0xdf, 0xe4, 0xea},
    .picture_text = {0x5b, 0x66, 0x73},
    .quiet_text = {0x5b, 0x66, 0x73},
    .contact = {0xb4, 0x2f, 0x16},
    .contact_tint = {0xfc, 0xe9, 0xe4},
    .clear = {0x2c, 0x7a, 0x45},
    .clear_tint = {0xe6, 0xf1, 0xe9},
    .attention = {0x8a, 0x5a, 0x00},
    .silhouette_object = {0xf4, 0xf6, 0xf8},
    .silhouette_background = {0x24, 0x2b, 0x33},
};
constexpr Colors kDarkColors = {
    .view_background = {0x22, 0x28, 0x2f},
    .picture_text = {0x5b, 0x66, 0x73},
    .quiet_text = {0x9d, 0xa8, 0xb3},
    .contact = {0xff, 0x8f, 0x76},
    .contact_tint = {0x4a, 0x26, 0x1e},
    .clear = {0x86, 0xd3, 0x9d},
    .clear_tint = {0x1f, 0x3a, 0x28},
    .attention = {0xe9, 0xb9, 0x5c},
    .silhouette_object = {0xf4, 0xf6, 0xf8},
    .silhouette_background = {0x14, 0x19, 0x1e},
};

struct State {
  Theme theme = Theme::kSystem;
  bool is_dark = false;
};
State& Current() {
  static State state;
  return state;
}

bool IsDark(const QPalette& palette) { return palette.color(QPalette::Window).lightness() < 128; }

QPalette LightPalette() {
  QPalette palette(QColor(0xf2, 0xf4, 0xf6));
  palette.setColor(QPalette::Base, Qt::white);
  palette.setColor(QPalette::AlternateBase, QColor(0xf7, 0xf8, 0xfa));
  palette.setColor(QPalette::Highlight, QColor(0x2f, 0x6f, 0xb3));
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::PlaceholderText, kLightColors.quiet_text);
  return palette;
}

QPalette DarkPalette() {
  QPalette palette(QColor(0x3f, 0x48, 0x52), QColor(0x2b, 0x32, 0x3a));  // buttons, windows
  palette.setColor(QPalette::Base, QColor(0x1e, 0x24, 0x2a));
  palette.setColor(QPalette::AlternateBase, QColor(0x24, 0x2a, 0x31));
  palette.setColor(QPalette::ToolTipBase, QColor(0x2f, 0x36, 0x3e));
  for (const QPalette::ColorRole role :
       {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::ToolTipText}) {
    palette.setColor(role, QColor(0xe4, 0xe8, 0xec));
    palette.setColor(QPalette::Disabled, role, QColor(0x90, 0x9a, 0xa4));
  }
  palette.setColor(QPalette::Highlight, QColor(0x3d, 0x82, 0xc8));
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::PlaceholderText, kDarkColors.quiet_text);
  palette.setColor(QPalette::Link, QColor(0x7f, 0xb6, 0xf0));
  return palette;
}

// Fusion, whose check boxes and radio buttons have an edge that is seen on a dark ground, too: its own is
// darker than the window.
class LegibleStyle : public QProxyStyle {
 public:
  LegibleStyle() : QProxyStyle(QStyleFactory::create("Fusion")) {}
  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
    QProxyStyle::drawPrimitive(element, option, painter, widget);
    const bool is_box = element == PE_IndicatorCheckBox || element == PE_IndicatorItemViewItemCheck;
    const bool is_round = element == PE_IndicatorRadioButton;
    if ((!is_box && !is_round) || !Current().is_dark) return;
    painter->save();
    painter->setPen(option->palette.color(QPalette::PlaceholderText));
    painter->setBrush(Qt::NoBrush);
    painter->setRenderHint(QPainter::Antialiasing, is_round);
    if (is_round) {
      painter->drawEllipse(QRectF(option->rect).adjusted(0.5, 0.5, -0.5, -0.5));
    } else {
      painter->drawRect(option->rect.adjusted(0, 0, -1, -1));
    }
    painter->restore();
  }
};

}  // namespace

const Colors& ThemeColors() { return Current().is_dark ? kDarkColors : kLightColors; }

void SetTheme(Theme theme) {
  static const bool was_dark = IsDark(QApplication::palette());  // before this program gave it another
  State& state = Current();
  state = {theme, theme == Theme::kDark || (theme == Theme::kSystem && was_dark)};
  QApplication::setStyle(new LegibleStyle);
  QApplication::setPalette(state.is_dark ? DarkPalette() : LightPalette());
}

QIcon InTextColor(const QIcon& icon) {
  QPixmap shape = icon.pixmap(QSize(64, 64));
  QPainter painter(&shape);
  painter.setCompositionMode(QPainter::CompositionMode_SourceIn);
  painter.fillRect(shape.rect(), QApplication::palette().color(QPalette::ButtonText));
  painter.end();
  return QIcon(shape);
}

Theme CurrentTheme() { return Current().theme; }

Theme RememberedTheme() { return ThemeFrom(QSettings().value(kThemeKey).toString()); }
void RememberTheme(Theme theme) { QSettings().setValue(kThemeKey, KeyOf(theme)); }

QString KeyOf(Theme theme) {
  switch (theme) {
    case Theme::kSystem:
      break;
    case Theme::kLight:
      return "light";
    case Theme::kDark:
      return "dark";
  }
  return "system";
}

Theme ThemeFrom(const QString& key) {
  const auto* found = std::ranges::find(kThemes, key, &KeyOf);
  return found == kThemes.end() ? Theme::kSystem : *found;
}

}  // namespace elbowroom::console
