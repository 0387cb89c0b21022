#include "app/console/message_bar.h"

#include <QHBoxLayout>
#include <QStyle>
#include <QToolButton>

namespace elbowroom::console {

MessageBar::MessageBar(QWidget* parent) : QFrame(parent), text_(new QLabel) {
  text_->setObjectName("message");
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* close = new QToolButton;
  close->setAutoRaise(true);
  close->setIcon(style()->standardIcon(QStyle::SP_TitleBarCloseButton));
  close->setToolTip(tr("Close this message"));
  connect(close, &QToolButton::clicked, this, &QWidget::hide);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(10, 4, 4, 4);
  row->addWidget(text_, 1);
  row->addWidget(close);
  hide();
}

void MessageBar::ShowError(const QString& line) {
  ShowLine(line, "background: #fce9e4; border: 1px solid #d9917f; color: #7c1f0d;");
}

void MessageBar::ShowNote(const QString& line) {
  ShowLine(line, "background: #e6f1e9; border: 1px solid #9cc4a8; color: #1f5331;");
}

void MessageBar::ShowLine(const QString& line, const QString& colors) {
  setStyleSheet("QFrame { border-radius: 3px; " + colors +
                " } QLabel, QToolButton { border: none; background: transparent; }");
  text_->setText(line);
  show();
}

}  // namespace elbowroom::console
