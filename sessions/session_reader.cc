#include "sessions/session_reader.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "core/error.h"
#include "sessions/database/damage.h"
#include "sessions/database/database.h"
#include "sessions/database/query_limit.h"
#include "sessions/database/statement.h"
#include "sessions/event_rows.h"
#include "sessions/finding_rows.h"
#include "sessions/frame_rows.h"
#include "sessions/header_rows.h"
#include "sessions/outcome_rows.h"
#include "sessions/row_rules.h"
#include "sessions/sound_session.h"

namespace elbowroom::sessions {
namespace {

constexpr std::string_view kStatusNames[] = {"recording", "cut off", "complete", "abandoned"};

std::vector<FrameSummary> ReadFrameSummaries(Database& database, const core::SessionHeader& header) {
  Statement rows(
      database,
      "SELECT frame_index, time_s, spacing_index, spacing_mm "
      "FROM frame LEFT JOIN frame_spacing USING (frame_index) ORDER BY frame_index, spacing_index");
  std::vector<FrameSummary> frames;
  const auto where = [&](core::FrameIndex frame) {
    return fmt::format("session '{}', frame {}", database.path().string(), frame);
  };
  const auto require_whole = [&] {
    if (!frames.empty() && frames.back().spacing_mm.size() != header.layout.spacings.size())
      FailAsDamaged(where(frames.back().frame), "rows of spacings are missing");
  };
  while (rows.Next()) {
    const core::FrameIndex frame = rows.Integer(0);
    if (frames.empty() || frames.back().frame != frame) {
      require_whole();
      const double time_s = Time_s(rows.Real(1), where(frame), "its time");
      if (frame < 0) FailAsDamaged(where(frame), "no frame has that number");
      if (!frames.empty() && time_s < frames.back().time_s)
        FailAsDamaged(where(frame), "its time is before that of the frame before it");
      frames.push_back({frame, time_s, {}});
    }
    if (rows.IsNull(2)) continue;
    RequireInTurn(rows.Integer(2), frames.back().spacing_mm.size(), where(frame), "spacing");
    frames.back().spacing_mm.push_back(GapMm(rows.Real(3), where(frame), "a spacing"));
  }
  require_whole();
  return frames;
}

}  // namespace

std::string_view ToString(SessionStatus status) { return kStatusNames[static_cast<std::size_t>(status)]; }

struct SessionReader::Impl {
  Impl(const std::filesystem::path& path, const std::stop_token& stop) : file(path, stop) {
    header = limit.Guarded([&] { return ReadHeader(database); });
  }

  // Rows of older programs have no ids of findings: these get them here.
  [[nodiscard]] core::SessionOutcome Named(core::SessionOutcome outcome) {
    NameFindings(header.layout, FirstRecordingId(database, header), &outcome);
    return outcome;
  }
  [[nodiscard]] std::vector<core::ContactEpisode> NamedEpisodes() {
    return Named({adopted ? adopted->episodes : ReadEpisodes(database, header.layout), {}, {}}).episodes;
  }
  [[nodiscard]] std::vector<core::NearMiss> NamedNearMisses() {
    return Named({{}, adopted ? adopted->near_misses : ReadNearMisses(database, header.layout), {}})
        .near_misses;
  }

  SoundSession file;
  Database& database = file.database();
  const QueryLimit& limit = file.limit();
  core::SessionHeader header;
  std::optional<core::SessionOutcome> adopted;
};

SessionReader::SessionReader(const std::filesystem::path& path, const std::stop_token& stop)
    : impl_(std::make_unique<Impl>(path, stop)) {}
SessionReader::~SessionReader() = default;
SessionReader::SessionReader(SessionReader&&) noexcept = default;
SessionReader& SessionReader::operator=(SessionReader&&) noexcept = default;

const std::filesystem::path& SessionReader::path() const { return impl_->database.path(); }
const core::SessionHeader& SessionReader::header() const { return impl_->header; }

SessionStatus SessionReader::status() const {
  const std::string text = impl_->limit.Guarded([&] {
    Statement row(impl_->database, "SELECT status FROM session");
    return row.Next() ? row.Text(0) : "";
  });
  if (text == "complete") return SessionStatus::kComplete;
  if (text == "abandoned") return SessionStatus::kAbandoned;
  if (text == "recording")
    return impl_->file.is_in_use() ? SessionStatus::kRecording : SessionStatus::kCutOff;
  FailAsDamaged(fmt::format("session '{}'", path().string()),
                fmt::format("no status is called '{}'", Quotable(text)));
}

std::optional<std::string> SessionReader::ended_at_utc() const {
  return impl_->limit.Guarded([&]() -> std::optional<std::string> {
    Statement row(impl_->database, "SELECT ended_at_utc FROM session WHERE ended_at_utc IS NOT NULL");
    if (!row.Next()) return std::nullopt;
    return row.Text(0);
  });
}

std::int64_t SessionReader::file_schema() const { return impl_->file.schema(); }

std::int64_t SessionReader::frame_count() const {
  return impl_->limit.Guarded([&] { return impl_->database.ReadInteger("SELECT count(*) FROM frame"); });
}

std::vector<FrameSummary> SessionReader::frames() const {
  return impl_->limit.Guarded([&] { return ReadFrameSummaries(impl_->database, impl_->header); });
}

core::FrameRecord SessionReader::ReadFrame(core::FrameIndex frame) const {
  return impl_->limit.Guarded([&] { return sessions::ReadFrame(impl_->database, impl_->header, frame); });
}

void SessionReader::Freeze() {
  impl_->limit.Guarded([&] { impl_->database.Execute("BEGIN"); });
  (void)frame_count();  // the first statement of a transaction takes its snapshot
}

bool SessionReader::has_outcome() const { return impl_->adopted || status() == SessionStatus::kComplete; }

void SessionReader::AdoptOutcome(core::SessionOutcome outcome) { impl_->adopted = std::move(outcome); }

std::vector<core::SessionEvent> SessionReader::events() const {
  return impl_->limit.Guarded([&] { return ReadEvents(impl_->database); });
}
std::vector<core::ContactEpisode> SessionReader::episodes() const {
  return impl_->limit.Guarded([&] { return impl_->NamedEpisodes(); });
}
std::vector<core::NearMiss> SessionReader::near_misses() const {
  return impl_->limit.Guarded([&] { return impl_->NamedNearMisses(); });
}
std::vector<core::Finding> SessionReader::findings() const {
  return impl_->limit.Guarded([&] {
    return ReadFindings(impl_->database, impl_->header.layout,
                        {impl_->NamedEpisodes(), impl_->NamedNearMisses(), {}});
  });
}
std::vector<core::FootageFile> SessionReader::footage() const {
  return impl_->limit.Guarded([&] { return ReadFootage(impl_->database); });
}
std::string SessionReader::first_recording_id() const {
  return impl_->limit.Guarded([&] { return FirstRecordingId(impl_->database, impl_->header); });
}
std::string SessionReader::recording_id() const {
  return impl_->limit.Guarded([&] {
    return ReadRecordingId(impl_->database).value_or(FirstRecordingId(impl_->database, impl_->header));
  });
}
std::vector<core::HeatMap> SessionReader::heat_maps() const {
  if (impl_->adopted) return impl_->adopted->heat_maps;
  return impl_->limit.Guarded([&] { return ReadHeatMaps(impl_->database, impl_->header.layout); });
}
std::vector<ContactRow> SessionReader::contacts() const {
  std::vector<ContactRow> rows;
  VisitRows([&](const ContactRow& row) { rows.push_back(row); }, {});
  return rows;
}
std::vector<ContactRow> SessionReader::clearances() const {
  std::vector<ContactRow> rows;
  VisitRows({}, [&](const ContactRow& row) { rows.push_back(row); });
  return rows;
}
void SessionReader::VisitRows(const RowVisitor& on_contact, const RowVisitor& on_clearance) const {
  impl_->limit.Guarded(
      [&] { sessions::VisitRows(impl_->database, impl_->header.layout, on_contact, on_clearance); });
}
std::vector<PartTotals> SessionReader::part_totals() const {
  return impl_->limit.Guarded([&] { return ReadPartTotals(impl_->database, impl_->header.layout); });
}

std::vector<PartBudget> SessionReader::part_budgets() const {
  return impl_->limit.Guarded([&] { return ReadPartBudgets(impl_->database, impl_->header.layout); });
}

std::vector<StampRow> SessionReader::stamp_rows() const {
  return impl_->limit.Guarded(
      [&] { return ReadStampRows(impl_->database, impl_->header.rig.cameras.size()); });
}

std::int64_t SessionReader::most_steps_taken() const { return impl_->limit.most_steps_taken(); }

}  // namespace elbowroom::sessions
