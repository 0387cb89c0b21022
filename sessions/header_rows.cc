#include "sessions/header_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "core/error.h"
#include "core/procedure/answers.h"
#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/layout_rows.h"
#include "sessions/packing.h"
#include "sessions/questionnaire_rows.h"
#include "sessions/rig_quality_rows.h"
#include "sessions/rig_rows.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

constexpr const char* kRecordingIdKey = "recording.id";
// Of a trial among those of one participant. Far beyond what a TRIAL.toml may say: only a damaged file has
// more.
constexpr std::size_t kOrderLimit = 1'000'000;

void InsertSessionRow(Database& database, const core::SessionHeader& header) {
  Statement insert(
      database,
      "INSERT INTO session (id, status, started_at_utc, participant, task, estimate_mm, "
      "required_clearance_mm, rig_name, workspace_min_x_mm, workspace_min_y_mm, workspace_min_z_mm, "
      "workspace_max_x_mm, workspace_max_y_mm, workspace_max_z_mm, unseen, layout_unit, uncertainty_mm, "
      "condition, trial_order, block) "
      "VALUES (1, 'recording', ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  const core::TrialInfo& trial = header.trial;
  const core::Rig& rig = header.rig;
  insert
      .With(header.started_at_utc, trial.participant, trial.task, trial.estimate_mm,
            trial.required_clearance_mm, rig.name, rig.workspace_mm.min(), rig.workspace_mm.max(),
            rig.unseen == core::UnseenPolicy::kAbstain ? "abstain" : "outside",
            core::ToString(header.layout.unit), trial.uncertainty_mm, trial.condition, trial.order,
            trial.block)
      .Run();
}

void ReadSessionRow(Database& database, core::SessionHeader& header) {
  Statement row(
      database,
      "SELECT started_at_utc, participant, task, estimate_mm, required_clearance_mm, rig_name, unseen, "
      "layout_unit, workspace_min_x_mm, workspace_min_y_mm, workspace_min_z_mm, workspace_max_x_mm, "
      "workspace_max_y_mm, workspace_max_z_mm, uncertainty_mm, condition, trial_order, block "
      "FROM session");
  if (!row.Next()) {
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format("session '{}' is empty: it holds no set-up; check the path", database.path().string()));
  }
  header.started_at_utc = row.Text(0);
  header.trial.participant = row.Text(1);
  header.trial.task = row.Text(2);
  const std::string where = fmt::format("session '{}'", database.path().string());
  header.trial.estimate_mm = GapMm(row.Real(3), where, "the estimate");
  header.trial.required_clearance_mm = GapMm(row.Real(4), where, "the required clearance");
  header.rig.name = row.Text(5);
  header.rig.unseen = row.Text(6) == "abstain" ? core::UnseenPolicy::kAbstain : core::UnseenPolicy::kOutside;
  header.layout.unit = UnitFromText(row.Text(7), database);
  header.trial.uncertainty_mm = Magnitude(row.Real(14), where, "the uncertainty");
  header.trial.condition = row.Text(15);
  header.trial.order = static_cast<int>(IndexBelow(row.Integer(16), kOrderLimit, where, "the trial's order"));
  header.trial.block = row.Text(17);
  header.rig.workspace_mm = Eigen::AlignedBox3d(row.Vector(8), row.Vector(11));
  (void)Position(header.rig.workspace_mm.min(), where, "its workspace");
  (void)Position(header.rig.workspace_mm.max(), where, "its workspace");
  if (!(header.rig.workspace_mm.sizes().minCoeff() > 0.0)) FailAsDamaged(where, "its workspace is empty");
}

void InsertOrigin(Database& database, const core::SessionOrigin& origin) {
  Statement(database, "INSERT INTO origin VALUES (1, ?, ?, ?, ?, ?)")
      .With(origin.file, origin.recording_id, origin.first_recording_id, origin.replayed_at_utc,
            JsonFrom(origin.changes))
      .Run();
}

std::optional<core::SessionOrigin> ReadOrigin(Database& database) {
  Statement row(database,
                "SELECT file, recording_id, first_recording_id, replayed_at_utc, changes FROM origin");
  if (!row.Next()) return std::nullopt;
  const std::string where = fmt::format("session '{}', its origin", database.path().string());
  return core::SessionOrigin{row.Text(0), row.Text(1), row.Text(2), row.Text(3),
                             TextsFromJson(row.Text(4), where)};
}

void InsertProcedure(Database& database, const core::TrialInfo& trial) {
  Statement insert_step(database, "INSERT INTO step VALUES (?, ?)");
  for (std::size_t i = 0; i < trial.steps.size(); ++i) insert_step.With(i, trial.steps[i]).Run();
  Statement insert_item(database, "INSERT INTO survey_item VALUES (?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < trial.survey.size(); ++i) {
    const core::SurveyItem& item = trial.survey[i];
    insert_item.With(i, core::ToString(item.when), item.item, item.least, item.most).Run();
  }
}

void ReadProcedure(Database& database, core::TrialInfo& trial) {
  const std::string where = fmt::format("session '{}', its procedure", database.path().string());
  Statement steps(database, "SELECT step_index, name FROM step ORDER BY step_index");
  while (steps.Next()) {
    RequireInTurn(steps.Integer(0), trial.steps.size(), where, "step");
    trial.steps.push_back(steps.Text(1));
  }
  Statement items(database,
                  "SELECT item_index, asked, item, least, most FROM survey_item ORDER BY item_index");
  while (items.Next()) {
    RequireInTurn(items.Integer(0), trial.survey.size(), where, "item");
    const auto when = core::ParseAskedWhen(items.Text(1));
    const std::int64_t least = items.Integer(3), most = items.Integer(4);
    if (!when || most <= least || std::max(std::abs(least), std::abs(most)) > core::kWidestScale)
      FailAsDamaged(where, fmt::format("item {} is none that a survey has", trial.survey.size()));
    trial.survey.push_back({*when, items.Text(2), static_cast<int>(least), static_cast<int>(most)});
  }
}

void InsertTexts(Database& database, const std::string& table,
                 const std::map<std::string, std::string>& texts) {
  Statement insert(database, "INSERT INTO " + table + " VALUES (?, ?)");
  for (const auto& [key, value] : texts) insert.With(key, value).Run();
}

std::map<std::string, std::string> ReadTexts(Database& database, const std::string& table) {
  Statement rows(database, "SELECT * FROM " + table);
  std::map<std::string, std::string> texts;
  while (rows.Next()) texts.emplace(rows.Text(0), rows.Text(1));
  return texts;
}

}  // namespace

void InsertHeader(Database& database, const core::SessionHeader& header) {
  InsertSessionRow(database, header);
  InsertTexts(database, "setting", header.settings);
  InsertTexts(database, "version", header.versions);
  Statement insert_tool(database, "INSERT INTO tool VALUES (?, ?)");
  for (std::size_t i = 0; i < header.trial.tools.size(); ++i)
    insert_tool.With(i, header.trial.tools[i]).Run();
  InsertProcedure(database, header.trial);
  InsertQuestionnaires(database, header.trial.questionnaires);
  InsertCameras(database, header.rig.cameras);
  InsertRigQuality(database, header.rig_quality);
  InsertLayout(database, header.layout);
  if (header.origin) InsertOrigin(database, *header.origin);
}

core::SessionHeader ReadHeader(Database& database) {
  core::SessionHeader header;
  header.layout = ReadLayout(database);
  ReadSessionRow(database, header);
  header.settings = ReadTexts(database, "setting");
  header.settings.erase(kRecordingIdKey);
  header.versions = ReadTexts(database, "version");
  Statement tools(database, "SELECT name FROM tool ORDER BY tool_index");
  while (tools.Next()) header.trial.tools.push_back(tools.Text(0));
  ReadProcedure(database, header.trial);
  header.trial.questionnaires = ReadQuestionnaires(database);
  header.rig.cameras = ReadCameras(database);
  if (header.rig.cameras.empty())
    FailAsDamaged(fmt::format("session '{}'", database.path().string()), "it has no camera");
  header.rig_quality = ReadRigQuality(database, header.rig);
  header.origin = ReadOrigin(database);
  return header;
}

std::string MakeRecordingId(Database& database) {
  Statement row(database, "SELECT lower(hex(randomblob(16)))");
  core::Require(row.Next(), "SQLite gives a random number");
  return row.Text(0);
}

void InsertRecordingId(Database& database, const std::string& id) {
  Statement(database, "INSERT INTO setting VALUES (?, ?)").With(std::string_view(kRecordingIdKey), id).Run();
}

std::optional<std::string> ReadRecordingId(Database& database) {
  Statement row(database, "SELECT value FROM setting WHERE key = ?");
  if (!row.With(std::string_view(kRecordingIdKey)).Next()) return std::nullopt;
  return row.Text(0);
}

}  // namespace elbowroom::sessions
