// What a user does with dialogs, done by mouse and keys.
#pragma once

#include <QCheckBox>
#include <QPushButton>
#include <QString>
#include <QTest>
#include <QTreeWidget>
#include <QWidget>

namespace elbowroom::console {

// Far beyond what any step takes on a loaded machine; a test that waits so long has failed. Under
// ThreadSanitizer, on one slow core, a task of 16 s takes five minutes.
#ifdef __SANITIZE_THREAD__
inline constexpr int kPatienceMs = 1'200'000;
#else
inline constexpr int kPatienceMs = 240'000;
#endif

template <typename Condition>
[[nodiscard]] bool WaitUntil(Condition condition) {
  return QTest::qWaitFor(condition, kPatienceMs);
}

// Types the path into the file dialog that comes next, and clicks on its button.
void TypeIntoNextFileDialog(const QString& path);

void Click(QWidget* widget);

// Takes the place of the text that is in a line, a number or another widget that is typed into.
void TypeInto(QWidget* widget, const QString& text);

// Puts the tick before the item of that text with the mouse. False: there is no such item.
bool TickItem(QTreeWidget* tree, const QString& text);

}  // namespace elbowroom::console
