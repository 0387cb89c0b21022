#include "app/control/study_plan/study_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

#include "cad_import/layout/toml_entry.h"
#include "core/error.h"
#include "core/plain_text.h"
#include "core/statistics/balanced_orders.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using cad_import::TomlEntry;

constexpr std::array<std::string_view, 7> kPlanKeys = {"name",  "seed",      "design", "participants",
                                                       "trial", "condition", "task"};
constexpr std::array<std::string_view, 2> kConditionKeys = {"name", "trial"};
constexpr std::array<std::string_view, 3> kTaskKeys = {"name", "block", "trial"};
constexpr std::int64_t kMostParticipants = 10'000;

std::uint64_t ReadSeed(const TomlEntry& root) {
  constexpr const char* kShape = "a whole number, 0 or more: the same one gives the same plan again";
  const toml::node* node = root.Find("seed");
  if (node == nullptr) root.Fail("seed", fmt::format("is missing; add it, {}", kShape));
  const auto seed = node->value_exact<std::int64_t>();
  if (!seed || *seed < 0) root.Fail("seed", fmt::format("must be {}", kShape));
  return static_cast<std::uint64_t>(*seed);
}

StudyDesign ReadDesign(const TomlEntry& root) {
  const std::string design = root.TextOr("design", "between");
  if (design == "between") return StudyDesign::kBetween;
  if (design != "within")
    root.Fail("design",
              R"(must be "between" (each participant does one condition) or "within" (each does all))");
  return StudyDesign::kWithin;
}

// A file can be named after it, and no program for tables takes it for a formula.
void RequireCode(const TomlEntry& root, const std::string& code) {
  constexpr std::string_view kNotFirst = ".=+-@";
  if (!code.empty() && code.find('/') == std::string::npos &&
      kNotFirst.find(code.front()) == std::string_view::npos && core::IsPlain(code))
    return;
  root.Fail("participants",
            fmt::format("'{}' can't be a participant's code; take letters and digits", core::Blanked(code)));
}

// A list of codes, or how many: P01, P02, ...
std::vector<std::string> ReadParticipants(const TomlEntry& root) {
  const toml::node* node = root.Find("participants");
  constexpr const char* kShape = "must be a list of codes, or how many there are";
  if (node == nullptr) root.Fail("participants", fmt::format("is missing; it {}", kShape));
  if (node->is_array()) {
    std::vector<std::string> codes = root.Texts("participants");
    if (codes.empty()) root.Fail("participants", kShape);
    std::set<std::string> seen;
    for (const std::string& code : codes) {
      RequireCode(root, code);
      if (!seen.insert(code).second)
        root.Fail("participants", fmt::format("'{}' is there twice; give each a code of its own", code));
    }
    return codes;
  }
  const auto count = node->value_exact<std::int64_t>();
  if (!count || *count < 1 || *count > kMostParticipants)
    root.Fail("participants", fmt::format("{}, 1 to {}", kShape, kMostParticipants));
  const std::size_t digits = std::max<std::size_t>(2, std::to_string(*count).size());
  std::vector<std::string> codes;
  for (std::int64_t i = 1; i <= *count; ++i) codes.push_back(fmt::format("P{:0{}}", i, digits));
  return codes;
}

// The trial file that an entry names, from the study file's folder; empty: it names none.
fs::path ReadTrial(const TomlEntry& entry, const fs::path& folder) {
  const std::string name = entry.TextOr("trial", "");
  if (name.empty()) return {};
  fs::path file = folder / name;
  if (!fs::exists(file))
    entry.Fail("trial", fmt::format("names '{}', which isn't there", file.string()), core::ErrorKind::kFile);
  return file;
}

// Of which each participant gets one.
std::vector<core::ConditionOrder> OrdersOf(const StudyPlan& plan) {
  if (plan.design == StudyDesign::kWithin) return core::BalancedOrders(plan.conditions.size());
  std::vector<core::ConditionOrder> single;
  for (std::size_t i = 0; i < plan.conditions.size(); ++i) single.push_back({i});
  return single;
}

}  // namespace

StudyPlan ReadStudyPlan(const fs::path& path) {
  const toml::table table = cad_import::ParseTomlFile(path, "study file");
  const TomlEntry root(table, path.string(), "", kPlanKeys);
  const fs::path folder = path.parent_path();
  StudyPlan plan{path, root.Text("name"), ReadSeed(root), ReadDesign(root), ReadParticipants(root), {}, {}};
  const fs::path of_all = ReadTrial(root, folder);
  for (const TomlEntry& entry : root.Entries("condition", kConditionKeys)) {
    PlannedCondition condition{entry.Text("name"), ReadTrial(entry, folder)};
    if (std::ranges::find(plan.conditions, condition.name, &PlannedCondition::name) != plan.conditions.end())
      entry.Fail("name",
                 fmt::format("'{}' is the name of an earlier condition; give it another", condition.name));
    if (condition.trial_file.empty()) condition.trial_file = of_all;
    plan.conditions.push_back(std::move(condition));
  }
  if (plan.conditions.empty()) root.Fail("condition", "is missing: add a [[condition]] with a name");
  for (const TomlEntry& entry : root.Entries("task", kTaskKeys))
    plan.tasks.push_back({entry.Text("name"), entry.TextOr("block", ""), ReadTrial(entry, folder)});
  if (plan.tasks.empty()) plan.tasks.emplace_back();
  for (const PlannedTask& task : plan.tasks)
    for (const PlannedCondition& condition : plan.conditions)
      if (task.trial_file.empty() && condition.trial_file.empty())
        root.Fail("trial",
                  fmt::format("is missing: neither the file, nor condition '{}'{} names one", condition.name,
                              task.name.empty() ? "" : fmt::format(", nor task '{}',", task.name)));
  return plan;
}

std::size_t BlockSizeOf(const StudyPlan& plan) { return OrdersOf(plan).size(); }

std::vector<PlannedTrial> PlannedTrials(const StudyPlan& plan) {
  const std::vector<core::ConditionOrder> orders = OrdersOf(plan);
  const std::vector<std::size_t> drawn =
      core::DrawInBlocks(plan.participants.size(), orders.size(), plan.seed);
  std::vector<PlannedTrial> trials;
  for (std::size_t i = 0; i < plan.participants.size(); ++i) {
    int order = 0;
    for (const std::size_t k : orders[drawn[i]]) {
      const PlannedCondition& condition = plan.conditions[k];
      for (const PlannedTask& task : plan.tasks)
        trials.push_back({plan.participants[i], ++order, condition.name, task.block, task.name,
                          task.trial_file.empty() ? condition.trial_file : task.trial_file});
    }
  }
  return trials;
}

}  // namespace elbowroom::control
