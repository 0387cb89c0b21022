#include "sessions/schema/schema.h"

#include <fmt/format.h>

namespace elbowroom::sessions {
namespace {

constexpr const char* kReviewTables = R"sql(
-- The session that this one was replayed from. No row: it was recorded from cameras or footage.
CREATE TABLE origin (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  file TEXT NOT NULL,                                          -- as it was given
  recording_id TEXT NOT NULL,                                  -- its setting 'recording.id'
  first_recording_id TEXT NOT NULL,                            -- of the session that cameras or footage gave
  replayed_at_utc TEXT NOT NULL,
  changes TEXT NOT NULL CHECK (json_type(changes) = 'array')   -- in words; []: nothing was changed
) STRICT;

-- By which people name a touch or near miss; the same after a replay. NULL: an older program wrote the row.
ALTER TABLE episode ADD COLUMN finding_id TEXT CHECK (length(finding_id) = 32);
ALTER TABLE near_miss ADD COLUMN finding_id TEXT CHECK (length(finding_id) = 32);

-- The part's witness point at the closest moment, in the part's frame. NULL: not known.
ALTER TABLE near_miss ADD COLUMN closest_part_x_mm REAL;
ALTER TABLE near_miss ADD COLUMN closest_part_y_mm REAL;
ALTER TABLE near_miss ADD COLUMN closest_part_z_mm REAL;

-- Touches and near misses of the origin that this session hasn't.
CREATE TABLE absent_finding (
  finding_id TEXT PRIMARY KEY CHECK (length(finding_id) = 32),
  kind TEXT NOT NULL CHECK (kind IN ('touch', 'near miss')),
  part TEXT NOT NULL,
  begin_time_s REAL NOT NULL,
  end_time_s REAL NOT NULL CHECK (end_time_s >= begin_time_s),
  part_x_mm REAL, part_y_mm REAL, part_z_mm REAL,             -- where on the part, in its frame
  was_checked INTEGER NOT NULL CHECK (was_checked IN (0, 1))      -- 1: its part and time were judged again
) STRICT, WITHOUT ROWID;

-- What was said of a touch or near miss. The last status holds; without one it is 'new'.
CREATE TABLE remark (
  remark_id INTEGER PRIMARY KEY,
  finding_id TEXT NOT NULL CHECK (length(finding_id) = 32),
  at_utc TEXT NOT NULL,
  by_name TEXT NOT NULL,
  status TEXT CHECK (status IN ('new', 'active', 'reviewed', 'approved', 'resolved')),  -- NULL: unchanged
  comment TEXT NOT NULL,
  exchange_id TEXT CHECK (length(exchange_id) = 32),  -- of the file that it came in; NULL: it was made here
  CHECK (status IS NOT NULL OR comment <> '')
) STRICT;
CREATE INDEX remark_by_finding ON remark (finding_id, remark_id);

-- Files with the pictures that the silhouettes come from. The first is the RIG.yml that plays them.
CREATE TABLE footage (
  footage_index INTEGER PRIMARY KEY,
  file TEXT NOT NULL,  -- relative to the session's folder
  bytes INTEGER NOT NULL CHECK (bytes >= 0),
  content_hash BLOB NOT NULL CHECK (length(content_hash) = 16)
) STRICT;
)sql";

constexpr const char* kReviewViews = R"sql(
CREATE VIEW v_finding AS
WITH found AS (
  SELECT e.finding_id, 'touch' AS kind, p.name AS part, e.begin_time_s, e.end_time_s, 'here' AS presence,
    e.episode_id, NULL AS near_miss_id
  FROM episode e JOIN part p USING (part_index)
  UNION ALL
  SELECT n.finding_id, 'near miss', p.name, n.begin_time_s, n.end_time_s, 'here', NULL, n.near_miss_id
  FROM near_miss n JOIN part p USING (part_index)
  UNION ALL
  SELECT finding_id, kind, part, begin_time_s, end_time_s,
    CASE was_checked WHEN 1 THEN 'gone' ELSE 'not checked' END, NULL, NULL
  FROM absent_finding)
SELECT found.*,
  coalesce((SELECT r.status FROM remark r WHERE r.finding_id = found.finding_id AND r.status IS NOT NULL
            ORDER BY r.remark_id DESC LIMIT 1), 'new') AS status,
  (SELECT count(*) FROM remark r WHERE r.finding_id = found.finding_id AND r.comment <> '') AS comments
FROM found;

CREATE VIEW v_remark AS
SELECT r.remark_id, r.finding_id, f.part, f.kind, r.at_utc, r.by_name, r.status, r.comment
FROM remark r LEFT JOIN v_finding f USING (finding_id);
)sql";

}  // namespace

std::string Schema9Sql() { return fmt::format("{}{}", kReviewTables, kReviewViews); }

}  // namespace elbowroom::sessions
