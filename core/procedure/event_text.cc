#include "core/procedure/event_text.h"

#include <fmt/format.h>

#include "core/procedure/answers.h"
#include "core/procedure/scores.h"

namespace elbowroom::core {
namespace {

// A kind that is added must not compile without its words.
struct KindWord {
  std::string_view operator()(const SpacingChanged& /*change*/) const { return "spacing"; }
  std::string_view operator()(const ToolMarked& /*mark*/) const { return "tool"; }
  std::string_view operator()(const Note& /*note*/) const { return "note"; }
  std::string_view operator()(const StepMarked& /*mark*/) const { return "step"; }
  std::string_view operator()(const Bookmark& /*bookmark*/) const { return "bookmark"; }
  std::string_view operator()(const EstimateGiven& /*given*/) const { return "estimate"; }
  std::string_view operator()(const SurveyAnswered& /*answered*/) const { return "answer"; }
  std::string_view operator()(const QuestionnaireAnswered& /*answered*/) const { return "questionnaire"; }
};

struct Words {
  std::string operator()(const SpacingChanged& change) const {
    return fmt::format("{} from {:.5g} to {:.5g} mm", change.spacing, change.from_mm, change.to_mm);
  }
  std::string operator()(const ToolMarked& mark) const {
    return mark.tool + (mark.in_use ? " taken in use" : " put away");
  }
  std::string operator()(const Note& note) const { return note.text; }
  std::string operator()(const StepMarked& mark) const {
    return fmt::format("step '{}' {}", mark.step, mark.begun ? "begun" : "ended");
  }
  std::string operator()(const Bookmark& bookmark) const {
    return bookmark.name.empty() ? "bookmark" : fmt::format("bookmark: {}", bookmark.name);
  }
  std::string operator()(const EstimateGiven& given) const {
    return fmt::format("estimate {} the trial: {:.5g} mm", ToString(given.when), given.estimate_mm);
  }
  std::string operator()(const SurveyAnswered& answered) const {
    return fmt::format("{} the trial, '{}': {}", ToString(answered.when), answered.item, answered.answer);
  }
  std::string operator()(const QuestionnaireAnswered& answered) const {
    return fmt::format("{} the trial, {}, '{}': {}", ToString(answered.when), answered.questionnaire,
                       answered.item, TextOf(answered.answer));
  }
};

}  // namespace

std::string_view KindOf(const EventContent& what) { return std::visit(KindWord{}, what); }

std::string EventText(const EventContent& what) { return std::visit(Words{}, what); }

}  // namespace elbowroom::core
