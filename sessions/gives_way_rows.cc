#include "sessions/gives_way_rows.h"

#include <fmt/format.h>

#include <string>
#include <variant>

#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/packing.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

core::GivesWay& GivesWayOf(core::Layout* layout, std::int64_t part, const std::string& where) {
  return layout->parts[IndexBelow(part, layout->parts.size(), where, "part")].gives_way;
}

std::vector<core::BoundsSide> PinsFromJson(const std::string& json, const std::string& where) {
  std::vector<core::BoundsSide> pins;
  for (const std::string& text : TextsFromJson(json, where)) {
    const auto side = core::ParseBoundsSide(text);
    if (!side) FailAsDamaged(where, fmt::format("no side is called '{}'", Quotable(text)));
    pins.push_back(*side);
  }
  return pins;
}

void InsertCloth(Database& database, core::PartIndex part, const core::ClothRule& rule) {
  std::vector<std::string> pins;
  for (const core::BoundsSide side : rule.pins) pins.emplace_back(core::ToString(side));
  Statement(database, "INSERT INTO cloth VALUES (?, ?, ?, ?, ?, ?, ?)")
      .With(part, JsonFrom(pins), rule.stretch_stiffness_n_per_m, rule.bending_stiffness_n_per_m,
            rule.mass_per_area_kg_per_m2, rule.damping_per_s, rule.friction)
      .Run();
}

void ReadCloths(Database& database, const std::string& where, core::Layout* layout) {
  Statement rows(database,
                 "SELECT part_index, pins, stretch_stiffness_n_per_m, bending_stiffness_n_per_m, "
                 "mass_per_area_kg_per_m2, damping_per_s, friction FROM cloth");
  while (rows.Next()) {
    GivesWayOf(layout, rows.Integer(0), where) = core::ClothRule{PinsFromJson(rows.Text(1), where),
                                                                 rows.Real(2),
                                                                 rows.Real(3),
                                                                 rows.Real(4),
                                                                 rows.Real(5),
                                                                 rows.Real(6)};
  }
}

}  // namespace

void InsertGivesWay(Database& database, const core::Layout& layout) {
  for (core::PartIndex i = 0; i < layout.parts.size(); ++i) {
    const core::GivesWay& gives_way = layout.parts[i].gives_way;
    if (const auto* cloth = std::get_if<core::ClothRule>(&gives_way)) InsertCloth(database, i, *cloth);
    if (const auto* push = std::get_if<core::PushRule>(&gives_way))
      Statement(database, "INSERT INTO pushed VALUES (?, ?)").With(i, push->max_speed_mm_per_s).Run();
  }
  Statement insert(database, "INSERT INTO stream VALUES (?, ?, ?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < layout.streams.size(); ++i) {
    const core::Stream& stream = layout.streams[i];
    insert
        .With(i, stream.name, JsonFrom(stream.position_mm), JsonFrom(stream.direction), stream.rate_per_s,
              stream.speed_mm_per_s, stream.radius_mm)
        .Run();
  }
}

void ReadGivesWay(Database& database, core::Layout* layout) {
  const std::string where = fmt::format("session '{}'", database.path().string());
  ReadCloths(database, where, layout);
  Statement pushed(database, "SELECT part_index, max_speed_mm_per_s FROM pushed");
  while (pushed.Next())
    GivesWayOf(layout, pushed.Integer(0), where) = core::PushRule{.max_speed_mm_per_s = pushed.Real(1)};
  Statement streams(
      database,
      "SELECT name, position_mm, direction, rate_per_s, speed_mm_per_s, radius_mm, stream_index FROM stream "
      "ORDER BY stream_index");
  while (streams.Next()) {
    const std::string of_stream = fmt::format("{}, stream '{}'", where, Quotable(streams.Text(0)));
    RequireInTurn(streams.Integer(6), layout->streams.size(), where, "stream");
    layout->streams.push_back({streams.Text(0), VectorFromJson(streams.Text(1), of_stream),
                               VectorFromJson(streams.Text(2), of_stream), streams.Real(3), streams.Real(4),
                               streams.Real(5)});
  }
}

}  // namespace elbowroom::sessions
