#include "sessions/finding_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/header_rows.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

using Remarks = std::map<core::FindingId, std::vector<core::ReviewRemark>>;

core::Finding FindingOf(const core::Layout& layout, const core::ContactEpisode& episode) {
  return {.id = episode.finding_id,
          .kind = core::FindingKind::kTouch,
          .part = layout.parts[episode.part].name,
          .begin_s = episode.begin_time_s,
          .end_s = episode.end_time_s,
          .place_in_part_mm = episode.peak_position_in_part_mm,
          .presence = core::FindingPresence::kHere,
          .number = episode.id,
          .remarks = {}};
}

core::Finding FindingOf(const core::Layout& layout, const core::NearMiss& miss) {
  return {.id = miss.finding_id,
          .kind = core::FindingKind::kNearMiss,
          .part = layout.parts[miss.part].name,
          .begin_s = miss.begin_time_s,
          .end_s = miss.end_time_s,
          .place_in_part_mm = miss.place_in_part_mm,
          .presence = core::FindingPresence::kHere,
          .number = miss.id,
          .remarks = {}};
}

core::ReviewStatus StatusFrom(const std::string& text, const std::string& where) {
  if (const auto status = core::ParseReviewStatus(text)) return *status;
  FailAsDamaged(where, fmt::format("no status is called '{}'", Quotable(text)));
}

Remarks ReadRemarks(Database& database) {
  Statement rows(
      database,
      "SELECT finding_id, at_utc, by_name, status, comment, exchange_id FROM remark ORDER BY remark_id");
  const std::string where = fmt::format("session '{}', a remark", database.path().string());
  Remarks remarks;
  while (rows.Next()) {
    core::ReviewRemark remark{rows.Text(1), rows.Text(2), std::nullopt, rows.Text(4)};
    if (!rows.IsNull(3)) remark.status = StatusFrom(rows.Text(3), where);
    if (!rows.IsNull(5)) remark.exchange_id = Id(rows.Text(5), where, "its exchange_id");
    remarks[rows.Text(0)].push_back(std::move(remark));
  }
  return remarks;
}

std::vector<core::Finding> ReadAbsentFindings(Database& database) {
  Statement rows(database,
                 "SELECT finding_id, kind, part, begin_time_s, end_time_s, was_checked, part_x_mm, "
                 "part_y_mm, part_z_mm FROM absent_finding ORDER BY begin_time_s, finding_id");
  std::vector<core::Finding> findings;
  while (rows.Next()) {
    core::Finding finding;
    const std::string where =
        fmt::format("session '{}', absent finding {}", database.path().string(), Quotable(rows.Text(0)));
    finding.id = Id(rows.Text(0), where, "its id");
    const auto kind = core::ParseFindingKind(rows.Text(1));
    if (!kind) FailAsDamaged(where, fmt::format("no finding is called '{}'", Quotable(rows.Text(1))));
    finding.kind = *kind;
    finding.part = rows.Text(2);
    finding.begin_s = Time_s(rows.Real(3), where, "its time");
    finding.end_s = Time_s(rows.Real(4), where, "its time");
    finding.presence =
        rows.Integer(5) != 0 ? core::FindingPresence::kGone : core::FindingPresence::kNotChecked;
    if (!rows.IsNull(6)) finding.place_in_part_mm = Position(rows.Vector(6), where, "its place");
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace

void NameFindings(const core::Layout& layout, const std::string& first_recording_id,
                  core::SessionOutcome* outcome) {
  std::set<core::FindingId> taken;
  for (const auto& episode : outcome->episodes) taken.insert(episode.finding_id);
  for (const auto& miss : outcome->near_misses) taken.insert(miss.finding_id);
  const auto name = [&](core::FindingKind kind, auto& finding) {
    if (!finding.finding_id.empty()) return;
    std::string from = first_recording_id;
    do {
      finding.finding_id =
          core::MakeFindingId(from, kind, layout.parts[finding.part].name, finding.begin_frame);
      from += '+';
    } while (!taken.insert(finding.finding_id).second);
  };
  for (core::ContactEpisode& episode : outcome->episodes) name(core::FindingKind::kTouch, episode);
  for (core::NearMiss& miss : outcome->near_misses) name(core::FindingKind::kNearMiss, miss);
}

void InsertAbsentFindings(Database& database, std::span<const core::Finding> findings) {
  Statement insert(database, "INSERT INTO absent_finding VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const core::Finding& finding : findings) {
    core::Require(finding.presence != core::FindingPresence::kHere, "an absent finding isn't here");
    insert
        .With(finding.id, core::ToString(finding.kind), finding.part, finding.begin_s, finding.end_s,
              finding.place_in_part_mm, finding.presence == core::FindingPresence::kGone)
        .Run();
  }
}

void InsertRemark(Database& database, const core::FindingId& finding, const core::ReviewRemark& remark) {
  const auto status = remark.status ? std::optional(core::ToString(*remark.status)) : std::nullopt;
  const auto exchange_id =
      remark.exchange_id.empty() ? std::nullopt : std::optional<std::string>(remark.exchange_id);
  Statement(database,
            "INSERT INTO remark (finding_id, at_utc, by_name, status, comment, exchange_id) "
            "VALUES (?, ?, ?, ?, ?, ?)")
      .With(finding, remark.at_utc, remark.by, status, remark.comment, exchange_id)
      .Run();
}

void InsertFootage(Database& database, std::span<const core::FootageFile> files) {
  Statement insert(database, "INSERT INTO footage VALUES (?, ?, ?, ?)");
  for (std::size_t i = 0; i < files.size(); ++i)
    insert.With(i, files[i].file, files[i].bytes, std::span<const std::byte>(files[i].content_hash)).Run();
}

std::vector<core::Finding> ReadFindings(Database& database, const core::Layout& layout,
                                        const core::SessionOutcome& outcome) {
  std::vector<core::Finding> findings;
  for (const core::ContactEpisode& episode : outcome.episodes) findings.push_back(FindingOf(layout, episode));
  for (const core::NearMiss& miss : outcome.near_misses) findings.push_back(FindingOf(layout, miss));
  for (core::Finding& absent : ReadAbsentFindings(database)) findings.push_back(std::move(absent));
  Remarks remarks = ReadRemarks(database);
  for (core::Finding& finding : findings) {
    const auto said = remarks.find(finding.id);
    if (said != remarks.end()) finding.remarks = std::move(said->second);
  }
  std::ranges::stable_sort(findings, {}, &core::Finding::begin_s);
  return findings;
}

std::vector<core::FootageFile> ReadFootage(Database& database) {
  Statement rows(database, "SELECT file, bytes, content_hash FROM footage ORDER BY footage_index");
  std::vector<core::FootageFile> files;
  while (rows.Next()) {
    core::FootageFile file;
    file.file = rows.Text(0);
    file.bytes = rows.Integer(1);
    const std::span<const std::byte> hash = rows.Bytes(2);
    if (hash.size() != file.content_hash.size())
      FailAsDamaged(fmt::format("session '{}', its footage", database.path().string()),
                    "a checksum doesn't have 16 bytes");
    std::ranges::copy(hash, file.content_hash.begin());
    files.push_back(std::move(file));
  }
  return files;
}

std::string FirstRecordingId(Database& database, const core::SessionHeader& header) {
  if (header.origin) return header.origin->first_recording_id;
  // Older programs gave sessions no id.
  return ReadRecordingId(database).value_or(
      fmt::format("{}|{}|{}", header.started_at_utc, header.rig.name, header.trial.participant));
}

}  // namespace elbowroom::sessions
