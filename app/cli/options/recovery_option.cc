#include "app/cli/options/recovery_option.h"

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options/unit_option.h"

namespace elbowroom::cli {
namespace {

// "X,Y,Z"
std::optional<Eigen::Vector3d> ParseVector(const std::string& text) {
  const std::vector<std::string> parts = CLI::detail::split(text, ',');
  if (parts.size() != 3) return std::nullopt;
  Eigen::Vector3d vector;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = ParseNumber(parts[i]);
    if (!number) return std::nullopt;
    vector[static_cast<Eigen::Index>(i)] = *number;
  }
  return vector;
}

void AddVectorOption(CLI::App& command, const std::string& name, const std::string& what,
                     std::optional<Eigen::Vector3d>* vector) {
  command
      .add_option_function<std::string>(
          name, [vector](const std::string& text) { *vector = ParseVector(text); }, what)
      ->check(CLI::Validator(
          [](const std::string& text) -> std::string {
            return ParseVector(text) ? "" : "must be three numbers, X,Y,Z, not " + text;
          },
          "X,Y,Z"));
}

}  // namespace

void AddRecoveryOptions(CLI::App& command, core::RecoveryRule* rule) {
  command
      .add_option_function<std::string>(
          "--recovery", [rule](const std::string& text) { rule->kind = *core::ParseRecoveryKind(text); },
          "which way the part gives way (default: reference)")
      ->check(CLI::IsMember({"reference", "direction", "slider", "hinge"}));
  AddVectorOption(command, "--axis", "of direction, slider or hinge, in the part's frame",
                  &rule->axis_in_part);
  AddVectorOption(command, "--at", "a point of the hinge's axis, in the part's frame, mm",
                  &rule->at_in_part_mm);
  AddVectorOption(command, "--reference",
                  "the reference point, in the part's frame, mm (default: its centre)",
                  &rule->reference_in_part_mm);
}

void CheckRecoveryOptions(const core::RecoveryRule& rule) {
  if (const auto broken = rule.BrokenRule())
    throw CLI::ValidationError("--recovery " + std::string(core::ToString(rule.kind)), std::string(*broken));
}

}  // namespace elbowroom::cli
