// After a trial: the estimate again, the survey, and free notes.
#pragma once

#include <QPlainTextEdit>
#include <QPushButton>
#include <QWidget>
#include <vector>

#include "app/console/procedure/question_form.h"
#include "core/session.h"

namespace elbowroom::console {

// Nothing has to be answered; Escape skips it all, unless something was said. Thread: UI.
class AfterPage : public QWidget {
  Q_OBJECT

 public:
  explicit AfterPage(QWidget* parent = nullptr);

  // Asks of the trial that has ended, with nothing said yet.
  void Open(const core::TrialInfo& trial);
  void FocusEstimate() { questions_->FocusEstimate(); }
  // The answers, and the notes as one.
  [[nodiscard]] std::vector<core::EventContent> Said() const;
  [[nodiscard]] bool HasAnswers() const { return !Said().empty(); }
  void SetIsSaving(bool is_saving);  // while they are written

 signals:
  void SaveAsked(const std::vector<elbowroom::core::EventContent>& said);
  void Skipped();

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void Save();

  QuestionForm* questions_ = nullptr;  // this and the next are owned by Qt as children
  QPlainTextEdit* notes_ = nullptr;
  QPushButton* save_ = nullptr;
  QPushButton* skip_ = nullptr;
};

}  // namespace elbowroom::console
