#include "app/console/view/message_bar.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QStyle>
#include <QToolButton>

#include "app/console/desktop/theme.h"

namespace elbowroom::console {

MessageBar::MessageBar(QWidget* parent) : QFrame(parent), text_(new QLabel) {
  text_->setObjectName("message");
  text_->setAccessibleName(tr("Note"));
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* close = new QToolButton;
  close->setObjectName("close_message");
  close->setAutoRaise(true);
  close->setAccessibleName(tr("Close this message"));
  close->setToolTip(tr("Close this message"));
  connect(close, &QToolButton::clicked, this, &QWidget::hide);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(10, 4, 4, 4);
  row->addWidget(text_, 1);
  row->addWidget(close);
  hide();
}

void MessageBar::ShowError(const QString& line) { ShowLine(line, true); }

void MessageBar::ShowNote(const QString& line) { ShowLine(line, false); }

void MessageBar::ShowLine(const QString& line, bool is_error) {
  is_error_ = is_error;
  TakeColors();
  text_->setText(line);
  text_->setAccessibleName(is_error ? tr("Error") : tr("Note"));
  show();
}

void MessageBar::TakeColors() {
  const Colors& colors = ThemeColors();
  const QColor& ink = is_error_ ? colors.contact : colors.clear;
  const QColor& tint = is_error_ ? colors.contact_tint : colors.clear_tint;
  const QString sheet = QString(
                            "QFrame { border-radius: 3px; background: %1; border: 1px solid %2; color: "
                            "%2; } QLabel, QToolButton { border: none; background: transparent; }")
                            .arg(tint.name(), ink.name());
  if (sheet != styleSheet()) setStyleSheet(sheet);
  findChild<QToolButton*>("close_message")
      ->setIcon(InTextColor(style()->standardIcon(QStyle::SP_TitleBarCloseButton)));
}

void MessageBar::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && isVisible()) TakeColors();
}

}  // namespace elbowroom::console
