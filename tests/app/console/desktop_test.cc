// What the window takes from its user's desktop, and what it keeps for the next run.
#include <gtest/gtest.h>

#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QAccessible>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QMimeData>
#include <QScrollArea>
#include <QSettings>
#include <QShortcut>
#include <QTabBar>
#include <QTest>
#include <QToolBar>
#include <QWidgetAction>
#include <algorithm>
#include <cmath>
#include <map>

#include "app/console/desktop/recent_trials.h"
#include "app/console/desktop/session_place.h"
#include "app/console/desktop/theme.h"
#include "app/console/main_window.h"
#include "app/console/trial_actions.h"
#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

using test_support::TemporaryFolder;

constexpr int kLongMs = 120'000;  // far beyond what reading a trial takes

class Desktop : public testing::Test {
 protected:
  Desktop() { QSettings().clear(); }
  TemporaryFolder folder_;
};

TEST_F(Desktop, SessionsGetADatedNameInAFolderOfTheirOwn) {
  SetSessionsFolder(folder_ / "new" / "sessions");
  SessionPlace place(folder_ / "given.db");
  EXPECT_EQ(place.Next(), folder_ / "given.db");
  std::vector<std::filesystem::path> paths;
  for (int i = 0; i < 3; ++i) {  // within a second or two
    paths.push_back(place.Next());
    EXPECT_EQ(paths.back().parent_path(), folder_ / "new" / "sessions");
    EXPECT_TRUE(paths.back().filename().string().starts_with("elbowroom-2"));
    EXPECT_EQ(paths.back().extension(), ".db");
    EXPECT_FALSE(std::filesystem::exists(paths.back()));
    test_support::WriteText(paths.back(), "a session");
  }
}

TEST_F(Desktop, AFolderThatCannotBeIsOneLine) {
  test_support::WriteText(folder_ / "file", "");
  SetSessionsFolder(folder_ / "file" / "sessions");
  SessionPlace place({});
  try {
    (void)place.Next();
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::ErrorKind::kFile);
    EXPECT_NE(std::string(error.what()).find((folder_ / "file").string()), std::string::npos);
  }
}

TEST_F(Desktop, TheTrialsOpenedLastAreKnown) {
  const auto file = [&](int i) { return folder_ / ("trial" + std::to_string(i) + ".toml"); };
  for (int i = 0; i < 12; ++i) {
    test_support::WriteText(file(i), "");
    RememberTrial(QString::fromStdString(file(i).string()));
  }
  RememberTrial(QString::fromStdString(file(6).string()));
  ASSERT_EQ(RecentTrials().size(), kMostRecentTrials);
  EXPECT_EQ(RecentTrials()[0].toStdString(), file(6).string());
  EXPECT_EQ(RecentTrials()[1].toStdString(), file(11).string());
  EXPECT_EQ(RecentTrials().count(RecentTrials()[0]), 1);
  std::filesystem::remove(file(11));
  EXPECT_EQ(RecentTrials()[1].toStdString(), file(10).string());
  RecentTrialsMenu menu;
  emit menu.aboutToShow();
  EXPECT_EQ(menu.actions().size(), RecentTrials().size());
}

// WCAG 2.1, "relative luminance" and "contrast ratio".
double Luminance(const QColor& color) {
  const auto linear = [](double c) { return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
}
double Contrast(const QColor& a, const QColor& b) {
  const auto [low, high] = std::minmax({Luminance(a), Luminance(b)});
  return (high + 0.05) / (low + 0.05);
}

TEST_F(Desktop, TextIsLegibleInBothThemes) {
  constexpr double kLeast = 4.5;  // WCAG's AA
  for (const Theme theme : {Theme::kLight, Theme::kDark}) {
    SetTheme(theme);
    SCOPED_TRACE(KeyOf(theme).toStdString());
    const QPalette palette = QApplication::palette();
    const Colors& colors = ThemeColors();
    for (const QColor& ground : {palette.color(QPalette::Base), palette.color(QPalette::Window)}) {
      for (const QColor& ink : {palette.color(QPalette::Text), palette.color(QPalette::WindowText),
                                palette.color(QPalette::PlaceholderText), colors.quiet_text, colors.contact,
                                colors.clear, colors.attention})
        EXPECT_GE(Contrast(ink, ground), kLeast)
            << ink.name().toStdString() << " on " << ground.name().toStdString();
    }
    EXPECT_GE(Contrast(colors.contact, colors.contact_tint), kLeast);
    EXPECT_GE(Contrast(palette.color(QPalette::Text), colors.contact_tint), kLeast);
    EXPECT_GE(Contrast(colors.clear, colors.clear_tint), kLeast);
    EXPECT_GE(Contrast(palette.color(QPalette::ButtonText), palette.color(QPalette::Button)), kLeast);
  }
  SetTheme(Theme::kLight);
}

TEST_F(Desktop, AThemeIsChosenFromTheMenuAndRemembered) {
  SetTheme(Theme::kLight);
  MainWindow window;
  const QColor light = QApplication::palette().color(QPalette::Window);
  window.findChild<QAction*>("theme:dark")->trigger();
  EXPECT_LT(QApplication::palette().color(QPalette::Window).lightness(), light.lightness());
  EXPECT_EQ(RememberedTheme(), Theme::kDark);
  window.findChild<QAction*>("theme:light")->trigger();
  EXPECT_EQ(QApplication::palette().color(QPalette::Window), light);
  QSettings().setValue("window/theme", "plaid");
  EXPECT_EQ(RememberedTheme(), Theme::kSystem);
}

TEST_F(Desktop, SizeAndPanelsAreThereTheNextTime) {
  QSize size;
  {
    MainWindow window;
    window.Remember();
    window.show();
    window.findChild<QDockWidget*>("contacts_panel")->hide();
    window.resize(700, 520);
    QTest::qWait(50);
    size = window.size();
    window.close();
  }
  MainWindow window;
  window.Remember();
  window.show();
  QTest::qWait(50);
  EXPECT_EQ(window.size(), size);
  EXPECT_FALSE(window.findChild<QDockWidget*>("contacts_panel")->isVisible());
  EXPECT_TRUE(window.findChild<QDockWidget*>("touches_panel")->isVisible());
}

TEST_F(Desktop, NothingRememberedOrNonsenseGivesAWindowThatFitsTheScreen) {
  for (const char* kept : {"", "nonsense"}) {
    QSettings().setValue("window/geometry", QByteArray(kept));
    QSettings().setValue("window/panels", QByteArray(kept));
    MainWindow window;
    window.Remember();
    window.show();
    const QSize room = window.screen()->availableGeometry().size();
    EXPECT_LE(window.width(), room.width());
    EXPECT_LE(window.height(), room.height());
    EXPECT_TRUE(window.findChild<QDockWidget*>("contacts_panel")->isVisible());
  }
}

void Drop(QWidget* on, const QList<QUrl>& urls, bool* is_taken) {
  QMimeData data;
  data.setUrls(urls);
  QDragEnterEvent enter(QPoint(10, 10), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  enter.ignore();
  QApplication::sendEvent(on, &enter);
  *is_taken = enter.isAccepted();
  if (!enter.isAccepted()) return;
  QDropEvent drop(QPointF(10, 10), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(on, &drop);
}

TEST_F(Desktop, ATrialThatIsDroppedIsOpened) {
  SetSessionsFolder(folder_ / "sessions");
  MainWindow window;
  window.show();
  bool is_taken = true;
  Drop(&window, {QUrl::fromLocalFile("/nowhere/picture.png")}, &is_taken);
  EXPECT_FALSE(is_taken);
  const std::filesystem::path trial = folder_ / "Trial.TOML";
  test_support::WriteText(trial, "rig = ");
  Drop(&window, {QUrl::fromLocalFile(QString::fromStdString(trial.string()))}, &is_taken);
  EXPECT_TRUE(is_taken);
  EXPECT_EQ(window.desk().state(), DeskState::kReading);
  ASSERT_TRUE(QTest::qWaitFor([&] { return window.desk().state() == DeskState::kIdle; }, kLongMs));
  EXPECT_EQ(RecentTrials().value(0).toStdString(), trial.string());
}

// What a person who can't see the window hears of the control: its own text or name, or its label's.
QString SpokenName(QWidget* control) {
  const QAccessibleInterface* spoken = QAccessible::queryAccessibleInterface(control);
  return spoken == nullptr ? QString() : spoken->text(QAccessible::Name);
}

// Not those that are part of another control, such as a spin box's line.
bool IsControl(const QWidget* widget) {
  if (widget->focusPolicy() == Qt::NoFocus || widget->objectName().startsWith("qt_")) return false;
  if (qobject_cast<const QTabBar*>(widget) || widget->inherits("QComboBoxListView"))
    return false;  // whose tabs and lines are spoken
  const QWidget* parent = widget->parentWidget();
  return !qobject_cast<const QAbstractSpinBox*>(parent) && !qobject_cast<const QComboBox*>(parent) &&
         !qobject_cast<const QAbstractItemView*>(parent) && !qobject_cast<const QScrollArea*>(widget);
}

TEST_F(Desktop, EveryControlHasASpokenNameAndEveryActionATip) {
  SetSessionsFolder(folder_ / "sessions");
  MainWindow window;
  window.show();
  StartDemo(window.desk(), window.session_place());
  ASSERT_TRUE(QTest::qWaitFor([&] { return window.desk().state() == DeskState::kRunning; }, kLongMs));
  QTest::qWait(200);
  for (QWidget* widget : window.findChildren<QWidget*>()) {
    if (!IsControl(widget)) continue;
    EXPECT_FALSE(SpokenName(widget).isEmpty())
        << widget->metaObject()->className() << " '" << widget->objectName().toStdString() << "' of '"
        << widget->parentWidget()->objectName().toStdString() << "'";
  }
  for (const QToolBar* bar : window.findChildren<QToolBar*>()) {
    for (const QAction* action : bar->actions()) {
      const bool is_button = !action->isSeparator() && qobject_cast<const QWidgetAction*>(action) == nullptr;
      EXPECT_TRUE(!is_button || action->toolTip().size() > action->iconText().size())
          << action->text().toStdString();
    }
  }
  window.desk().Stop();
  ASSERT_TRUE(QTest::qWaitFor([&] { return window.desk().state() == DeskState::kIdle; }, kLongMs));
}

// Two that share a key in the whole window: Qt then does neither.
TEST_F(Desktop, NoKeyStandsForTwoThings) {
  MainWindow window;
  std::map<QString, QStringList> whose;
  const auto add = [&](const QKeySequence& key, Qt::ShortcutContext context, const QString& name) {
    const bool is_everywhere = context == Qt::WindowShortcut || context == Qt::ApplicationShortcut;
    if (!key.isEmpty() && is_everywhere) whose[key.toString()].append(name);
  };
  for (const QAction* action : window.findChildren<QAction*>())
    for (const QKeySequence& key : action->shortcuts()) add(key, action->shortcutContext(), action->text());
  for (const QShortcut* shortcut : window.findChildren<QShortcut*>())
    add(shortcut->key(), shortcut->context(), shortcut->parent()->objectName());
  EXPECT_GT(whose.size(), 20U);
  for (const auto& [key, names] : whose)
    EXPECT_EQ(names.size(), 1) << key.toStdString() << ": " << names.join(", ").toStdString();
}

}  // namespace
}  // namespace elbowroom::console
