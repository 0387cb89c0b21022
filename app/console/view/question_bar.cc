#include "app/console/view/question_bar.h"

#include <utility>

namespace elbowroom::console {

QuestionBar::QuestionBar(const QString& name, QWidget* parent)
    : QFrame(parent), question_(new QLabel), row_(new QHBoxLayout(this)) {
  setObjectName(name);
  question_->setObjectName(name + "_question");
  question_->setWordWrap(true);
  question_->setTextFormat(Qt::PlainText);
  row_->setContentsMargins(4, 2, 4, 2);
  row_->addWidget(question_, 1);
  hide();
}

void QuestionBar::Ask(const QString& question, const std::vector<Answer>& answers, bool takes_focus) {
  for (QPushButton* button : std::exchange(buttons_, {})) {
    button->hide();
    button->deleteLater();  // it may be the one that was just pressed
  }
  question_->setText(question);
  for (const Answer& answer : answers) {
    auto* button = new QPushButton(answer.text);
    button->setObjectName(answer.name);
    button->setToolTip(answer.tool_tip);
    connect(button, &QPushButton::clicked, this, [this, then = answer.then] {
      hide();
      if (then) then();
    });
    row_->addWidget(button);
    buttons_.push_back(button);
  }
  show();
  if (takes_focus && !buttons_.empty()) buttons_.front()->setFocus();
}

}  // namespace elbowroom::console
