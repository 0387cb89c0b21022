#include "cad_import/layout/layout_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cad_import/layout/gives_way_keys.h"
#include "core/error.h"
#include "core/units.h"

namespace elbowroom::cad_import {
namespace {

constexpr std::array kPartKeys = std::to_array<std::string_view>(
    {"name", "file", "node", "unit", "position_mm", "rotation_rpy_deg", "reference_mm", "recovery",
     "recovery_axis", "recovery_at_mm", "gives_way", "pins", "stretch_stiffness_n_per_m",
     "bending_stiffness_n_per_m", "mass_per_area_kg_per_m2", "damping_per_s", "friction",
     "max_speed_mm_per_s"});
constexpr std::array kGroupKeys = std::to_array<std::string_view>({"name", "parts"});
constexpr std::array kSpacingKeys = std::to_array<std::string_view>(
    {"name", "moving", "reference", "axis", "min_mm", "max_mm", "initial_mm"});
constexpr std::array kPairKeys =
    std::to_array<std::string_view>({"a", "b", "required_clearance_mm", "authorised_contact", "ignore"});
constexpr std::array kStreamKeys = std::to_array<std::string_view>(
    {"name", "position_mm", "direction", "rate_per_s", "speed_mm_per_s", "radius_mm"});

constexpr std::array kSectionKeys = std::to_array<std::string_view>({"name", "normal", "offset_mm", "on"});

// Angles of R = Rz * Ry * Rx; where the pitch is a right angle the roll is taken as 0.
Eigen::Vector3d RollPitchYawDeg(const Eigen::Matrix3d& r) {
  constexpr double kNearlyUpright = 1e-12;
  const double cos_pitch = std::hypot(r(0, 0), r(1, 0));
  const double pitch_rad = std::atan2(-r(2, 0), cos_pitch);
  const bool is_upright = cos_pitch < kNearlyUpright;
  const double roll_rad = is_upright ? 0.0 : std::atan2(r(2, 1), r(2, 2));
  const double yaw_rad = is_upright ? std::atan2(-r(0, 1), r(1, 1)) : std::atan2(r(1, 0), r(0, 0));
  return {core::DegreesFromRadians(roll_rad), core::DegreesFromRadians(pitch_rad),
          core::DegreesFromRadians(yaw_rad)};
}

std::string Text(std::string_view text) { return std::string(text); }

Fields FieldsOf(const core::Part& part) {
  if (part.file.empty()) {
    throw core::Error(
        core::ErrorKind::kCad,
        fmt::format("part '{}' has no file; write its mesh and name the file first", part.name));
  }
  Fields fields{{"name", part.name}, {"file", part.file}};
  if (!part.node.empty()) fields.push_back({"node", part.node});
  if (part.unit) fields.push_back({"unit", Text(core::ToString(*part.unit))});
  fields.push_back({"position_mm", part.world_from_part.translation_mm});
  fields.push_back({"rotation_rpy_deg", RollPitchYawDeg(part.world_from_part.rotation)});
  const core::RecoveryRule& recovery = part.recovery;
  if (recovery.reference_in_part_mm) fields.push_back({"reference_mm", *recovery.reference_in_part_mm});
  if (recovery.kind != core::RecoveryKind::kReference)
    fields.push_back({"recovery", Text(core::ToString(recovery.kind))});
  if (recovery.axis_in_part) fields.push_back({"recovery_axis", *recovery.axis_in_part});
  if (recovery.at_in_part_mm) fields.push_back({"recovery_at_mm", *recovery.at_in_part_mm});
  std::ranges::move(GivesWayFields(part.gives_way), std::back_inserter(fields));
  return fields;
}

Fields FieldsOf(const core::Group& group) { return {{"name", group.name}, {"parts", group.parts}}; }

Fields FieldsOf(const core::Spacing& spacing) {
  return {{"name", spacing.name},
          {"moving", spacing.moving},
          {"reference", spacing.reference},
          {"axis", Text(core::ToString(spacing.axis))},
          {"min_mm", spacing.min_mm},
          {"max_mm", spacing.max_mm},
          {"initial_mm", spacing.initial_mm}};
}

Fields FieldsOf(const core::PairRule& rule) {
  return {{"a", rule.a},
          {"b", rule.b},
          {"required_clearance_mm", rule.required_clearance_mm},
          {"authorised_contact", rule.authorised_contact},
          {"ignore", rule.ignore}};
}

Fields FieldsOf(const core::Stream& stream) {
  return {{"name", stream.name},
          {"position_mm", stream.position_mm},
          {"direction", stream.direction},
          {"rate_per_s", stream.rate_per_s},
          {"speed_mm_per_s", stream.speed_mm_per_s},
          {"radius_mm", stream.radius_mm}};
}

template <typename Value>
std::vector<Fields> FieldsOfEach(const std::vector<Value>& values) {
  std::vector<Fields> all;
  for (const Value& value : values) all.push_back(FieldsOf(value));
  return all;
}

std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (code < 0x20 || code == 0x7F) {
      quoted += fmt::format("\\u{:04X}", code);
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

struct TomlWriter {
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(double number) const {
    std::string text = fmt::format("{}", number);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";  // 12, not 1e30 or inf
    return text;
  }
  std::string operator()(const std::string& text) const { return Quoted(text); }
  std::string operator()(const Eigen::Vector3d& v) const {
    return fmt::format("[{}, {}, {}]", (*this)(v.x()), (*this)(v.y()), (*this)(v.z()));
  }
  std::string operator()(const std::vector<std::string>& texts) const {
    std::string list;
    for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + Quoted(text);
    return "[" + list + "]";
  }
};

}  // namespace

std::span<const std::string_view> KeysOf(std::string_view kind) {
  if (kind == "part") return kPartKeys;
  if (kind == "group") return kGroupKeys;
  if (kind == "spacing") return kSpacingKeys;
  if (kind == "pair") return kPairKeys;
  if (kind == "section") return kSectionKeys;
  core::Require(kind == "stream", "a kind of entry");
  return kStreamKeys;
}

std::vector<Fields> FieldsOf(const core::Layout& layout, std::string_view kind) {
  if (kind == "part") return FieldsOfEach(layout.parts);
  if (kind == "group") return FieldsOfEach(layout.groups);
  if (kind == "spacing") return FieldsOfEach(layout.spacings);
  if (kind == "pair") return FieldsOfEach(layout.pair_rules);
  core::Require(kind == "stream", "a kind of entry");
  return FieldsOfEach(layout.streams);
}

const FieldValue* FindField(const Fields& fields, std::string_view key) {
  const auto found = std::ranges::find(fields, key, &Field::key);
  return found == fields.end() ? nullptr : &found->value;
}

std::string TomlOf(const FieldValue& value) { return std::visit(TomlWriter(), value); }

}  // namespace elbowroom::cad_import
