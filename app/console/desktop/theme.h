// The window's colours, light and dark.
#pragma once

#include <QColor>
#include <QIcon>
#include <QString>
#include <array>

namespace elbowroom::console {

enum class Theme { kSystem, kLight, kDark };
inline constexpr std::array kThemes = {Theme::kSystem, Theme::kLight, Theme::kDark};

// The few colours beside those of Qt's palette. Words or signs always say the same.
struct Colors {
  QColor view_background;
  QColor picture_text;  // on the operator's picture, which is light in any theme
  QColor quiet_text;
  QColor contact;
  QColor contact_tint;  // behind it
  QColor clear;
  QColor clear_tint;
  QColor attention;
  QColor silhouette_object;
  QColor silhouette_background;
};

// Of the theme in force. Thread: UI.
[[nodiscard]] const Colors& ThemeColors();

// Gives all windows the theme; kSystem: dark where the desktop was dark when the program began. Thread: UI.
void SetTheme(Theme theme);
[[nodiscard]] Theme CurrentTheme();

// A picture of one colour, in that of the theme's text.
[[nodiscard]] QIcon InTextColor(const QIcon& icon);

// Over the program's runs.
[[nodiscard]] Theme RememberedTheme();
void RememberTheme(Theme theme);

[[nodiscard]] QString KeyOf(Theme theme);           // "system", "light", "dark": in the settings
[[nodiscard]] Theme ThemeFrom(const QString& key);  // kSystem for any other text

}  // namespace elbowroom::console
