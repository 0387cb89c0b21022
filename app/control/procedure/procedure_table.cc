#include "app/control/procedure/procedure_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "core/procedure/answers.h"

namespace elbowroom::control {
namespace {

using cad_import::TomlEntry;

constexpr std::array<std::string_view, 1> kStepKeys = {"name"};
constexpr std::array<std::string_view, 3> kSurveyKeys = {"when", "item", "scale"};
constexpr int kLargestOrder = 1000;  // of a trial among those of one participant

// A whole number; nothing where the key holds anything else.
std::optional<int> WholeNumber(const toml::node& node, int least, int most) {
  const auto number = node.value_exact<std::int64_t>();
  if (!number || *number < least || *number > most) return std::nullopt;
  return static_cast<int>(*number);
}

int ReadOrder(const TomlEntry& root) {
  const toml::node* node = root.Find("order");
  if (node == nullptr) return 0;
  const auto order = WholeNumber(*node, 1, kLargestOrder);
  if (!order) root.Fail("order", fmt::format("must be a whole number from 1 to {}", kLargestOrder));
  return *order;
}

void ReadScale(const TomlEntry& entry, core::SurveyItem* item) {
  const toml::node* node = entry.Find("scale");
  if (node == nullptr) return;
  const toml::array* ends = node->as_array();
  constexpr const char* kShape = "must be two whole numbers, the least first: [1, 7]";
  if (ends == nullptr || ends->size() != 2) entry.Fail("scale", kShape);
  const auto least = WholeNumber(*ends->get(0), -core::kWidestScale, core::kWidestScale);
  const auto most = WholeNumber(*ends->get(1), -core::kWidestScale, core::kWidestScale);
  if (!least || !most || *least >= *most) entry.Fail("scale", kShape);
  item->least = *least;
  item->most = *most;
}

core::SurveyItem ReadItem(const TomlEntry& entry) {
  core::SurveyItem item;
  const auto when = core::ParseAskedWhen(entry.Text("when"));
  if (!when) entry.Fail("when", R"(must be "before" or "after")");
  item.when = *when;
  item.item = entry.Text("item");
  ReadScale(entry, &item);
  return item;
}

}  // namespace

void ReadProcedure(const TomlEntry& root, core::TrialInfo* trial) {
  trial->condition = root.TextOr("condition", "");
  trial->order = ReadOrder(root);
  for (const TomlEntry& entry : root.Entries("step", kStepKeys)) {
    std::string name = entry.Text("name");
    if (std::ranges::find(trial->steps, name) != trial->steps.end())
      entry.Fail("name", fmt::format("'{}' is the name of an earlier step; give it another", name));
    trial->steps.push_back(std::move(name));
  }
  for (const TomlEntry& entry : root.Entries("survey", kSurveyKeys)) {
    core::SurveyItem item = ReadItem(entry);
    if (core::FindItem(*trial, item.when, item.item) != nullptr)
      entry.Fail("item", fmt::format("'{}' is asked {} the trial already", item.item, ToString(item.when)));
    trial->survey.push_back(std::move(item));
  }
}

}  // namespace elbowroom::control
