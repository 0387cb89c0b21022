#include "app/cli/layout_listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/cli/options/value_json.h"

namespace elbowroom::cli {
namespace {

using Poses = std::vector<core::RigidTransform>;

std::string TextOf(const Eigen::Vector3d& v, const char* between) {
  return fmt::format("{:.6g}{}{:.6g}{}{:.6g}", v.x(), between, v.y(), between, v.z());
}

Eigen::AlignedBox3d BoundsAt(const core::Part& part, const core::RigidTransform& world_from_part) {
  return core::BoundsOf(*part.mesh, world_from_part);
}

nlohmann::json PartEntry(const core::Part& part, const core::RigidTransform& world_from_part) {
  const Eigen::AlignedBox3d bounds = BoundsAt(part, world_from_part);
  nlohmann::json json = {{"name", part.name},
                         {"file", part.file},
                         {"node", nullptr},
                         {"unit", nullptr},
                         {"triangles", part.mesh->triangles.size()},
                         {"size_mm", JsonOf(core::BoundsOf(*part.mesh).sizes())},
                         {"position_mm", JsonOf(world_from_part.translation_mm)},
                         {"bounds_mm", {JsonOf(bounds.min()), JsonOf(bounds.max())}}};
  if (!part.node.empty()) json["node"] = part.node;
  if (part.unit) json["unit"] = core::ToString(*part.unit);
  return json;
}

nlohmann::json SpacingEntry(const core::Layout& layout, const core::Spacing& gap, const Poses& poses) {
  return {{"name", gap.name},
          {"moving", gap.moving},
          {"reference", gap.reference},
          {"axis", core::ToString(gap.axis)},
          {"min_mm", gap.min_mm},
          {"max_mm", gap.max_mm},
          {"initial_mm", gap.initial_mm},
          {"gap_mm", core::GapMm(layout, gap, poses)}};
}

nlohmann::json PairEntry(const core::PairRule& rule) {
  return {{"a", rule.a},
          {"b", rule.b},
          {"required_clearance_mm", rule.required_clearance_mm},
          {"authorised_contact", rule.authorised_contact},
          {"ignore", rule.ignore}};
}

std::string LineOf(const core::Part& part, const core::RigidTransform& world_from_part, std::size_t width) {
  return fmt::format("\n  {:<{}}  {:<24}  {:<24}  {:>9}  {:<4}  {}{}", part.name, width,
                     TextOf(core::BoundsOf(*part.mesh).sizes(), " x "),
                     TextOf(world_from_part.translation_mm, " "), part.mesh->triangles.size(),
                     part.unit ? core::ToString(*part.unit) : "own", part.file,
                     part.node.empty() ? "" : ", " + part.node);
}

std::string LineOf(const core::Layout& layout, const core::Spacing& gap, const Poses& poses) {
  return fmt::format("\nspacing '{}': {:.6g} mm along {} from '{}' to '{}', may be {:.6g} to {:.6g}",
                     gap.name, core::GapMm(layout, gap, poses), core::ToString(gap.axis), gap.reference,
                     gap.moving, gap.min_mm, gap.max_mm);
}

std::string LineOf(const core::PairRule& rule) {
  const std::string clearance = fmt::format("{:.6g} mm apart at least", rule.required_clearance_mm);
  return fmt::format("\npair '{}' and '{}': {}", rule.a, rule.b,
                     rule.ignore               ? "not judged"
                     : rule.authorised_contact ? "may touch; else " + clearance
                                               : clearance);
}

std::string Count(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

CommandResult ListingOf(const cad_import::ImportedLayout& imported, const std::filesystem::path& file) {
  const core::Layout& layout = imported.layout;
  const Poses poses = core::PosesAt(layout, layout.InitialSpacings());
  CommandResult result;
  result.json = {{"file", file.string()},
                 {"unit", core::ToString(layout.unit)},
                 {"parts", nlohmann::json::array()},
                 {"groups", nlohmann::json::array()},
                 {"spacings", nlohmann::json::array()},
                 {"pairs", nlohmann::json::array()},
                 {"warnings", imported.warnings}};
  std::size_t width = 4;
  for (const core::Part& part : layout.parts) width = std::max(width, part.name.size());
  result.text = fmt::format("{}: {}, {}, {}\n  {:<{}}  {:<24}  {:<24}  {:>9}  {:<4}  {}", file.string(),
                            Count(layout.parts.size(), "part"), Count(layout.spacings.size(), "spacing"),
                            Count(layout.pair_rules.size(), "pair"), "part", width, "size, mm",
                            "stands at, mm", "triangles", "unit", "file");
  for (core::PartIndex i = 0; i < layout.parts.size(); ++i) {
    result.json["parts"].push_back(PartEntry(layout.parts[i], poses[i]));
    result.text += LineOf(layout.parts[i], poses[i], width);
  }
  for (const core::Group& group : layout.groups) {
    result.json["groups"].push_back({{"name", group.name}, {"parts", group.parts}});
    result.text += fmt::format("\ngroup '{}': {}", group.name, fmt::join(group.parts, ", "));
  }
  for (const core::Spacing& gap : layout.spacings) {
    result.json["spacings"].push_back(SpacingEntry(layout, gap, poses));
    result.text += LineOf(layout, gap, poses);
  }
  for (const core::PairRule& rule : layout.pair_rules) {
    result.json["pairs"].push_back(PairEntry(rule));
    result.text += LineOf(rule);
  }
  for (const std::string& warning : imported.warnings) result.text += "\nwarning: " + warning;
  return result;
}

}  // namespace elbowroom::cli
