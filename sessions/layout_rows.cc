#include "sessions/layout_rows.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "sessions/gives_way_rows.h"
#include "sessions/packing.h"
#include "sessions/statement.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;

std::optional<std::string> JsonOrNull(const std::optional<Eigen::Vector3d>& vector) {
  if (!vector) return std::nullopt;
  return JsonFrom(*vector);
}

// Of four columns.
core::RecoveryRule ReadRecoveryRule(const Statement& row, int first_column, const std::string& where) {
  const auto kind = core::ParseRecoveryKind(row.Text(first_column));
  const auto vector = [&](int column) -> std::optional<Eigen::Vector3d> {
    if (row.IsNull(column)) return std::nullopt;
    return VectorFromJson(row.Text(column), where);
  };
  if (!kind) {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: no recovery is called '{}'; restore the file from a copy", where,
                            row.Text(first_column)));
  }
  return {*kind, vector(first_column + 1), vector(first_column + 2), vector(first_column + 3)};
}

void InsertParts(Database& database, const std::vector<core::Part>& parts) {
  Compressor compressor;
  Statement insert_mesh(database, "INSERT INTO mesh VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING");
  Statement insert_part(database, "INSERT INTO part VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (core::PartIndex i = 0; i < parts.size(); ++i) {
    const core::Part& part = parts[i];
    const std::string hash = core::ContentHash(*part.mesh);
    const PackedMesh packed = Pack(*part.mesh, compressor);
    insert_mesh
        .With(hash, part.mesh->vertices_mm.size(), part.mesh->triangles.size(), packed.vertices_mm_zstd,
              packed.triangles_zstd, part.mesh->deviation_mm)
        .Run();
    insert_part
        .With(i, part.name, part.file, core::ToString(part.unit.value_or(core::LengthUnit::kMillimetre)),
              hash, JsonFrom(part.world_from_part.rotation), JsonFrom(part.world_from_part.translation_mm),
              core::ToString(part.recovery.kind), JsonOrNull(part.recovery.reference_in_part_mm),
              JsonOrNull(part.recovery.axis_in_part), JsonOrNull(part.recovery.at_in_part_mm),
              part.unit ? "part" : "file")
        .Run();
  }
}

core::SharedMesh ReadMesh(const Statement& row, const std::string& path) {
  const std::string hash = row.Text(0);
  const std::string where = fmt::format("session '{}', mesh {}", path, hash);
  auto mesh = std::make_shared<core::TriangleMesh>(
      UnpackMesh(row.Bytes(3), static_cast<std::size_t>(row.Integer(1)), row.Bytes(4),
                 static_cast<std::size_t>(row.Integer(2)), where));
  mesh->deviation_mm = row.Real(5);
  if (core::ContentHash(*mesh) != hash) {
    throw Error(ErrorKind::kFormat,
                where + ": it doesn't match its checksum; the file is damaged, restore it from a copy");
  }
  return mesh;
}

std::map<std::string, core::SharedMesh> ReadMeshes(Database& database) {
  Statement rows(database,
                 "SELECT mesh_hash, vertex_count, triangle_count, vertices_mm_zstd, triangles_zstd, "
                 "deviation_mm FROM mesh");
  std::map<std::string, core::SharedMesh> meshes;
  while (rows.Next()) meshes.emplace(rows.Text(0), ReadMesh(rows, database.path().string()));
  return meshes;
}

std::vector<core::Part> ReadParts(Database& database) {
  const std::map<std::string, core::SharedMesh> meshes = ReadMeshes(database);
  Statement rows(database,
                 "SELECT name, file, unit, mesh_hash, rotation_world_from_part, position_mm, "
                 "recovery, reference_mm, recovery_axis, recovery_at_mm, unit_of FROM part "
                 "ORDER BY part_index");
  std::vector<core::Part> parts;
  while (rows.Next()) {
    core::Part part;
    part.name = rows.Text(0);
    part.file = rows.Text(1);
    if (rows.Text(10) == "part") part.unit = UnitFromText(rows.Text(2), database);
    const std::string where = fmt::format("session '{}', part '{}'", database.path().string(), part.name);
    const auto mesh = meshes.find(rows.Text(3));
    if (mesh == meshes.end())
      throw Error(ErrorKind::kFormat, where + ": its mesh is missing; restore the file from a copy");
    part.mesh = mesh->second;
    part.world_from_part.rotation = MatrixFromJson(rows.Text(4), where);
    part.world_from_part.translation_mm = VectorFromJson(rows.Text(5), where);
    part.recovery = ReadRecoveryRule(rows, 6, where);
    parts.push_back(std::move(part));
  }
  return parts;
}

void InsertGroups(Database& database, const core::Layout& layout) {
  Statement insert_group(database, "INSERT INTO part_group VALUES (?, ?)");
  Statement insert_member(database, "INSERT INTO part_group_member VALUES (?, ?, ?)");
  for (core::GroupIndex i = 0; i < layout.groups.size(); ++i) {
    insert_group.With(i, layout.groups[i].name).Run();
    const std::vector<core::PartIndex> members = layout.PartsNamed(layout.groups[i].name);
    for (std::size_t k = 0; k < members.size(); ++k) insert_member.With(i, k, members[k]).Run();
  }
}

std::vector<core::Group> ReadGroups(Database& database) {
  Statement groups(database, "SELECT group_index, name FROM part_group ORDER BY group_index");
  Statement members(database,
                    "SELECT name FROM part_group_member JOIN part USING (part_index) "
                    "WHERE group_index = ? ORDER BY member_index");
  std::vector<core::Group> result;
  while (groups.Next()) {
    core::Group& group = result.emplace_back(core::Group{groups.Text(1), {}});
    for (members.With(groups.Integer(0)); members.Next();) group.parts.push_back(members.Text(0));
  }
  return result;
}

void InsertSpacings(Database& database, const core::Layout& layout) {
  Statement insert(database, "INSERT INTO spacing VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  const auto first_part = [&](const std::string& name) { return layout.PartsNamed(name).front(); };
  for (core::SpacingIndex i = 0; i < layout.spacings.size(); ++i) {
    const core::Spacing& spacing = layout.spacings[i];
    insert
        .With(i, spacing.name, first_part(spacing.moving), first_part(spacing.reference),
              core::ToString(spacing.axis), spacing.min_mm, spacing.max_mm, spacing.initial_mm,
              layout.FindGroup(spacing.moving), layout.FindGroup(spacing.reference))
        .Run();
  }
}

std::vector<core::Spacing> ReadSpacings(Database& database) {
  Statement rows(database,
                 "SELECT s.name, coalesce(mg.name, m.name), coalesce(rg.name, r.name), axis, min_mm, max_mm, "
                 "initial_mm FROM spacing s "
                 "JOIN part m ON m.part_index = moving_part JOIN part r ON r.part_index = reference_part "
                 "LEFT JOIN part_group mg ON mg.group_index = moving_group "
                 "LEFT JOIN part_group rg ON rg.group_index = reference_group "
                 "ORDER BY spacing_index");
  std::vector<core::Spacing> spacings;
  while (rows.Next()) {
    const auto axis = core::ParseAxis(rows.Text(3));
    if (!axis) {
      throw Error(ErrorKind::kFormat,
                  fmt::format("session '{}', spacing '{}': no axis is called '{}'; restore the file "
                              "from a copy",
                              database.path().string(), rows.Text(0), rows.Text(3)));
    }
    spacings.push_back(
        {rows.Text(0), rows.Text(1), rows.Text(2), *axis, rows.Real(4), rows.Real(5), rows.Real(6)});
  }
  return spacings;
}

void InsertPairRules(Database& database, const core::Layout& layout) {
  Statement insert(database, "INSERT INTO pair_rule VALUES (?, ?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < layout.pair_rules.size(); ++i) {
    const core::PairRule& rule = layout.pair_rules[i];
    insert
        .With(i, layout.FindPart(rule.a), layout.FindPart(rule.b), rule.required_clearance_mm,
              rule.authorised_contact, rule.ignore)
        .Run();
  }
}

std::vector<core::PairRule> ReadPairRules(Database& database) {
  Statement rows(
      database,
      "SELECT a.name, b.name, required_clearance_mm, authorised_contact, ignored FROM pair_rule "
      "JOIN part a ON a.part_index = part_a JOIN part b ON b.part_index = part_b ORDER BY pair_index");
  std::vector<core::PairRule> rules;
  while (rows.Next()) {
    rules.push_back({rows.Text(0), rows.Text(1), rows.Real(2), rows.Integer(3) != 0, rows.Integer(4) != 0});
  }
  return rules;
}

}  // namespace

core::LengthUnit UnitFromText(const std::string& text, const Database& database) {
  if (const auto unit = core::ParseLengthUnit(text)) return *unit;
  throw Error(ErrorKind::kFormat,
              fmt::format("session '{}': no length unit is called '{}'; restore the file from a copy",
                          database.path().string(), text));
}

void InsertLayout(Database& database, const core::Layout& layout) {
  InsertParts(database, layout.parts);
  InsertGroups(database, layout);
  InsertSpacings(database, layout);
  InsertPairRules(database, layout);
  InsertGivesWay(database, layout);
}

core::Layout ReadLayout(Database& database) {
  core::Layout layout;
  layout.parts = ReadParts(database);
  layout.groups = ReadGroups(database);
  layout.spacings = ReadSpacings(database);
  layout.pair_rules = ReadPairRules(database);
  ReadGivesWay(database, &layout);
  return layout;
}

}  // namespace elbowroom::sessions
