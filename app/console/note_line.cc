#include "app/console/note_line.h"

#include <QKeyEvent>

namespace elbowroom::console {
namespace {

constexpr int kLongestNote = 500;

}  // namespace

NoteLine::NoteLine(QWidget* parent) : QLineEdit(parent) {
  setMaxLength(kLongestNote);
  setClearButtonEnabled(true);
  setPlaceholderText(tr("Note (Ctrl+N), then Enter"));
  setAccessibleName(tr("Note"));
  setToolTip(tr("The session records it with the frame that comes next; the report's events list it"));
}

void NoteLine::keyPressEvent(QKeyEvent* event) {
  const bool is_enter = event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter;
  if (!is_enter && event->key() != Qt::Key_Escape) return QLineEdit::keyPressEvent(event);
  const QString note = text().trimmed();
  clear();
  if (is_enter && !note.isEmpty()) emit Written(note);
  if (parentWidget() != nullptr) parentWidget()->setFocus();  // the keys move the gap again
}

}  // namespace elbowroom::console
