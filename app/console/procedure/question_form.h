// What a participant is asked before or after a trial: the estimate and the survey's items.
#pragma once

#include <QButtonGroup>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QSpinBox>
#include <QWidget>
#include <functional>
#include <optional>
#include <vector>

#include "core/session.h"

namespace elbowroom::console {

// Nothing has to be answered. Thread: UI.
class QuestionForm : public QWidget {
  Q_OBJECT

 public:
  QuestionForm(core::AskedWhen when, QWidget* parent = nullptr);

  // The items of `when`; nothing is answered yet but the estimate, where one is given.
  void Open(const core::TrialInfo& trial, std::optional<double> estimate_mm);

  [[nodiscard]] std::optional<double> estimate_mm() const;
  // The estimate and the answers that were given.
  [[nodiscard]] std::vector<core::EventContent> Said() const;

  void FocusEstimate();

 private:
  void AddItem(const core::SurveyItem& item);
  [[nodiscard]] QWidget* ButtonsOf(const core::SurveyItem& item, const QString& name);
  [[nodiscard]] QWidget* BoxOf(const core::SurveyItem& item, const QString& name);

  struct Question {
    core::SurveyItem item;
    std::function<std::optional<int>()> answer;
  };

  core::AskedWhen when_;
  QFormLayout* form_ = nullptr;  // this and the next are owned by Qt as children
  QDoubleSpinBox* estimate_ = nullptr;
  std::vector<Question> questions_;
};

}  // namespace elbowroom::console
