#include "tests/app/console/user_actions.h"

#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QCompleter>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QStyle>
#include <QTimer>
#include <functional>

namespace elbowroom::console {
namespace {

constexpr int kLookAgainMs = 100;

// Calls `act` with the file dialog that is shown, once there is one.
void OnceAsked(const std::function<void(QFileDialog*)>& act) {
  auto* timer = new QTimer(qApp);
  QObject::connect(timer, &QTimer::timeout, timer, [timer, act] {
    for (QWidget* widget : QApplication::topLevelWidgets()) {
      auto* dialog = qobject_cast<QFileDialog*>(widget);
      if (dialog == nullptr || dialog->isHidden()) continue;
      timer->stop();
      timer->deleteLater();
      return act(dialog);
    }
  });
  timer->start(kLookAgainMs);
}

}  // namespace

void TypeIntoNextFileDialog(const QString& path) {
  OnceAsked([path](QFileDialog* dialog) {
    auto* line = dialog->findChild<QLineEdit*>("fileNameEdit");
    TypeInto(line, path);
    // The list of completions may still come and take a click: it is closed, and the button clicked again.
    auto* again = new QTimer(dialog);
    QObject::connect(again, &QTimer::timeout, dialog, [dialog, line, path] {
      if (auto* refusal = qobject_cast<QMessageBox*>(QApplication::activeModalWidget()))
        return refusal->reject();
      if (line->completer() != nullptr) line->completer()->popup()->hide();
      // A key that the list of completions took isn't in the name.
      if (line->text() != path) return TypeInto(line, path);
      const auto* buttons = dialog->findChild<QDialogButtonBox*>();
      for (QAbstractButton* button : buttons->buttons())
        if (buttons->buttonRole(button) == QDialogButtonBox::AcceptRole && button->isEnabled())
          return Click(button);
    });
    again->start(kLookAgainMs);
  });
}

void Click(QWidget* widget) { QTest::mouseClick(widget, Qt::LeftButton); }

void TypeInto(QWidget* widget, const QString& text) {
  // A desktop gives the window back its focus when a dialog closes; Qt's offscreen platform doesn't.
  widget->window()->activateWindow();
  (void)QTest::qWaitForWindowActive(widget->window());
  widget->setFocus();
  QTest::keyClick(widget, Qt::Key_A, Qt::ControlModifier);
  QTest::keyClicks(widget, text);
  if (qobject_cast<QAbstractSpinBox*>(widget) != nullptr) QTest::keyClick(widget, Qt::Key_Tab);
}

bool TickItem(QTreeWidget* tree, const QString& text) {
  const QList<QTreeWidgetItem*> found = tree->findItems(text, Qt::MatchExactly | Qt::MatchRecursive, 0);
  if (found.isEmpty()) return false;
  tree->scrollToItem(found.front());
  const QRect item = tree->visualItemRect(found.front());  // without what it is indented by
  const int middle = tree->style()->pixelMetric(QStyle::PM_FocusFrameHMargin, nullptr, tree) + 1 +
                     tree->style()->pixelMetric(QStyle::PM_IndicatorWidth, nullptr, tree) / 2;
  QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, QPoint(item.left() + middle, item.center().y()));
  return true;
}

}  // namespace elbowroom::console
