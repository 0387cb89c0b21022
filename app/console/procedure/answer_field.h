// The field in which an item of a survey or questionnaire is answered.
#pragma once

#include <QString>
#include <QWidget>
#include <functional>
#include <optional>

#include "core/questionnaire.h"

namespace elbowroom::console {

struct AnswerField {
  QWidget* widget = nullptr;                                // the layout that it is put into owns it
  std::function<std::optional<core::ItemAnswer>()> answer;  // nothing: not answered
};

// Buttons for a short scale, a box of numbers for a long one and for numbers, a list for choices, lines for a
// text. Nothing is answered yet. `name`: of the widget, for tests and scripts; a button's has ":VALUE" after
// it. Thread: UI.
[[nodiscard]] AnswerField MakeAnswerField(const core::QuestionnaireItem& item, const QString& name);

}  // namespace elbowroom::console
