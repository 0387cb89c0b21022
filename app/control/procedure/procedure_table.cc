#include "app/control/procedure/procedure_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "app/control/procedure/questionnaire_file.h"
#include "app/control/procedure/whole_numbers.h"
#include "core/procedure/answers.h"
#include "core/procedure/scores.h"

namespace elbowroom::control {
namespace {

using cad_import::TomlEntry;

constexpr std::array<std::string_view, 1> kStepKeys = {"name"};
constexpr std::array<std::string_view, 4> kSurveyKeys = {"when", "item", "scale", "file"};
constexpr int kLargestOrder = 1000;  // of a trial among those of one participant

std::optional<int> ReadOrder(const TomlEntry& root) {
  const toml::node* node = root.Find("order");
  if (node == nullptr) return std::nullopt;
  const auto order = WholeNumber(*node, 1, kLargestOrder);
  if (!order) root.Fail("order", fmt::format("must be a whole number from 1 to {}", kLargestOrder));
  return order;
}

core::AskedWhen ReadWhen(const TomlEntry& entry) {
  const auto when = core::ParseAskedWhen(entry.Text("when"));
  if (!when) entry.Fail("when", R"(must be "before" or "after")");
  return *when;
}

core::SurveyItem ReadItem(const TomlEntry& entry) {
  core::SurveyItem item;
  item.when = ReadWhen(entry);
  item.item = entry.Text("item");
  if (const auto ends = ReadScaleEnds(entry)) std::tie(item.least, item.most) = *ends;
  return item;
}

core::Questionnaire ReadQuestionnaire(const TomlEntry& entry, const std::filesystem::path& folder) {
  for (const char* key : {"item", "scale"})
    if (entry.Find(key) != nullptr) entry.Fail(key, "can't stand beside 'file', which names the items");
  const core::AskedWhen when = ReadWhen(entry);
  const std::filesystem::path file = folder / entry.Text("file");
  if (!std::filesystem::exists(file))
    entry.Fail("file", fmt::format("names '{}', which isn't there", file.string()), core::ErrorKind::kFile);
  return ReadQuestionnaireFile(file, when);
}

void ReadSurvey(const TomlEntry& entry, const std::filesystem::path& folder, core::TrialInfo* trial) {
  if (entry.Find("file") != nullptr) {
    core::Questionnaire questionnaire = ReadQuestionnaire(entry, folder);
    if (core::FindQuestionnaire(*trial, questionnaire.when, questionnaire.name) != nullptr)
      entry.Fail("file", fmt::format("'{}' is asked {} the trial already", questionnaire.name,
                                     ToString(questionnaire.when)));
    trial->questionnaires.push_back(std::move(questionnaire));
    return;
  }
  core::SurveyItem item = ReadItem(entry);
  if (core::FindItem(*trial, item.when, item.item) != nullptr)
    entry.Fail("item", fmt::format("'{}' is asked {} the trial already", item.item, ToString(item.when)));
  trial->survey.push_back(std::move(item));
}

}  // namespace

void ReadProcedure(const TomlEntry& root, const std::filesystem::path& folder, core::TrialInfo* trial) {
  trial->condition = root.TextOr("condition", "");
  trial->order = ReadOrder(root).value_or(0);
  trial->block = root.TextOr("block", "");
  for (const TomlEntry& entry : root.Entries("step", kStepKeys)) {
    std::string name = entry.Text("name");
    if (std::ranges::find(trial->steps, name) != trial->steps.end())
      entry.Fail("name", fmt::format("'{}' is the name of an earlier step; give it another", name));
    trial->steps.push_back(std::move(name));
  }
  for (const TomlEntry& entry : root.Entries("survey", kSurveyKeys)) ReadSurvey(entry, folder, trial);
}

void ReadPlanned(const TomlEntry& planned, core::TrialInfo* trial) {
  trial->participant = planned.TextOr("participant", trial->participant);
  trial->task = planned.TextOr("task", trial->task);
  trial->estimate_mm = planned.NumberOr("estimate_mm", trial->estimate_mm);
  trial->condition = planned.TextOr("condition", trial->condition);
  trial->order = ReadOrder(planned).value_or(trial->order);
  trial->block = planned.TextOr("block", trial->block);
}

}  // namespace elbowroom::control
