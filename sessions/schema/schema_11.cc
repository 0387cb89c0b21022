#include "sessions/schema/schema.h"

#include <fmt/format.h>

namespace elbowroom::sessions {
namespace {

constexpr const char* kQuestionnaireTables = R"sql(
ALTER TABLE session ADD COLUMN block TEXT NOT NULL DEFAULT '';  -- the part of a study: "practice"

-- What participants are asked from a file, before or after the trial.
CREATE TABLE questionnaire (
  questionnaire_index INTEGER PRIMARY KEY,
  asked TEXT NOT NULL CHECK (asked IN ('before', 'after')),
  name TEXT NOT NULL,
  UNIQUE (asked, name)
) STRICT;

-- In the order in which they are asked, over all questionnaires.
CREATE TABLE question (
  question_index INTEGER PRIMARY KEY,
  questionnaire_index INTEGER NOT NULL REFERENCES questionnaire (questionnaire_index),
  item TEXT NOT NULL,                                           -- its id
  text TEXT NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('scale', 'choice', 'number', 'text')),
  least REAL CHECK ((least IS NULL) = (kind = 'text')),         -- of what answers are worth
  most REAL CHECK ((most IS NULL) = (kind = 'text')) CHECK (most > least),
  least_anchor TEXT NOT NULL,                                   -- the words at a scale's ends, or ''
  most_anchor TEXT NOT NULL,
  choices TEXT CHECK (json_type(choices) = 'array') CHECK ((choices IS NULL) = (kind <> 'choice')),
  choice_values TEXT CHECK (json_type(choice_values) = 'array')  -- what each choice is worth
    CHECK ((choice_values IS NULL) = (kind <> 'choice'))
    CHECK (json_array_length(choice_values) = json_array_length(choices)),
  reversed INTEGER NOT NULL CHECK (reversed IN (0, 1)),         -- 1: worth v counts as least + most - v
  UNIQUE (questionnaire_index, item),
  CHECK (reversed = 0 OR kind <> 'text')
) STRICT;

-- What is computed of the answers: factor times sum, mean, or how many count as counted_from to counted_to.
CREATE TABLE score (
  score_index INTEGER PRIMARY KEY,
  questionnaire_index INTEGER NOT NULL REFERENCES questionnaire (questionnaire_index),
  name TEXT NOT NULL,
  rule TEXT NOT NULL CHECK (rule IN ('sum', 'mean', 'count')),
  factor REAL NOT NULL CHECK (factor <> 0),
  counted_from REAL CHECK ((counted_from IS NULL) = (rule <> 'count')),
  counted_to REAL CHECK ((counted_to IS NULL) = (rule <> 'count')) CHECK (counted_to >= counted_from),
  UNIQUE (questionnaire_index, name)
) STRICT;

-- Which questions a score counts, in order.
CREATE TABLE score_term (
  score_index INTEGER NOT NULL REFERENCES score (score_index),
  term_index INTEGER NOT NULL CHECK (term_index >= 0),
  question_index INTEGER NOT NULL REFERENCES question (question_index),
  weight REAL NOT NULL CHECK (weight <> 0),
  PRIMARY KEY (score_index, term_index),
  UNIQUE (score_index, question_index)
) STRICT, WITHOUT ROWID;
)sql";

// A CHECK can't be altered, so `event` is made anew.
constexpr const char* kEventsAnew = R"sql(
DROP VIEW v_event;
DROP VIEW v_step;
DROP VIEW v_estimate;
DROP VIEW v_answer;

-- Holds from its frame on; that frame may come after the last one recorded.
CREATE TABLE event_11 (
  event_id INTEGER PRIMARY KEY,
  frame_index INTEGER NOT NULL,
  time_s REAL NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('spacing', 'tool', 'note', 'step', 'bookmark', 'estimate', 'answer', 'questionnaire')),
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
  answer INTEGER CHECK ((answer IS NULL) = (kind <> 'answer')),
  question_index INTEGER REFERENCES question (question_index)
    CHECK ((question_index IS NULL) = (kind <> 'questionnaire')),
  answer_number REAL CHECK (answer_number IS NULL OR kind = 'questionnaire'),
  answer_text TEXT CHECK ((answer_text IS NULL) = (kind <> 'questionnaire' OR answer_number IS NOT NULL))
) STRICT;

INSERT INTO event_11 (event_id, frame_index, time_s, kind, spacing_index, from_mm, to_mm, tool, in_use, note,
    step_index, begun, bookmark, asked, estimate_mm, item_index, answer)
  SELECT event_id, frame_index, time_s, kind, spacing_index, from_mm, to_mm, tool, in_use, note,
    step_index, begun, bookmark, asked, estimate_mm, item_index, answer FROM event;
DROP TABLE event;
ALTER TABLE event_11 RENAME TO event;
CREATE INDEX event_by_frame ON event (frame_index);
CREATE INDEX event_by_step ON event (step_index, frame_index, event_id);
CREATE INDEX event_by_question ON event (question_index, frame_index, event_id);
)sql";

// Those of schema 10 but for v_event, which has one kind more.
constexpr const char* kViewsAnew = R"sql(
CREATE VIEW v_event AS
SELECT e.event_id, e.frame_index, e.time_s, e.kind,
  CASE e.kind
    WHEN 'spacing' THEN s.name || ': ' || e.from_mm || ' mm to ' || e.to_mm || ' mm'
    WHEN 'tool' THEN e.tool || CASE e.in_use WHEN 1 THEN ' in use' ELSE ' put away' END
    WHEN 'step' THEN t.name || CASE e.begun WHEN 1 THEN ' begun' ELSE ' ended' END
    WHEN 'bookmark' THEN e.bookmark
    WHEN 'estimate' THEN e.asked || ' the trial: ' || e.estimate_mm || ' mm'
    WHEN 'answer' THEN i.asked || ' the trial, ' || i.item || ': ' || e.answer
    WHEN 'questionnaire' THEN n.asked || ' the trial, ' || n.name || ', ' || q.item || ': ' ||
      coalesce(e.answer_text, printf('%.15g', e.answer_number))
    ELSE e.note
  END AS what
FROM event e LEFT JOIN spacing s USING (spacing_index) LEFT JOIN step t USING (step_index)
LEFT JOIN survey_item i USING (item_index) LEFT JOIN question q USING (question_index)
LEFT JOIN questionnaire n USING (questionnaire_index);

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

constexpr const char* kQuestionnaireViews = R"sql(
-- The last answer to each question, and what it counts in scores, reversed where the question is. NULL: none.
CREATE VIEW v_question AS
SELECT q.question_index, n.asked, n.name AS questionnaire, q.item, q.text, q.kind, q.least, q.most, q.reversed,
  coalesce(e.answer_text, e.answer_number) AS answer,
  CASE q.reversed WHEN 1 THEN q.least + q.most - w.worth ELSE w.worth END AS value
FROM question q JOIN questionnaire n USING (questionnaire_index)
LEFT JOIN event e ON e.event_id = (
  SELECT l.event_id FROM event l WHERE l.question_index = q.question_index
  ORDER BY l.frame_index DESC, l.event_id DESC LIMIT 1)
LEFT JOIN (
  SELECT v.event_id, coalesce(v.answer_number, (
    SELECT worth.value FROM json_each(p.choices) said JOIN json_each(p.choice_values) worth USING (key)
    WHERE said.value = v.answer_text)) AS worth
  FROM event v JOIN question p USING (question_index)) w ON w.event_id = e.event_id
ORDER BY q.question_index;

-- Each score. NULL: a question that it counts isn't answered.
CREATE VIEW v_score AS
SELECT s.score_index, n.asked, n.name AS questionnaire, s.name AS score, s.rule,
  CASE WHEN count(v.value) < count(*) THEN NULL
    ELSE s.factor * CASE s.rule
      WHEN 'sum' THEN sum(t.weight * v.value)
      WHEN 'mean' THEN sum(t.weight * v.value) / sum(t.weight)
      ELSE sum(v.value BETWEEN s.counted_from AND s.counted_to)
    END
  END AS value
FROM score s JOIN questionnaire n USING (questionnaire_index) JOIN score_term t USING (score_index)
JOIN v_question v USING (question_index)
GROUP BY s.score_index
ORDER BY s.score_index;
)sql";

}  // namespace

std::string Schema11Sql() {
  return fmt::format("{}{}{}{}", kQuestionnaireTables, kEventsAnew, kViewsAnew, kQuestionnaireViews);
}

}  // namespace elbowroom::sessions
