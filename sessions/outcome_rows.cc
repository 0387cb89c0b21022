#include "sessions/outcome_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/surface_patches.h"
#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/packing.h"
#include "sessions/recorded_contacts.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

// Far below any size that is written. Patches of a smaller size would be more than memory holds.
constexpr double kLeastPatchMm = 0.1;

// Throws unless begin, middle and end of an episode or near miss are in order, as frames and as times.
template <typename Lasting>
void RequireInOrder(const Lasting& it, core::FrameIndex middle_frame, double middle_s,
                    const std::string& where) {
  if (it.begin_frame < 0 || it.begin_frame > middle_frame || middle_frame > it.end_frame)
    FailAsDamaged(where, "its frames aren't in order");
  for (const double time_s : {it.begin_time_s, middle_s, it.end_time_s})
    (void)Time_s(time_s, where, "a time");
  if (it.begin_time_s > middle_s || middle_s > it.end_time_s)
    FailAsDamaged(where, "its times aren't in order");
}

core::ContactEpisode ReadEpisode(const Statement& row, const core::Layout& layout, const std::string& where) {
  core::ContactEpisode episode;
  episode.id = row.Integer(0);
  episode.part = IndexBelow(row.Integer(1), layout.parts.size(), where, "part");
  episode.begin_frame = row.Integer(2);
  episode.peak_frame = row.Integer(3);
  episode.end_frame = row.Integer(4);
  episode.begin_time_s = row.Real(5);
  episode.peak_time_s = row.Real(6);
  episode.end_time_s = row.Real(7);
  RequireInOrder(episode, episode.peak_frame, episode.peak_time_s, where);
  episode.frames_in_contact = CountFrom(1, row.Integer(8), where, "its number of frames");
  episode.peak_depth_mm = Magnitude(row.Real(9), where, "its depth");
  episode.peak_area_mm2 = Magnitude(row.Real(10), where, "its area");
  episode.peak_position_in_world_mm = Position(row.Vector(11), where, "its place");
  if (!row.IsNull(14)) episode.peak_position_in_part_mm = row.Vector(14);
  episode.tools = TextsFromJson(row.Text(17), where);
  if (!row.IsNull(18)) episode.finding_id = Id(row.Text(18), where, "its id as a finding");
  return episode;
}

core::NearMiss ReadNearMiss(const Statement& row, const core::Layout& layout, const std::string& where) {
  core::NearMiss miss;
  miss.id = row.Integer(0);
  miss.part = IndexBelow(row.Integer(1), layout.parts.size(), where, "part");
  miss.begin_frame = row.Integer(2);
  miss.closest_frame = row.Integer(3);
  miss.end_frame = row.Integer(4);
  miss.begin_time_s = row.Real(5);
  miss.closest_time_s = row.Real(6);
  miss.end_time_s = row.Real(7);
  RequireInOrder(miss, miss.closest_frame, miss.closest_time_s, where);
  miss.frames_below = CountFrom(1, row.Integer(8), where, "its number of frames");
  const std::optional<core::Verdict> verdict = core::ParseVerdict(row.Text(9));
  if (verdict != core::Verdict::kNear && verdict != core::Verdict::kUndecided)
    FailAsDamaged(where, fmt::format("its verdict is '{}'", Quotable(row.Text(9))));
  miss.verdict = *verdict;
  miss.spacing_at_closest_mm = NumbersFromJson(row.Text(10), where);
  if (miss.spacing_at_closest_mm.size() != layout.spacings.size())
    FailAsDamaged(where, "its spacings aren't those of the layout");
  for (const double spacing_mm : miss.spacing_at_closest_mm) (void)GapMm(spacing_mm, where, "a spacing");
  miss.tools = TextsFromJson(row.Text(11), where);
  if (!row.IsNull(12)) miss.finding_id = Id(row.Text(12), where, "its id as a finding");
  if (!row.IsNull(13)) miss.place_in_part_mm = Position(row.Vector(13), where, "its place");
  return miss;
}

void InsertEpisodes(Database& database, std::span<const core::ContactEpisode> episodes) {
  Statement insert(database,
                   "INSERT INTO episode VALUES "
                   "(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement insert_spacing(database, "INSERT INTO episode_spacing VALUES (?, ?, ?)");
  for (const core::ContactEpisode& episode : episodes) {
    insert
        .With(episode.id, episode.part, episode.begin_frame, episode.peak_frame, episode.end_frame,
              episode.begin_time_s, episode.peak_time_s, episode.end_time_s, episode.frames_in_contact,
              episode.peak_depth_mm, episode.peak_area_mm2, episode.peak_position_in_world_mm,
              episode.peak_position_in_part_mm, JsonFrom(episode.tools), episode.finding_id)
        .Run();
    for (core::SpacingIndex i = 0; i < episode.spacing_at_peak_mm.size(); ++i) {
      insert_spacing.With(episode.id, i, episode.spacing_at_peak_mm[i]).Run();
    }
  }
}

void InsertNearMisses(Database& database, std::span<const core::NearMiss> misses) {
  Statement insert(database, "INSERT INTO near_miss VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const core::NearMiss& miss : misses) {
    insert
        .With(miss.id, miss.part, miss.begin_frame, miss.closest_frame, miss.end_frame, miss.begin_time_s,
              miss.closest_time_s, miss.end_time_s, miss.frames_below, core::ToString(miss.verdict),
              JsonFrom(miss.spacing_at_closest_mm), JsonFrom(miss.tools), miss.finding_id,
              miss.place_in_part_mm)
        .Run();
  }
}

void InsertHeatMaps(Database& database, std::span<const core::HeatMap> maps) {
  Statement insert(database, "INSERT INTO heat_map VALUES (?, ?, ?, ?, ?)");
  Compressor compressor;
  for (const core::HeatMap& map : maps) {
    const Bytes dwell_s = Pack(map.dwell_s, compressor), depth_mm = Pack(map.peak_depth_mm, compressor);
    insert
        .With(map.part, map.patch_mm, map.dwell_s.size(), std::span<const std::byte>(dwell_s),
              std::span<const std::byte>(depth_mm))
        .Run();
  }
}

}  // namespace

void InsertOutcome(Database& database, const core::SessionOutcome& outcome) {
  InsertEpisodes(database, outcome.episodes);
  InsertNearMisses(database, outcome.near_misses);
  InsertHeatMaps(database, outcome.heat_maps);
}

std::vector<core::ContactEpisode> ReadEpisodes(Database& database, const core::Layout& layout) {
  Statement rows(database, "SELECT * FROM episode ORDER BY episode_id");
  Statement spacings(database,
                     "SELECT spacing_index, spacing_at_peak_mm FROM episode_spacing WHERE episode_id = ? "
                     "ORDER BY spacing_index");
  std::vector<core::ContactEpisode> episodes;
  while (rows.Next()) {
    const std::string where =
        fmt::format("session '{}', episode {}", database.path().string(), rows.Integer(0));
    core::ContactEpisode episode = ReadEpisode(rows, layout, where);
    for (spacings.With(episode.id); spacings.Next();) {
      RequireInTurn(spacings.Integer(0), episode.spacing_at_peak_mm.size(), where, "spacing");
      episode.spacing_at_peak_mm.push_back(GapMm(spacings.Real(1), where, "a spacing"));
    }
    if (episode.spacing_at_peak_mm.size() != layout.spacings.size())
      FailAsDamaged(where, "rows of spacings are missing");
    episodes.push_back(std::move(episode));
  }
  return episodes;
}

std::vector<core::NearMiss> ReadNearMisses(Database& database, const core::Layout& layout) {
  Statement rows(database, "SELECT * FROM near_miss ORDER BY near_miss_id");
  std::vector<core::NearMiss> misses;
  while (rows.Next()) {
    const std::string where =
        fmt::format("session '{}', near miss {}", database.path().string(), rows.Integer(0));
    core::NearMiss miss = ReadNearMiss(rows, layout, where);
    const std::vector<core::PartContact> contacts =
        ReadContacts(database, layout.parts.size(), miss.closest_frame);
    if (miss.part >= contacts.size() || !contacts[miss.part].clearance)
      FailAsDamaged(where, "its closest frame has no clearance");
    miss.closest = *contacts[miss.part].clearance;
    misses.push_back(std::move(miss));
  }
  return misses;
}

std::vector<core::HeatMap> ReadHeatMaps(Database& database, const core::Layout& layout) {
  Statement rows(database, "SELECT * FROM heat_map ORDER BY part_index");
  std::vector<core::HeatMap> maps;
  while (rows.Next()) {
    const std::string where =
        fmt::format("session '{}', heat map of part {}", database.path().string(), rows.Integer(0));
    core::HeatMap map;
    map.part = IndexBelow(rows.Integer(0), layout.parts.size(), where, "part");
    map.patch_mm = rows.Real(1);
    if (!(map.patch_mm >= kLeastPatchMm)) FailAsDamaged(where, "its patches have no size");
    const auto count =
        static_cast<std::size_t>(CountFrom(1, rows.Integer(2), where, "its number of patches"));
    map.dwell_s = UnpackFloats(rows.Bytes(3), count, where);
    map.peak_depth_mm = UnpackFloats(rows.Bytes(4), count, where);
    const auto is_none = [](float value) { return !(value >= 0.0F && std::isfinite(value)); };
    if (std::ranges::any_of(map.dwell_s, is_none) || std::ranges::any_of(map.peak_depth_mm, is_none))
      FailAsDamaged(where, "it holds what is no time or depth");
    if (core::SurfacePatches(layout.parts[map.part].mesh, map.patch_mm).size() != count)
      FailAsDamaged(where, "it isn't one of its part's mesh");
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace elbowroom::sessions
