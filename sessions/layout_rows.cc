#include "sessions/layout_rows.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <span>
#include <utility>

#include "core/error.h"
#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/gives_way_rows.h"
#include "sessions/packing.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

std::optional<std::string> JsonOrNull(const std::optional<Eigen::Vector3d>& vector) {
  if (!vector) return std::nullopt;
  return JsonFrom(*vector);
}

// Reads four columns of the row, from `first_column` on.
core::RecoveryRule ReadRecoveryRule(const Statement& row, int first_column, const std::string& where) {
  const auto kind = core::ParseRecoveryKind(row.Text(first_column));
  const auto vector = [&](int column) -> std::optional<Eigen::Vector3d> {
    if (row.IsNull(column)) return std::nullopt;
    return VectorFromJson(row.Text(column), where);
  };
  if (!kind)
    FailAsDamaged(where, fmt::format("no recovery is called '{}'", Quotable(row.Text(first_column))));
  core::RecoveryRule rule{*kind, vector(first_column + 1), vector(first_column + 2),
                          vector(first_column + 3)};
  if (const auto broken = rule.BrokenRule()) FailAsDamaged(where, fmt::format("its recovery: {}", *broken));
  return rule;
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
  const std::string where = fmt::format("session '{}', mesh {}", path, Quotable(hash));
  auto mesh = std::make_shared<core::TriangleMesh>(
      UnpackMesh(row.Bytes(3), static_cast<std::size_t>(row.Integer(1)), row.Bytes(4),
                 static_cast<std::size_t>(row.Integer(2)), where));
  mesh->deviation_mm = Magnitude(row.Real(5), where, "its deviation");
  if (core::ContentHash(*mesh) != hash) FailAsDamaged(where, "it doesn't match its checksum");
  return mesh;
}

std::map<std::string, core::SharedMesh> ReadMeshes(Database& database) {
  Statement rows(database,
                 "SELECT mesh_hash, vertex_count, triangle_count, vertices_mm_zstd, triangles_zstd, "
                 "deviation_mm FROM mesh");
  std::map<std::string, core::SharedMesh> meshes;
  std::size_t packed_bytes = 0, unpacked_bytes = 0;
  while (rows.Next()) {
    const core::SharedMesh mesh = ReadMesh(rows, database.path().string());
    packed_bytes += rows.Bytes(3).size() + rows.Bytes(4).size();
    unpacked_bytes +=
        std::as_bytes(std::span(mesh->vertices_mm)).size() + std::as_bytes(std::span(mesh->triangles)).size();
    if (!IsPlausible(packed_bytes, unpacked_bytes))
      FailAsDamaged(fmt::format("session '{}'", database.path().string()),
                    fmt::format("its meshes claim {} bytes", unpacked_bytes));
    meshes.emplace(rows.Text(0), mesh);
  }
  return meshes;
}

std::vector<core::Part> ReadParts(Database& database) {
  const std::map<std::string, core::SharedMesh> meshes = ReadMeshes(database);
  Statement rows(database,
                 "SELECT name, file, unit, mesh_hash, rotation_world_from_part, position_mm, "
                 "recovery, reference_mm, recovery_axis, recovery_at_mm, unit_of, part_index FROM part "
                 "ORDER BY part_index");
  std::vector<core::Part> parts;
  while (rows.Next()) {
    core::Part part;
    part.name = rows.Text(0);
    part.file = rows.Text(1);
    if (rows.Text(10) == "part") part.unit = UnitFromText(rows.Text(2), database);
    const std::string where =
        fmt::format("session '{}', part '{}'", database.path().string(), Quotable(part.name));
    RequireInTurn(rows.Integer(11), parts.size(), where, "part");
    const auto mesh = meshes.find(rows.Text(3));
    if (mesh == meshes.end()) FailAsDamaged(where, "its mesh is missing");
    part.mesh = mesh->second;
    part.world_from_part.rotation = Rotation(MatrixFromJson(rows.Text(4), where), where, "its rotation");
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
                    "SELECT name, member_index FROM part_group_member JOIN part USING (part_index) "
                    "WHERE group_index = ? ORDER BY member_index");
  const std::string where = fmt::format("session '{}'", database.path().string());
  std::vector<core::Group> result;
  while (groups.Next()) {
    RequireInTurn(groups.Integer(0), result.size(), where, "group");
    core::Group& group = result.emplace_back(core::Group{groups.Text(1), {}});
    for (members.With(groups.Integer(0)); members.Next();) {
      RequireInTurn(members.Integer(1), group.parts.size(), where, "member of a group");
      group.parts.push_back(members.Text(0));
    }
    if (group.parts.empty()) FailAsDamaged(where, "a group has no parts");
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
                 "initial_mm, spacing_index FROM spacing s "
                 "JOIN part m ON m.part_index = moving_part JOIN part r ON r.part_index = reference_part "
                 "LEFT JOIN part_group mg ON mg.group_index = moving_group "
                 "LEFT JOIN part_group rg ON rg.group_index = reference_group "
                 "ORDER BY spacing_index");
  std::vector<core::Spacing> spacings;
  while (rows.Next()) {
    const auto axis = core::ParseAxis(rows.Text(3));
    const std::string where =
        fmt::format("session '{}', spacing '{}'", database.path().string(), Quotable(rows.Text(0)));
    if (!axis) FailAsDamaged(where, fmt::format("no axis is called '{}'", Quotable(rows.Text(3))));
    RequireInTurn(rows.Integer(7), spacings.size(), where, "spacing");
    spacings.push_back({rows.Text(0), rows.Text(1), rows.Text(2), *axis, GapMm(rows.Real(4), where, "min_mm"),
                        GapMm(rows.Real(5), where, "max_mm"), GapMm(rows.Real(6), where, "initial_mm")});
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
      "SELECT a.name, b.name, required_clearance_mm, authorised_contact, ignored, pair_index FROM pair_rule "
      "JOIN part a ON a.part_index = part_a JOIN part b ON b.part_index = part_b ORDER BY pair_index");
  std::vector<core::PairRule> rules;
  const std::string where = fmt::format("session '{}'", database.path().string());
  while (rows.Next()) {
    RequireInTurn(rows.Integer(5), rules.size(), where, "pair");
    rules.push_back({rows.Text(0), rows.Text(1), rows.Real(2), rows.Integer(3) != 0, rows.Integer(4) != 0});
  }
  return rules;
}

// Checks only the rules that calculations rely on, which hold in every file. Rules on names may have become
// stricter since an old file was written.
void RequireUsable(const core::Layout& layout, const std::string& where) {
  try {
    for (const core::Part& part : layout.parts) core::ValidateGivesWay(part.gives_way, "a part");
    for (core::Stream stream : layout.streams) {
      stream.name = "of the layout";
      core::ValidateStream(stream);
    }
  } catch (const core::Error& error) {
    FailAsDamaged(where, Quotable(error.what()));
  }
  for (const core::Spacing& spacing : layout.spacings) {
    if (!(spacing.min_mm <= spacing.initial_mm && spacing.initial_mm <= spacing.max_mm))
      FailAsDamaged(where, fmt::format("spacing '{}' has limits out of order", Quotable(spacing.name)));
  }
}

}  // namespace

core::LengthUnit UnitFromText(const std::string& text, const Database& database) {
  if (const auto unit = core::ParseLengthUnit(text)) return *unit;
  FailAsDamaged(fmt::format("session '{}'", database.path().string()),
                fmt::format("no length unit is called '{}'", Quotable(text)));
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
  RequireUsable(layout, fmt::format("session '{}'", database.path().string()));
  return layout;
}

}  // namespace elbowroom::sessions
