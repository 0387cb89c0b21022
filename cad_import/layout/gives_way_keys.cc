#include "cad_import/layout/gives_way_keys.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <variant>

namespace elbowroom::cad_import {
namespace {

// Keys that only one way of giving way has.
constexpr std::array<std::string_view, 6> kClothKeys{"pins",
                                                     "stretch_stiffness_n_per_m",
                                                     "bending_stiffness_n_per_m",
                                                     "mass_per_area_kg_per_m2",
                                                     "damping_per_s",
                                                     "friction"};
constexpr std::array<std::string_view, 1> kPushKeys{"max_speed_mm_per_s"};

template <std::size_t kCount>
void RefuseKeys(const TomlEntry& entry, const std::array<std::string_view, kCount>& keys,
                std::string_view way) {
  for (const std::string_view key : keys) {
    if (entry.Find(key))
      entry.Fail(key, fmt::format("goes with gives_way = \"{}\"; leave one of them out", way));
  }
}

core::ClothRule ReadCloth(const TomlEntry& entry) {
  core::ClothRule rule;
  for (const std::string& pin : entry.Texts("pins")) {
    const auto side = core::ParseBoundsSide(pin);
    if (!side)
      entry.Fail("pins", fmt::format("'{}' is no side; use x_min, x_max, y_min, y_max, z_min, z_max", pin));
    rule.pins.push_back(*side);
  }
  rule.stretch_stiffness_n_per_m =
      entry.NumberOr("stretch_stiffness_n_per_m", rule.stretch_stiffness_n_per_m);
  rule.bending_stiffness_n_per_m =
      entry.NumberOr("bending_stiffness_n_per_m", rule.bending_stiffness_n_per_m);
  rule.mass_per_area_kg_per_m2 = entry.NumberOr("mass_per_area_kg_per_m2", rule.mass_per_area_kg_per_m2);
  rule.damping_per_s = entry.NumberOr("damping_per_s", rule.damping_per_s);
  rule.friction = entry.NumberOr("friction", rule.friction);
  return rule;
}

Fields ClothFields(const core::ClothRule& rule) {
  std::vector<std::string> pins;
  for (const core::BoundsSide side : rule.pins) pins.emplace_back(core::ToString(side));
  return {{"gives_way", std::string("cloth")},
          {"pins", std::move(pins)},
          {"stretch_stiffness_n_per_m", rule.stretch_stiffness_n_per_m},
          {"bending_stiffness_n_per_m", rule.bending_stiffness_n_per_m},
          {"mass_per_area_kg_per_m2", rule.mass_per_area_kg_per_m2},
          {"damping_per_s", rule.damping_per_s},
          {"friction", rule.friction}};
}

}  // namespace

core::GivesWay ReadGivesWay(const TomlEntry& entry) {
  const std::string way = entry.TextOr("gives_way", "none");
  if (way != "none" && way != "cloth" && way != "pushed")
    entry.Fail("gives_way", "must be \"cloth\", \"pushed\" or \"none\"");
  if (way != "cloth") RefuseKeys(entry, kClothKeys, "cloth");
  if (way != "pushed") RefuseKeys(entry, kPushKeys, "pushed");
  if (way == "cloth") return ReadCloth(entry);
  if (way == "none") return {};
  core::PushRule rule;
  rule.max_speed_mm_per_s = entry.NumberOr("max_speed_mm_per_s", rule.max_speed_mm_per_s);
  return rule;
}

Fields GivesWayFields(const core::GivesWay& gives_way) {
  if (const auto* cloth = std::get_if<core::ClothRule>(&gives_way)) return ClothFields(*cloth);
  if (const auto* push = std::get_if<core::PushRule>(&gives_way))
    return {{"gives_way", std::string("pushed")}, {"max_speed_mm_per_s", push->max_speed_mm_per_s}};
  return {};
}

}  // namespace elbowroom::cad_import
