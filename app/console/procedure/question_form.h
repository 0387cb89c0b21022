// What a participant is asked before or after a trial: the estimate, the survey's items, questionnaires.
#pragma once

#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QWidget>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/session.h"

namespace elbowroom::console {

// Nothing has to be answered. Thread: UI.
class QuestionForm : public QWidget {
  Q_OBJECT

 public:
  QuestionForm(core::AskedWhen when, QWidget* parent = nullptr);

  // The items and questionnaires of `when`; nothing is answered yet but the estimate, where one is given.
  void Open(const core::TrialInfo& trial, std::optional<double> estimate_mm);

  [[nodiscard]] std::optional<double> estimate_mm() const;
  // The estimate and the answers that were given.
  [[nodiscard]] std::vector<core::EventContent> Said() const;

  void FocusEstimate();

 private:
  void AddSurveyItem(const core::SurveyItem& item);
  void AddQuestionnaire(const core::Questionnaire& questionnaire);
  // `event`: what an answer is in the session.
  void AddItem(const core::QuestionnaireItem& item, const QString& name,
               std::function<core::EventContent(const core::ItemAnswer&)> event);
  QLabel* AddLabel(const std::string& text);

  struct Question {
    std::function<std::optional<core::ItemAnswer>()> answer;
    std::function<core::EventContent(const core::ItemAnswer&)> event;
  };

  core::AskedWhen when_;
  QFormLayout* form_ = nullptr;  // this and the next are owned by Qt as children
  QDoubleSpinBox* estimate_ = nullptr;
  std::vector<Question> questions_;
};

}  // namespace elbowroom::console
