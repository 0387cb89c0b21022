#include "sessions/session_reader.h"

#include <utility>

#include "sessions/database.h"
#include "sessions/frame_rows.h"
#include "sessions/header_rows.h"
#include "sessions/outcome_rows.h"
#include "sessions/schema.h"
#include "sessions/session_opening.h"
#include "sessions/statement.h"

namespace elbowroom::sessions {
namespace {

constexpr std::string_view kStatusNames[] = {"recording", "cut off", "complete", "abandoned"};

// Brought up to date in memory.
OpenedSession OpenUpToDate(const std::filesystem::path& path) {
  OpenedSession opened = OpenSession(path);
  RequireReadableSession(opened.database);
  if (opened.database.ReadInteger("PRAGMA user_version") == kSchemaVersion) return opened;
  Database copy = opened.database.CopyInMemory();
  Migrate(copy);
  return {std::move(copy), opened.is_in_use};
}

}  // namespace

std::string_view ToString(SessionStatus status) { return kStatusNames[static_cast<std::size_t>(status)]; }

struct SessionReader::Impl {
  explicit Impl(const std::filesystem::path& path)
      : opened(OpenUpToDate(path)), header(ReadHeader(database)) {}

  OpenedSession opened;
  Database& database = opened.database;
  core::SessionHeader header;
  std::optional<core::SessionOutcome> adopted;
};

SessionReader::SessionReader(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
SessionReader::~SessionReader() = default;
SessionReader::SessionReader(SessionReader&&) noexcept = default;
SessionReader& SessionReader::operator=(SessionReader&&) noexcept = default;

const std::filesystem::path& SessionReader::path() const { return impl_->database.path(); }
const core::SessionHeader& SessionReader::header() const { return impl_->header; }

SessionStatus SessionReader::status() const {
  Statement row(impl_->database, "SELECT status FROM session");
  const std::string text = row.Next() ? row.Text(0) : "";
  return text == "complete"        ? SessionStatus::kComplete
         : text == "abandoned"     ? SessionStatus::kAbandoned
         : impl_->opened.is_in_use ? SessionStatus::kRecording
                                   : SessionStatus::kCutOff;
}

std::optional<std::string> SessionReader::ended_at_utc() const {
  Statement row(impl_->database, "SELECT ended_at_utc FROM session WHERE ended_at_utc IS NOT NULL");
  if (!row.Next()) return std::nullopt;
  return row.Text(0);
}

std::int64_t SessionReader::frame_count() const {
  return impl_->database.ReadInteger("SELECT count(*) FROM frame");
}

std::vector<FrameSummary> SessionReader::frames() const {
  Statement rows(
      impl_->database,
      "SELECT frame_index, time_s, spacing_mm FROM frame LEFT JOIN frame_spacing USING (frame_index) "
      "ORDER BY frame_index, spacing_index");
  std::vector<FrameSummary> frames;
  while (rows.Next()) {
    if (frames.empty() || frames.back().frame != rows.Integer(0))
      frames.push_back({rows.Integer(0), rows.Real(1), {}});
    if (!rows.IsNull(2)) frames.back().spacing_mm.push_back(rows.Real(2));
  }
  return frames;
}

core::FrameRecord SessionReader::ReadFrame(core::FrameIndex frame) const {
  return sessions::ReadFrame(impl_->database, impl_->header, frame);
}

void SessionReader::Freeze() {
  impl_->database.Execute("BEGIN");
  (void)frame_count();  // the transaction's view is that of its first statement
}

bool SessionReader::has_outcome() const { return impl_->adopted || status() == SessionStatus::kComplete; }

void SessionReader::AdoptOutcome(core::SessionOutcome outcome) { impl_->adopted = std::move(outcome); }

std::vector<core::SessionEvent> SessionReader::events() const { return ReadEvents(impl_->database); }
std::vector<core::ContactEpisode> SessionReader::episodes() const {
  return impl_->adopted ? impl_->adopted->episodes : ReadEpisodes(impl_->database);
}
std::vector<core::NearMiss> SessionReader::near_misses() const {
  return impl_->adopted ? impl_->adopted->near_misses : ReadNearMisses(impl_->database);
}
std::vector<core::HeatMap> SessionReader::heat_maps() const {
  return impl_->adopted ? impl_->adopted->heat_maps : ReadHeatMaps(impl_->database, impl_->header.layout);
}
std::vector<ContactRow> SessionReader::contacts() const { return ReadContactRows(impl_->database); }
std::vector<ContactRow> SessionReader::clearances() const { return ReadClearanceRows(impl_->database); }
std::vector<PartTotals> SessionReader::part_totals() const { return ReadPartTotals(impl_->database); }

}  // namespace elbowroom::sessions
