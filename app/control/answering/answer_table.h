// Answers that were given on paper, as a table or as words of a command say them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace elbowroom::control {

// What is empty isn't said: the rest then has to tell which session, and which item of it, is meant.
struct GivenAnswer {
  std::string where;         // for messages: "answers.csv:12", "--give sure=5"
  std::string session = {};  // the name of its file
  std::string participant = {};
  std::string condition = {};
  std::string order = {};
  std::string block = {};
  std::string phase = {};          // "before", "after"
  std::string questionnaire = {};  // its name
  std::string item = {};           // an id, QUESTIONNAIRE:ID, or the words of a survey's item
  std::string answer = {};
};

// Reads a CSV table (RFC 4180, without line breaks in fields, UTF-8) whose first line names its columns:
// `item` and `answer`, and any of session, participant, condition, order, block, phase, questionnaire.
// Throws: core::Error{kFile} where it can't be read; {kFormat} with file and line for what isn't such a
// table.
[[nodiscard]] std::vector<GivenAnswer> ReadAnswerTable(const std::filesystem::path& csv);

// "ITEM=ANSWER", or with "before:" or "after:" in front. Throws: core::Error{kRange}.
[[nodiscard]] GivenAnswer ParseGivenAnswer(std::string_view text);

}  // namespace elbowroom::control
