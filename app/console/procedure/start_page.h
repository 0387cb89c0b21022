// Before a trial: who, what, under which condition, and what the participant is asked first.
#pragma once

#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QWidget>
#include <string>
#include <vector>

#include "app/console/procedure/question_form.h"
#include "core/session.h"

namespace elbowroom::console {

// What the experimenter has set when the trial begins.
struct SaidBefore {
  std::string participant;
  double estimate_mm = 0.0;  // 0: not given
  std::vector<core::EventContent> events;
};

// Enter begins the trial, whatever is still unanswered; Escape leaves it. Thread: UI.
class StartPage : public QWidget {
  Q_OBJECT

 public:
  explicit StartPage(QWidget* parent = nullptr);

  // Shows the trial of a file, with nothing said yet.
  void Open(const core::TrialInfo& trial);
  void FocusEstimate() { questions_->FocusEstimate(); }

 signals:
  void BeginAsked(const elbowroom::console::SaidBefore& said);
  void Left();

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void Begin();
  [[nodiscard]] QWidget* MakeForm();

  QLabel* task_ = nullptr;  // this and the next are owned by Qt as children
  QLabel* facts_ = nullptr;
  QLineEdit* participant_ = nullptr;
  QuestionForm* questions_ = nullptr;
  QLabel* steps_ = nullptr;
  QPushButton* begin_ = nullptr;
};

}  // namespace elbowroom::console
