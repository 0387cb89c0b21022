#include "tests/app/console/layouts/user_actions.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QFileDialog>
#include <QLineEdit>
#include <QStyle>
#include <QStyleOptionViewItem>
#include <QTimer>
#include <functional>

namespace elbowroom::console {
namespace {

constexpr int kLookAgainMs = 30;

// Calls `act` with the modal widget of that kind, once there is one.
template <typename Widget>
void OnceModal(const std::function<void(Widget*)>& act) {
  auto* timer = new QTimer(qApp);
  QObject::connect(timer, &QTimer::timeout, timer, [timer, act] {
    auto* widget = qobject_cast<Widget*>(QApplication::activeModalWidget());
    if (widget == nullptr) return;
    timer->stop();
    timer->deleteLater();
    act(widget);
  });
  timer->start(kLookAgainMs);
}

}  // namespace

void TypeIntoNextFileDialog(const QString& path) {
  OnceModal<QFileDialog>([path](QFileDialog* dialog) {
    auto* line = dialog->findChild<QLineEdit*>("fileNameEdit");
    TypeInto(line, path);
    QTest::keyClick(line, Qt::Key_Return);
  });
}

void AnswerNextQuestion(QMessageBox::StandardButton button) {
  OnceModal<QMessageBox>([button](QMessageBox* box) { Click(box->button(button)); });
}

void Click(QWidget* widget) { QTest::mouseClick(widget, Qt::LeftButton); }

void TypeInto(QWidget* widget, const QString& text) {
  widget->setFocus();
  QTest::keyClick(widget, Qt::Key_A, Qt::ControlModifier);
  QTest::keyClicks(widget, text);
  if (qobject_cast<QAbstractSpinBox*>(widget) != nullptr) QTest::keyClick(widget, Qt::Key_Tab);
}

bool TickItem(QTreeWidget* tree, const QString& text) {
  const QList<QTreeWidgetItem*> found = tree->findItems(text, Qt::MatchExactly | Qt::MatchRecursive, 0);
  if (found.isEmpty()) return false;
  tree->scrollToItem(found.front());
  QStyleOptionViewItem option;
  option.initFrom(tree);
  option.rect = tree->visualItemRect(found.front());
  option.rect.setLeft(tree->visualRect(tree->indexAt(option.rect.center())).left());
  option.rect.setRight(tree->columnViewportPosition(0) + tree->columnWidth(0));
  option.features = QStyleOptionViewItem::HasCheckIndicator;
  const QRect tick = tree->style()->subElementRect(QStyle::SE_ItemViewItemCheckIndicator, &option, tree);
  QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, tick.center());
  return true;
}

}  // namespace elbowroom::console
