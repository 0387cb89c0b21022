#include "sessions/document/document.h"

namespace elbowroom::sessions {

RichText::RichText(std::string text) {
  if (!text.empty()) runs.push_back({.text = std::move(text)});
}

RichText& RichText::operator+=(TextRun run) {
  runs.push_back(std::move(run));
  return *this;
}

TextRun Strong(std::string text) { return {.text = std::move(text), .emphasis = Emphasis::kStrong}; }
TextRun Remark(std::string text) { return {.text = std::move(text), .emphasis = Emphasis::kRemark}; }
TextRun NameRun(std::string text) { return {.text = std::move(text), .is_name = true}; }

RichText NameText(std::string text) {
  RichText name;
  name += NameRun(std::move(text));
  return name;
}

RichText WithRemark(std::string text, std::string remark) {
  RichText rich = std::move(text);
  rich += Remark(std::move(remark));
  return rich;
}

std::string PlainText(const RichText& text) {
  std::string plain;
  for (const TextRun& run : text.runs) {
    const bool is_apart = run.begins_line || run.emphasis == Emphasis::kRemark;
    if (is_apart && !plain.empty() && !plain.ends_with(' ')) plain += ' ';
    plain += run.text;
  }
  return plain;
}

}  // namespace elbowroom::sessions
