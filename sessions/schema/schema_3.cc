#include "sessions/schema/schema.h"

#include <fmt/format.h>

namespace elbowroom::sessions {
namespace {

// A CHECK can't be altered, so `contact` is made anew with what refers to it; `contact_point` as it was.
constexpr const char* kRecovery = R"sql(
ALTER TABLE part ADD COLUMN recovery TEXT NOT NULL DEFAULT 'reference'
  CHECK (recovery IN ('reference', 'direction', 'slider', 'hinge'));
ALTER TABLE part ADD COLUMN reference_mm TEXT CHECK (json_array_length(reference_mm) = 3);
ALTER TABLE part ADD COLUMN recovery_axis TEXT CHECK (json_array_length(recovery_axis) = 3);
ALTER TABLE part ADD COLUMN recovery_at_mm TEXT CHECK (json_array_length(recovery_at_mm) = 3);

DROP VIEW v_contact;
DROP VIEW v_contact_point;

-- The evidence of one part in one frame: a row wherever there is any. The view v_contact keeps the verdict 'contact'.
CREATE TABLE contact_3 (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  contact_area_mm2 REAL NOT NULL,
  contact_point_count INTEGER NOT NULL,
  deepest_x_mm REAL, deepest_y_mm REAL, deepest_z_mm REAL, deepest_depth_mm REAL, deepest_area_mm2 REAL,
  recovery_status TEXT NOT NULL
    CHECK (recovery_status IN ('found', 'no contact', 'reference inside hull', 'no direction', 'no exit',
                               'hull inside part', 'on surface')),
  cp_obj_x_mm REAL, cp_obj_y_mm REAL, cp_obj_z_mm REAL,
  cp_hull_x_mm REAL, cp_hull_y_mm REAL, cp_hull_z_mm REAL,
  v_rec_x REAL, v_rec_y REAL, v_rec_z REAL,
  d_rec_mm REAL,
  n_hull_x REAL, n_hull_y REAL, n_hull_z REAL,
  recovery_angle_rad REAL,  -- of a hinge
  PRIMARY KEY (frame_index, part_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES part_frame (frame_index, part_index)
) STRICT, WITHOUT ROWID;

-- A bounded sample of the contact, spread over it.
CREATE TABLE contact_point_3 (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  point_index INTEGER NOT NULL,
  x_mm REAL NOT NULL, y_mm REAL NOT NULL, z_mm REAL NOT NULL,
  depth_mm REAL NOT NULL,
  area_mm2 REAL NOT NULL,
  PRIMARY KEY (frame_index, part_index, point_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES contact_3 (frame_index, part_index)
) STRICT, WITHOUT ROWID;

INSERT INTO contact_3 SELECT *, NULL FROM contact;
INSERT INTO contact_point_3 SELECT * FROM contact_point;
DROP TABLE contact_point;
DROP TABLE contact;
ALTER TABLE contact_3 RENAME TO contact;
ALTER TABLE contact_point_3 RENAME TO contact_point;
CREATE INDEX contact_by_part ON contact (part_index, frame_index);

CREATE VIEW v_contact AS
SELECT c.frame_index, f.time_s, p.name AS part, c.contact_area_mm2, c.contact_point_count,
  c.deepest_depth_mm, c.deepest_x_mm, c.deepest_y_mm, c.deepest_z_mm,
  p.recovery, c.recovery_status, c.d_rec_mm, c.recovery_angle_rad, c.v_rec_x, c.v_rec_y, c.v_rec_z,
  c.cp_obj_x_mm, c.cp_obj_y_mm, c.cp_obj_z_mm, c.cp_hull_x_mm, c.cp_hull_y_mm, c.cp_hull_z_mm,
  c.n_hull_x, c.n_hull_y, c.n_hull_z,
  (SELECT group_concat(s.spacing || ' = ' || s.spacing_mm || ' mm', ', ')
   FROM v_spacing s WHERE s.frame_index = c.frame_index) AS spacings
FROM contact c
JOIN part_frame pf USING (frame_index, part_index)
JOIN frame f USING (frame_index)
JOIN part p USING (part_index)
WHERE pf.verdict = 'contact';

CREATE VIEW v_contact_point AS
SELECT frame_index, time_s, name AS part, point_index, x_mm, y_mm, z_mm, depth_mm, area_mm2
FROM contact_point JOIN frame USING (frame_index) JOIN part USING (part_index);
)sql";

constexpr const char* kTables = R"sql(
ALTER TABLE session ADD COLUMN uncertainty_mm REAL NOT NULL DEFAULT 0 CHECK (uncertainty_mm >= 0);

-- How far a part was from the hull in a frame, where a clearance was required.
CREATE TABLE clearance (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  lower_mm REAL CHECK (lower_mm >= 0),         -- never above the true distance; NULL: the hull has no points
  upper_mm REAL CHECK (upper_mm >= lower_mm),  -- never below it; NULL: not looked for, lower_mm is enough
  part_x_mm REAL, part_y_mm REAL, part_z_mm REAL,  -- on the part, in world, upper_mm from
  hull_x_mm REAL, hull_y_mm REAL, hull_z_mm REAL,  -- a point of the hull
  queries INTEGER NOT NULL,
  PRIMARY KEY (frame_index, part_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES part_frame (frame_index, part_index)
) STRICT, WITHOUT ROWID;

-- In the part's frame; NULL in files of an older schema.
ALTER TABLE episode ADD COLUMN peak_part_x_mm REAL;
ALTER TABLE episode ADD COLUMN peak_part_y_mm REAL;
ALTER TABLE episode ADD COLUMN peak_part_z_mm REAL;
ALTER TABLE episode ADD COLUMN tools TEXT NOT NULL DEFAULT '[]' CHECK (json_type(tools) = 'array');

-- A part came below its required clearance and went again, untouched: written when the session ends.
CREATE TABLE near_miss (
  near_miss_id INTEGER PRIMARY KEY,
  part_index INTEGER NOT NULL REFERENCES part (part_index),
  begin_frame INTEGER NOT NULL REFERENCES frame (frame_index),
  closest_frame INTEGER NOT NULL REFERENCES frame (frame_index),
  end_frame INTEGER NOT NULL REFERENCES frame (frame_index),
  begin_time_s REAL NOT NULL,
  closest_time_s REAL NOT NULL,
  end_time_s REAL NOT NULL,
  frames_below INTEGER NOT NULL CHECK (frames_below > 0),
  verdict TEXT NOT NULL CHECK (verdict IN ('near', 'undecided')),
  spacing_at_closest_mm TEXT NOT NULL CHECK (json_type(spacing_at_closest_mm) = 'array'),  -- in order of index
  tools TEXT NOT NULL CHECK (json_type(tools) = 'array'),
  CHECK (begin_frame <= closest_frame AND closest_frame <= end_frame),
  FOREIGN KEY (closest_frame, part_index) REFERENCES clearance (frame_index, part_index)
) STRICT;

-- Patches of a part's mesh: triangles halved across the longest side until none is longer than patch_mm, at
-- most 12 times.
CREATE TABLE heat_map (
  part_index INTEGER PRIMARY KEY REFERENCES part (part_index),
  patch_mm REAL NOT NULL CHECK (patch_mm > 0),
  patch_count INTEGER NOT NULL CHECK (patch_count > 0),
  dwell_s_zstd BLOB NOT NULL,       -- little-endian 32-bit floats, triangle by triangle
  peak_depth_mm_zstd BLOB NOT NULL  -- likewise
) STRICT;
)sql";

constexpr const char* kThirdViews = R"sql(
CREATE VIEW v_clearance AS
SELECT c.frame_index, f.time_s, p.name AS part, pf.verdict, s.required_clearance_mm, s.uncertainty_mm,
  c.lower_mm, c.upper_mm, c.part_x_mm, c.part_y_mm, c.part_z_mm, c.hull_x_mm, c.hull_y_mm, c.hull_z_mm,
  (SELECT group_concat(v.spacing || ' = ' || v.spacing_mm || ' mm', ', ')
   FROM v_spacing v WHERE v.frame_index = c.frame_index) AS spacings
FROM clearance c
JOIN part_frame pf USING (frame_index, part_index)
JOIN frame f USING (frame_index)
JOIN part p USING (part_index)
JOIN session s;

CREATE VIEW v_near_miss AS
SELECT n.near_miss_id, p.name AS part, n.verdict, n.begin_time_s, n.closest_time_s, n.end_time_s,
  n.begin_frame, n.closest_frame, n.end_frame, n.frames_below, c.lower_mm, c.upper_mm,
  c.part_x_mm, c.part_y_mm, c.part_z_mm, c.hull_x_mm, c.hull_y_mm, c.hull_z_mm, n.tools, c.spacings
FROM near_miss n
JOIN part p USING (part_index)
JOIN v_clearance c ON c.frame_index = n.closest_frame AND c.part = p.name;

DROP VIEW v_episode;
CREATE VIEW v_episode AS
SELECT e.episode_id, p.name AS part, e.begin_time_s, e.peak_time_s, e.end_time_s,
  e.end_time_s - e.begin_time_s AS duration_s, e.begin_frame, e.peak_frame, e.end_frame, e.frames_in_contact,
  e.peak_depth_mm, e.peak_area_mm2, e.peak_x_mm, e.peak_y_mm, e.peak_z_mm,
  e.peak_part_x_mm, e.peak_part_y_mm, e.peak_part_z_mm, e.tools,
  (SELECT group_concat(s.name || ' = ' || es.spacing_at_peak_mm || ' mm', ', ')
   FROM episode_spacing es JOIN spacing s USING (spacing_index) WHERE es.episode_id = e.episode_id) AS spacings_at_peak
FROM episode e JOIN part p USING (part_index);
)sql";

}  // namespace

std::string Schema3Sql() { return fmt::format("{}{}{}", kRecovery, kTables, kThirdViews); }

}  // namespace elbowroom::sessions
