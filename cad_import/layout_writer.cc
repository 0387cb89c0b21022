#include <fmt/format.h>

#include <toml++/toml.h>
#include <cmath>
#include <sstream>

#include "cad_import/gives_way_keys.h"
#include "cad_import/layout_file.h"
#include "core/error.h"
#include "core/units.h"
#include "core/whole_file.h"

namespace elbowroom::cad_import {
namespace {

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

toml::array ToToml(const Eigen::Vector3d& v) { return toml::array{v.x(), v.y(), v.z()}; }

toml::table ToToml(const core::Part& part) {
  if (part.file.empty()) {
    throw core::Error(
        core::ErrorKind::kCad,
        fmt::format("part '{}' has no file; write its mesh and name the file first", part.name));
  }
  toml::table table = GivesWayToToml(part.gives_way);
  table.insert("name", part.name);
  table.insert("file", part.file);
  if (part.unit) table.insert("unit", core::ToString(*part.unit));
  table.insert("position_mm", ToToml(part.world_from_part.translation_mm));
  table.insert("rotation_rpy_deg", ToToml(RollPitchYawDeg(part.world_from_part.rotation)));
  const core::RecoveryRule& recovery = part.recovery;
  if (recovery.reference_in_part_mm) table.insert("reference_mm", ToToml(*recovery.reference_in_part_mm));
  if (recovery.kind != core::RecoveryKind::kReference)
    table.insert("recovery", core::ToString(recovery.kind));
  if (recovery.axis_in_part) table.insert("recovery_axis", ToToml(*recovery.axis_in_part));
  if (recovery.at_in_part_mm) table.insert("recovery_at_mm", ToToml(*recovery.at_in_part_mm));
  return table;
}

toml::table ToToml(const core::Stream& stream) {
  return toml::table{{"name", stream.name},
                     {"position_mm", ToToml(stream.position_mm)},
                     {"direction", ToToml(stream.direction)},
                     {"rate_per_s", stream.rate_per_s},
                     {"speed_mm_per_s", stream.speed_mm_per_s},
                     {"radius_mm", stream.radius_mm}};
}

toml::table ToToml(const core::Spacing& spacing) {
  return toml::table{{"name", spacing.name},
                     {"moving", spacing.moving},
                     {"reference", spacing.reference},
                     {"axis", core::ToString(spacing.axis)},
                     {"min_mm", spacing.min_mm},
                     {"max_mm", spacing.max_mm},
                     {"initial_mm", spacing.initial_mm}};
}

toml::table ToToml(const core::PairRule& rule) {
  return toml::table{{"a", rule.a},
                     {"b", rule.b},
                     {"required_clearance_mm", rule.required_clearance_mm},
                     {"authorised_contact", rule.authorised_contact},
                     {"ignore", rule.ignore}};
}

// "[[key]]" and those of its keys that it has, in the order given, one a line (a toml::table would sort
// them).
template <typename Value>
void WriteEntries(std::ostream& out, const char* key, const std::vector<Value>& values,
                  std::initializer_list<const char*> order) {
  for (const Value& value : values) {
    const toml::table table = ToToml(value);
    out << "\n[[" << key << "]]\n";
    for (const char* name : order) {
      if (const toml::node* node = table.get(name)) out << name << " = " << toml::node_view(*node) << '\n';
    }
  }
}

}  // namespace

void WriteLayoutFile(const core::Layout& layout, const std::filesystem::path& path) {
  std::ostringstream out;
  out << "unit = \"" << core::ToString(layout.unit) << "\"\n";
  WriteEntries(
      out, "part", layout.parts,
      {"name", "file", "unit", "position_mm", "rotation_rpy_deg", "reference_mm", "recovery", "recovery_axis",
       "recovery_at_mm", "gives_way", "pins", "stretch_stiffness_n_per_m", "bending_stiffness_n_per_m",
       "mass_per_area_kg_per_m2", "damping_per_s", "friction", "max_speed_mm_per_s"});
  WriteEntries(out, "spacing", layout.spacings,
               {"name", "moving", "reference", "axis", "min_mm", "max_mm", "initial_mm"});
  WriteEntries(out, "pair", layout.pair_rules,
               {"a", "b", "required_clearance_mm", "authorised_contact", "ignore"});
  WriteEntries(out, "stream", layout.streams,
               {"name", "position_mm", "direction", "rate_per_s", "speed_mm_per_s", "radius_mm"});
  core::WriteWholeFile(path, out.str());
}

}  // namespace elbowroom::cad_import
