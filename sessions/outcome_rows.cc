#include "sessions/outcome_rows.h"

#include "sessions/statement.h"

namespace elbowroom::sessions {
namespace {

core::SessionEvent ReadEvent(const Statement& row) {
  core::SessionEvent event;
  event.frame = row.Integer(0);
  event.time_s = row.Real(1);
  const std::string kind = row.Text(2);
  if (kind == "spacing") {
    event.what = core::SpacingChanged{row.Text(3), row.Real(4), row.Real(5)};
  } else if (kind == "tool") {
    event.what = core::ToolMarked{row.Text(6), row.Integer(7) != 0};
  } else {
    event.what = core::Note{row.Text(8)};
  }
  return event;
}

core::ContactEpisode ReadEpisode(const Statement& row) {
  core::ContactEpisode episode;
  episode.id = row.Integer(0);
  episode.part = static_cast<core::PartIndex>(row.Integer(1));
  episode.begin_frame = row.Integer(2);
  episode.peak_frame = row.Integer(3);
  episode.end_frame = row.Integer(4);
  episode.begin_time_s = row.Real(5);
  episode.peak_time_s = row.Real(6);
  episode.end_time_s = row.Real(7);
  episode.frames_in_contact = row.Integer(8);
  episode.peak_depth_mm = row.Real(9);
  episode.peak_area_mm2 = row.Real(10);
  episode.peak_position_in_world_mm = row.Vector(11);
  return episode;
}

}  // namespace

void InsertEvent(Database& database, const core::Layout& layout, const core::SessionEvent& event) {
  const auto insert = [&](const char* columns, const char* kind, const auto&... values) {
    Statement statement(database, std::string("INSERT INTO event (frame_index, time_s, kind, ") + columns);
    statement.With(event.frame, event.time_s, kind, values...).Run();
  };
  if (const auto* change = std::get_if<core::SpacingChanged>(&event.what)) {
    insert("spacing_index, from_mm, to_mm) VALUES (?, ?, ?, ?, ?, ?)", "spacing",
           layout.FindSpacing(change->spacing), change->from_mm, change->to_mm);
  } else if (const auto* mark = std::get_if<core::ToolMarked>(&event.what)) {
    insert("tool, in_use) VALUES (?, ?, ?, ?, ?)", "tool", mark->tool, mark->in_use);
  } else if (const auto* note = std::get_if<core::Note>(&event.what)) {
    insert("note) VALUES (?, ?, ?, ?)", "note", note->text);
  }
}

void InsertEpisodes(Database& database, std::span<const core::ContactEpisode> episodes) {
  Statement insert(database, "INSERT INTO episode VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement insert_spacing(database, "INSERT INTO episode_spacing VALUES (?, ?, ?)");
  for (const core::ContactEpisode& episode : episodes) {
    insert
        .With(episode.id, episode.part, episode.begin_frame, episode.peak_frame, episode.end_frame,
              episode.begin_time_s, episode.peak_time_s, episode.end_time_s, episode.frames_in_contact,
              episode.peak_depth_mm, episode.peak_area_mm2, episode.peak_position_in_world_mm)
        .Run();
    for (core::SpacingIndex i = 0; i < episode.spacing_at_peak_mm.size(); ++i) {
      insert_spacing.With(episode.id, i, episode.spacing_at_peak_mm[i]).Run();
    }
  }
}

std::vector<core::SessionEvent> ReadEvents(Database& database) {
  Statement rows(database,
                 "SELECT frame_index, time_s, kind, name, from_mm, to_mm, tool, in_use, note "
                 "FROM event LEFT JOIN spacing USING (spacing_index) ORDER BY frame_index, event_id");
  std::vector<core::SessionEvent> events;
  while (rows.Next()) events.push_back(ReadEvent(rows));
  return events;
}

std::vector<core::ContactEpisode> ReadEpisodes(Database& database) {
  Statement rows(database, "SELECT * FROM episode ORDER BY episode_id");
  Statement spacings(
      database, "SELECT spacing_at_peak_mm FROM episode_spacing WHERE episode_id = ? ORDER BY spacing_index");
  std::vector<core::ContactEpisode> episodes;
  while (rows.Next()) {
    episodes.push_back(ReadEpisode(rows));
    for (spacings.With(episodes.back().id); spacings.Next();) {
      episodes.back().spacing_at_peak_mm.push_back(spacings.Real(0));
    }
  }
  return episodes;
}

}  // namespace elbowroom::sessions
