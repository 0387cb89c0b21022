// A question in place, beside what it is about.
#pragma once

#include <QFrame>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QString>
#include <functional>
#include <vector>

namespace elbowroom::console {

// One line and a button for each answer; hidden until it is asked. Nothing else waits for the answer. Any
// answer hides it. Thread: UI.
class QuestionBar : public QFrame {
 public:
  struct Answer {
    QString name;  // of the button, for tests and style sheets
    QString text;
    QString tool_tip;
    std::function<void()> then = {};  // done once the bar is hidden
  };

  explicit QuestionBar(const QString& name, QWidget* parent = nullptr);

  // Takes the place of what was asked before. The first answer has the keyboard if `takes_focus`.
  void Ask(const QString& question, const std::vector<Answer>& answers, bool takes_focus = true);
  // Shows another line; the answers stay.
  void SetQuestion(const QString& question) { question_->setText(question); }

 private:
  QLabel* question_;  // owned by Qt as children
  QHBoxLayout* row_;
  std::vector<QPushButton*> buttons_;
};

}  // namespace elbowroom::console
