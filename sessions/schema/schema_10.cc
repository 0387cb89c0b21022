#include "sessions/schema/schema.h"

#include <fmt/format.h>

namespace elbowroom::sessions {
namespace {

constexpr const char* kProcedureTables = R"sql(
ALTER TABLE session ADD COLUMN condition TEXT NOT NULL DEFAULT '';  -- what is varied between trials
-- The trial is the participant's first, second, ...; 0: not given.
ALTER TABLE session ADD COLUMN trial_order INTEGER NOT NULL DEFAULT 0 CHECK (trial_order >= 0);

-- The steps of the procedure, in order.
CREATE TABLE step (step_index INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE) STRICT;

-- What participants are asked before or after the trial, each with its scale.
CREATE TABLE survey_item (
  item_index INTEGER PRIMARY KEY,
  asked TEXT NOT NULL CHECK (asked IN ('before', 'after')),
  item TEXT NOT NULL,
  least INTEGER NOT NULL,
  most INTEGER NOT NULL CHECK (most > least),
  UNIQUE (asked, item)
) STRICT;
)sql";

// A CHECK can't be altered, so `event` is made anew.
constexpr const char* kEvents = R"sql(
DROP VIEW v_event;

-- Holds from its frame on; that frame may come after the last one recorded.
CREATE TABLE event_10 (
  event_id INTEGER PRIMARY KEY,
  frame_index INTEGER NOT NULL,
  time_s REAL NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('spacing', 'tool', 'note', 'step', 'bookmark', 'estimate', 'answer')),
  spacing_index INTEGER REFERENCES spacing (spacing_index) CHECK ((spacing_index IS NULL) = (kind <> 'spacing')),
  from_mm REAL CHECK ((from_mm IS NULL) = (kind <> 'spacing')),
  to_mm REAL CHECK ((to_mm IS NULL) = (kind <> 'spacing')),
  tool TEXT CHECK ((tool IS NULL) = (kind <> 'tool')),
  in_use INTEGER CHECK (in_use IN (0, 1)) CHECK ((in_use IS NULL) = (kind <> 'tool')),
  note TEXT CHECK ((note IS NULL) = (kind <> 'note')),
  step_index INTEGER REFERENCES step (step_index) CHECK ((step_index IS NULL) = (kind <> 'step')),
  begun INTEGER CHECK (begun IN (0, 1)) CHECK ((begun IS NULL) = (kind <> 'step')),  -- 0: ended
  bookmark TEXT CHECK ((bookmark IS NULL) = (kind <> 'bookmark')),                   -- its name, or ''
  asked TEXT CHECK (asked IN ('before', 'after')) CHECK ((asked IS NULL) = (kind <> 'estimate')),
  estimate_mm REAL CHECK (estimate_mm > 0) CHECK ((estimate_mm IS NULL) = (kind <> 'estimate')),
  item_index INTEGER REFERENCES survey_item (item_index) CHECK ((item_index IS NULL) = (kind <> 'answer')),
  answer INTEGER CHECK ((answer IS NULL) = (kind <> 'answer'))
) STRICT;

INSERT INTO event_10 (event_id, frame_index, time_s, kind, spacing_index, from_mm, to_mm, tool, in_use, note)
  SELECT event_id, frame_index, time_s, kind, spacing_index, from_mm, to_mm, tool, in_use, note FROM event;
DROP TABLE event;
ALTER TABLE event_10 RENAME TO event;
CREATE INDEX event_by_frame ON event (frame_index);
CREATE INDEX event_by_step ON event (step_index, frame_index, event_id);
)sql";

constexpr const char* kProcedureViews = R"sql(
CREATE VIEW v_event AS
SELECT e.event_id, e.frame_index, e.time_s, e.kind,
  CASE e.kind
    WHEN 'spacing' THEN s.name || ': ' || e.from_mm || ' mm to ' || e.to_mm || ' mm'
    WHEN 'tool' THEN e.tool || CASE e.in_use WHEN 1 THEN ' in use' ELSE ' put away' END
    WHEN 'step' THEN t.name || CASE e.begun WHEN 1 THEN ' begun' ELSE ' ended' END
    WHEN 'bookmark' THEN e.bookmark
    WHEN 'estimate' THEN e.asked || ' the trial: ' || e.estimate_mm || ' mm'
    WHEN 'answer' THEN i.asked || ' the trial, ' || i.item || ': ' || e.answer
    ELSE e.note
  END AS what
FROM event e LEFT JOIN spacing s USING (spacing_index) LEFT JOIN step t USING (step_index)
LEFT JOIN survey_item i USING (item_index);

-- Each run of a step, from its begin to its end; NULL: it was under way when the recording ended.
CREATE VIEW v_step AS
SELECT b.event_id, s.name AS step, b.frame_index AS begin_frame, b.time_s AS begin_time_s,
  e.frame_index AS end_frame, e.time_s AS end_time_s, e.time_s - b.time_s AS duration_s
FROM event b JOIN step s USING (step_index)
LEFT JOIN event e ON e.event_id = (
  SELECT n.event_id FROM event n
  WHERE n.step_index = b.step_index AND n.begun = 0
    AND (n.frame_index, n.event_id) > (b.frame_index, b.event_id)
  ORDER BY n.frame_index, n.event_id LIMIT 1)
WHERE b.begun = 1;

-- The space that the participant said is needed. NULL: none given.
CREATE VIEW v_estimate AS
SELECT w.asked, coalesce(
  (SELECT e.estimate_mm FROM event e WHERE e.asked = w.asked ORDER BY e.frame_index DESC, e.event_id DESC LIMIT 1),
  CASE w.asked WHEN 'before' THEN nullif(s.estimate_mm, 0) END) AS estimate_mm
FROM session s JOIN (SELECT 'before' AS asked UNION ALL SELECT 'after') w;

-- The last answer to each item. NULL: none given.
CREATE VIEW v_answer AS
SELECT i.item_index, i.asked, i.item, i.least, i.most,
  (SELECT e.answer FROM event e WHERE e.item_index = i.item_index
   ORDER BY e.frame_index DESC, e.event_id DESC LIMIT 1) AS answer
FROM survey_item i;
)sql";

}  // namespace

std::string Schema10Sql() { return fmt::format("{}{}{}", kProcedureTables, kEvents, kProcedureViews); }

}  // namespace elbowroom::sessions
