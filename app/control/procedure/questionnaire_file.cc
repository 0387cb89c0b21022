#include "app/control/procedure/questionnaire_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/control/procedure/whole_numbers.h"
#include "cad_import/layout/toml_entry.h"
#include "core/procedure/scores.h"
#include "core/session.h"

namespace elbowroom::control {
namespace {

using cad_import::TomlEntry;
using core::ItemKind;
using core::QuestionnaireItem;
using core::ScoreRule;

constexpr std::array<std::string_view, 3> kFileKeys = {"name", "item", "score"};
constexpr std::array<std::string_view, 9> kItemKeys = {"id",      "text",   "kind",  "scale",   "anchors",
                                                       "choices", "values", "range", "reversed"};
constexpr std::array<std::string_view, 6> kScoreKeys = {"name",    "rule",   "items",
                                                        "weights", "factor", "counted"};
constexpr std::size_t kMostItems = 200, kMostChoices = 50;

std::string ReadId(const TomlEntry& entry) {
  std::string id = entry.Text("id");
  const bool is_plain = std::ranges::all_of(id, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!is_plain) entry.Fail("id", "must have only letters, digits, '_' and '-'");
  return id;
}

ItemKind ReadKind(const TomlEntry& entry) {
  const auto kind = core::ParseItemKind(entry.TextOr("kind", "scale"));
  if (!kind) entry.Fail("kind", R"(must be "scale", "choice", "number" or "text")");
  return *kind;
}

// A list of numbers; nothing: the key is absent.
std::optional<std::vector<double>> Numbers(const TomlEntry& entry, std::string_view key) {
  const toml::node* node = entry.Find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* list = node->as_array();
  if (list == nullptr) entry.Fail(key, "must be a list of numbers: [1, 2]");
  std::vector<double> numbers;
  for (const toml::node& element : *list) {
    const auto number = element.is_number() ? element.value<double>() : std::nullopt;
    if (!number || !(std::abs(*number) <= core::kLargestAnswer))
      entry.Fail(key, fmt::format("must hold nothing but numbers, {:g} at most", core::kLargestAnswer));
    numbers.push_back(*number);
  }
  return numbers;
}

// Both ends of a range.
std::optional<std::pair<double, double>> Ends(const TomlEntry& entry, std::string_view key, bool may_be_one) {
  const auto ends = Numbers(entry, key);
  if (!ends) return std::nullopt;
  if (ends->size() != 2 || (*ends)[0] > (*ends)[1] || (!may_be_one && (*ends)[0] == (*ends)[1]))
    entry.Fail(key, "must be two numbers, the least first: [0, 10]");
  return std::pair((*ends)[0], (*ends)[1]);
}

void RefuseKey(const TomlEntry& entry, std::string_view key, bool is_refused, const char* why) {
  if (is_refused && entry.Find(key) != nullptr) entry.Fail(key, fmt::format("is {}; leave it out", why));
}

void ReadAnchors(const TomlEntry& entry, QuestionnaireItem* item) {
  std::vector<std::string> anchors = entry.Texts("anchors");
  if (anchors.empty() && entry.Find("anchors") == nullptr) return;
  if (anchors.size() != 2) entry.Fail("anchors", R"(must be two texts: ["not at all", "very much"])");
  item->least_anchor = std::move(anchors[0]);
  item->most_anchor = std::move(anchors[1]);
}

void ReadChoices(const TomlEntry& entry, QuestionnaireItem* item) {
  item->choices = entry.Texts("choices");
  if (item->choices.size() < 2 || item->choices.size() > kMostChoices)
    entry.Fail("choices", fmt::format(R"(must be a list of 2 to {} texts: ["no", "yes"])", kMostChoices));
  std::vector<std::string> sorted = item->choices;
  std::ranges::sort(sorted);
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
    entry.Fail("choices", fmt::format("has '{}' twice", *twice));
  if (auto values = Numbers(entry, "values")) {
    if (values->size() != item->choices.size())
      entry.Fail("values",
                 fmt::format("has {} numbers for {} choices", values->size(), item->choices.size()));
    item->values = std::move(*values);
  } else {
    item->values.resize(item->choices.size());
    std::iota(item->values.begin(), item->values.end(), 0.0);
  }
  const auto [least, most] = std::ranges::minmax(item->values);
  if (least == most) entry.Fail("values", "are all the same; a choice must make a difference");
  item->least = least;
  item->most = most;
}

void ReadNumberRange(const TomlEntry& entry, QuestionnaireItem* item) {
  const auto range = Ends(entry, "range", false);
  if (!range && item->reversed) entry.Fail("reversed", "needs the number's range: range = [0, 10]");
  std::tie(item->least, item->most) = range.value_or(std::pair(-core::kLargestAnswer, core::kLargestAnswer));
}

QuestionnaireItem ReadQuestion(const TomlEntry& entry) {
  QuestionnaireItem item{ReadId(entry), entry.Text("text")};
  item.kind = ReadKind(entry);
  const bool is_scale = item.kind == ItemKind::kScale, is_choice = item.kind == ItemKind::kChoice;
  for (const std::string_view key : {"scale", "anchors"}) RefuseKey(entry, key, !is_scale, "for a scale");
  for (const std::string_view key : {"choices", "values"}) RefuseKey(entry, key, !is_choice, "for a choice");
  RefuseKey(entry, "range", item.kind != ItemKind::kNumber, "for a number");
  RefuseKey(entry, "reversed", item.kind == ItemKind::kText, "for what has a value, which a text hasn't");
  item.reversed = entry.FlagOr("reversed", false);
  switch (item.kind) {
    case ItemKind::kScale:
      if (const auto ends = ReadScaleEnds(entry)) std::tie(item.least, item.most) = *ends;
      ReadAnchors(entry, &item);
      break;
    case ItemKind::kChoice:
      ReadChoices(entry, &item);
      break;
    case ItemKind::kNumber:
      ReadNumberRange(entry, &item);
      break;
    case ItemKind::kText:
      item.least = item.most = 0.0;
      break;
  }
  return item;
}

// All items that have a value, if the score names none.
std::vector<std::string> ItemsOf(const TomlEntry& entry, const core::Questionnaire& questionnaire) {
  if (entry.Find("items") != nullptr) return entry.Texts("items");
  std::vector<std::string> items;
  for (const QuestionnaireItem& item : questionnaire.items)
    if (item.kind != ItemKind::kText) items.push_back(item.id);
  return items;
}

void ReadTerms(const TomlEntry& entry, const core::Questionnaire& questionnaire, core::Score* score) {
  for (std::string& id : ItemsOf(entry, questionnaire)) {
    const QuestionnaireItem* item = core::FindItem(questionnaire, id);
    if (item == nullptr) entry.Fail("items", fmt::format("names '{}', which no [[item]] has as its id", id));
    if (item->kind == ItemKind::kText)
      entry.Fail("items", fmt::format("names '{}', a text, which has no value", id));
    if (std::ranges::find(score->terms, id, &core::ScoreTerm::item) != score->terms.end())
      entry.Fail("items", fmt::format("names '{}' twice; give it a weight of 2 instead", id));
    score->terms.push_back({std::move(id)});
  }
  if (score->terms.empty()) entry.Fail("items", "must name at least one item");
  RefuseKey(entry, "weights", score->rule == ScoreRule::kCount, "for a sum or a mean");
  const auto weights = Numbers(entry, "weights");
  if (!weights) return;
  if (weights->size() != score->terms.size())
    entry.Fail("weights", fmt::format("has {} numbers for {} items", weights->size(), score->terms.size()));
  for (std::size_t i = 0; i < weights->size(); ++i) {
    if ((*weights)[i] == 0.0 || (score->rule == ScoreRule::kMean && (*weights)[i] < 0.0))
      entry.Fail("weights", score->rule == ScoreRule::kMean ? "of a mean must be above 0" : "must not be 0");
    score->terms[i].weight = (*weights)[i];
  }
}

core::Score ReadScore(const TomlEntry& entry, const core::Questionnaire& questionnaire) {
  core::Score score;
  score.name = entry.Text("name");
  const auto rule = core::ParseScoreRule(entry.Text("rule"));
  if (!rule) entry.Fail("rule", R"(must be "sum", "mean" or "count")");
  score.rule = *rule;
  ReadTerms(entry, questionnaire, &score);
  score.factor = entry.NumberOr("factor", 1.0);
  if (score.factor == 0.0) entry.Fail("factor", "must not be 0");
  RefuseKey(entry, "counted", score.rule != ScoreRule::kCount, "for a count");
  if (score.rule != ScoreRule::kCount) return score;
  const auto counted = Ends(entry, "counted", true);
  if (!counted) entry.Fail("counted", "is missing; say which values count: counted = [6, 7]");
  std::tie(score.counted_from, score.counted_to) = *counted;
  return score;
}

}  // namespace

core::Questionnaire ReadQuestionnaireFile(const std::filesystem::path& path, core::AskedWhen when) {
  const toml::table table = cad_import::ParseTomlFile(path, "questionnaire file");
  const TomlEntry root(table, path.string(), "", kFileKeys);
  core::Questionnaire questionnaire{when, root.Text("name"), {}};
  for (const TomlEntry& entry : root.Entries("item", kItemKeys)) {
    QuestionnaireItem item = ReadQuestion(entry);
    if (core::FindItem(questionnaire, item.id) != nullptr)
      entry.Fail("id", fmt::format("'{}' is the id of an earlier item; give it another", item.id));
    questionnaire.items.push_back(std::move(item));
  }
  if (questionnaire.items.empty()) root.Fail("item", "is missing: add an [[item]] with an id and a text");
  if (questionnaire.items.size() > kMostItems)
    root.Fail("item",
              fmt::format("has {} entries; at most {} can be asked", questionnaire.items.size(), kMostItems));
  for (const TomlEntry& entry : root.Entries("score", kScoreKeys)) {
    core::Score score = ReadScore(entry, questionnaire);
    if (std::ranges::find(questionnaire.scores, score.name, &core::Score::name) != questionnaire.scores.end())
      entry.Fail("name", fmt::format("'{}' is the name of an earlier score; give it another", score.name));
    questionnaire.scores.push_back(std::move(score));
  }
  return questionnaire;
}

}  // namespace elbowroom::control
