#include "sessions/schema/schema.h"

#include <fmt/format.h>

namespace elbowroom::sessions {
namespace {

// What was set up.
constexpr const char* kSetUp = R"sql(
CREATE TABLE session (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  status TEXT NOT NULL CHECK (status IN ('recording', 'complete', 'abandoned')),
  started_at_utc TEXT NOT NULL,
  ended_at_utc TEXT CHECK ((ended_at_utc IS NULL) = (status = 'recording')),
  participant TEXT NOT NULL,
  task TEXT NOT NULL,
  estimate_mm REAL NOT NULL,            -- the participant's guess of the space needed; 0: none given
  required_clearance_mm REAL NOT NULL,
  rig_name TEXT NOT NULL,
  workspace_min_x_mm REAL NOT NULL, workspace_min_y_mm REAL NOT NULL, workspace_min_z_mm REAL NOT NULL,
  workspace_max_x_mm REAL NOT NULL, workspace_max_y_mm REAL NOT NULL, workspace_max_z_mm REAL NOT NULL,
  unseen TEXT NOT NULL CHECK (unseen IN ('outside', 'abstain')),
  layout_unit TEXT NOT NULL CHECK (layout_unit IN ('mm', 'cm', 'm', 'in'))
) STRICT;

CREATE TABLE setting (key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE version (component TEXT PRIMARY KEY, version TEXT NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE tool (tool_index INTEGER PRIMARY KEY, name TEXT NOT NULL) STRICT;

CREATE TABLE camera (
  camera_index INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  image_width_px INTEGER NOT NULL CHECK (image_width_px BETWEEN 1 AND 65536),
  image_height_px INTEGER NOT NULL CHECK (image_height_px BETWEEN 1 AND 65536),
  camera_matrix TEXT NOT NULL CHECK (json_array_length(camera_matrix) = 9),  -- row by row
  distortion_model TEXT NOT NULL CHECK (distortion_model IN ('plumb_bob', 'rational_polynomial', 'fisheye')),
  distortion_coefficients TEXT NOT NULL CHECK (json_type(distortion_coefficients) = 'array'),
  rotation_cam_from_world TEXT NOT NULL CHECK (json_array_length(rotation_cam_from_world) = 9),
  translation_cam_from_world_mm TEXT NOT NULL CHECK (json_array_length(translation_cam_from_world_mm) = 3)
) STRICT;

CREATE TABLE mesh (
  mesh_hash TEXT PRIMARY KEY CHECK (length(mesh_hash) = 32),  -- of the content
  vertex_count INTEGER NOT NULL CHECK (vertex_count > 0),
  triangle_count INTEGER NOT NULL CHECK (triangle_count > 0),
  vertices_mm_zstd BLOB NOT NULL,   -- x, y, z as little-endian doubles
  triangles_zstd BLOB NOT NULL      -- a, b, c as little-endian 32-bit integers, from 0
) STRICT, WITHOUT ROWID;

CREATE TABLE part (
  part_index INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  file TEXT NOT NULL,
  unit TEXT NOT NULL CHECK (unit IN ('mm', 'cm', 'm', 'in')),
  mesh_hash TEXT NOT NULL REFERENCES mesh (mesh_hash),
  rotation_world_from_part TEXT NOT NULL CHECK (json_array_length(rotation_world_from_part) = 9),
  position_mm TEXT NOT NULL CHECK (json_array_length(position_mm) = 3)  -- in world, before spacings
) STRICT;

CREATE TABLE spacing (
  spacing_index INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  moving_part INTEGER NOT NULL REFERENCES part (part_index),
  reference_part INTEGER NOT NULL REFERENCES part (part_index),
  axis TEXT NOT NULL CHECK (axis IN ('x', 'y', 'z')),
  min_mm REAL NOT NULL,
  max_mm REAL NOT NULL,
  initial_mm REAL NOT NULL CHECK (initial_mm BETWEEN min_mm AND max_mm)
) STRICT;

CREATE TABLE pair_rule (
  pair_index INTEGER PRIMARY KEY,
  part_a INTEGER NOT NULL REFERENCES part (part_index),
  part_b INTEGER NOT NULL REFERENCES part (part_index),
  required_clearance_mm REAL NOT NULL,
  authorised_contact INTEGER NOT NULL CHECK (authorised_contact IN (0, 1))
) STRICT;
)sql";

// What happened.
constexpr const char* kFrames = R"sql(
CREATE TABLE frame (frame_index INTEGER PRIMARY KEY, time_s REAL NOT NULL) STRICT;

CREATE TABLE frame_spacing (
  frame_index INTEGER NOT NULL REFERENCES frame (frame_index),
  spacing_index INTEGER NOT NULL REFERENCES spacing (spacing_index),
  spacing_mm REAL NOT NULL,
  PRIMARY KEY (frame_index, spacing_index)
) STRICT, WITHOUT ROWID;

-- A picture's object pixels, kept once however often they recur.
CREATE TABLE mask (
  mask_id INTEGER PRIMARY KEY,
  content_hash BLOB NOT NULL UNIQUE CHECK (length(content_hash) = 16),
  width_px INTEGER NOT NULL CHECK (width_px > 0),
  height_px INTEGER NOT NULL CHECK (height_px > 0),
  object_px INTEGER NOT NULL,
  words_zstd BLOB NOT NULL          -- rows of little-endian 64-bit words, lowest bit = smallest x
) STRICT;

CREATE TABLE silhouette (
  frame_index INTEGER NOT NULL REFERENCES frame (frame_index),
  camera_index INTEGER NOT NULL REFERENCES camera (camera_index),
  mask_id INTEGER NOT NULL REFERENCES mask (mask_id),
  PRIMARY KEY (frame_index, camera_index)
) STRICT, WITHOUT ROWID;

-- Every part in every frame, so that 'clear' is known and not merely unsaid.
CREATE TABLE part_frame (
  frame_index INTEGER NOT NULL REFERENCES frame (frame_index),
  part_index INTEGER NOT NULL REFERENCES part (part_index),
  verdict TEXT NOT NULL CHECK (verdict IN ('contact', 'near', 'clear', 'undecided')),
  resolution_mm REAL NOT NULL,
  triangles INTEGER NOT NULL,
  queries INTEGER NOT NULL,
  skipped INTEGER NOT NULL,
  PRIMARY KEY (frame_index, part_index)
) STRICT, WITHOUT ROWID;

-- The evidence of one part in one frame: a row wherever there is any. The view v_contact keeps the verdict 'contact'.
CREATE TABLE contact (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  contact_area_mm2 REAL NOT NULL,
  contact_point_count INTEGER NOT NULL,
  deepest_x_mm REAL, deepest_y_mm REAL, deepest_z_mm REAL, deepest_depth_mm REAL, deepest_area_mm2 REAL,
  recovery_status TEXT NOT NULL
    CHECK (recovery_status IN ('found', 'no contact', 'reference inside hull', 'no direction')),
  cp_obj_x_mm REAL, cp_obj_y_mm REAL, cp_obj_z_mm REAL,
  cp_hull_x_mm REAL, cp_hull_y_mm REAL, cp_hull_z_mm REAL,
  v_rec_x REAL, v_rec_y REAL, v_rec_z REAL,
  d_rec_mm REAL,
  n_hull_x REAL, n_hull_y REAL, n_hull_z REAL,
  PRIMARY KEY (frame_index, part_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES part_frame (frame_index, part_index)
) STRICT, WITHOUT ROWID;
CREATE INDEX contact_by_part ON contact (part_index, frame_index);

-- A bounded sample of the contact, spread over it.
CREATE TABLE contact_point (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  point_index INTEGER NOT NULL,
  x_mm REAL NOT NULL, y_mm REAL NOT NULL, z_mm REAL NOT NULL,
  depth_mm REAL NOT NULL,
  area_mm2 REAL NOT NULL,
  PRIMARY KEY (frame_index, part_index, point_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES contact (frame_index, part_index)
) STRICT, WITHOUT ROWID;

-- One touch: written when the session ends.
CREATE TABLE episode (
  episode_id INTEGER PRIMARY KEY,
  part_index INTEGER NOT NULL REFERENCES part (part_index),
  begin_frame INTEGER NOT NULL REFERENCES frame (frame_index),
  peak_frame INTEGER NOT NULL REFERENCES frame (frame_index),
  end_frame INTEGER NOT NULL REFERENCES frame (frame_index),
  begin_time_s REAL NOT NULL,
  peak_time_s REAL NOT NULL,
  end_time_s REAL NOT NULL,
  frames_in_contact INTEGER NOT NULL CHECK (frames_in_contact > 0),
  peak_depth_mm REAL NOT NULL,
  peak_area_mm2 REAL NOT NULL,
  peak_x_mm REAL NOT NULL, peak_y_mm REAL NOT NULL, peak_z_mm REAL NOT NULL,
  CHECK (begin_frame <= peak_frame AND peak_frame <= end_frame)
) STRICT;
CREATE INDEX episode_by_part ON episode (part_index, begin_frame);

CREATE TABLE episode_spacing (
  episode_id INTEGER NOT NULL REFERENCES episode (episode_id),
  spacing_index INTEGER NOT NULL REFERENCES spacing (spacing_index),
  spacing_at_peak_mm REAL NOT NULL,
  PRIMARY KEY (episode_id, spacing_index)
) STRICT, WITHOUT ROWID;

-- Holds from its frame on; that frame may come after the last one recorded.
CREATE TABLE event (
  event_id INTEGER PRIMARY KEY,
  frame_index INTEGER NOT NULL,
  time_s REAL NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('spacing', 'tool', 'note')),
  spacing_index INTEGER REFERENCES spacing (spacing_index) CHECK ((spacing_index IS NULL) = (kind <> 'spacing')),
  from_mm REAL CHECK ((from_mm IS NULL) = (kind <> 'spacing')),
  to_mm REAL CHECK ((to_mm IS NULL) = (kind <> 'spacing')),
  tool TEXT CHECK ((tool IS NULL) = (kind <> 'tool')),
  in_use INTEGER CHECK (in_use IN (0, 1)) CHECK ((in_use IS NULL) = (kind <> 'tool')),
  note TEXT CHECK ((note IS NULL) = (kind <> 'note'))
) STRICT;
CREATE INDEX event_by_frame ON event (frame_index);
)sql";

// For people with the sqlite3 shell: names instead of indices.
constexpr const char* kFirstViews = R"sql(
CREATE VIEW v_spacing AS
SELECT frame_index, time_s, name AS spacing, spacing_mm
FROM frame_spacing JOIN frame USING (frame_index) JOIN spacing USING (spacing_index);

CREATE VIEW v_contact AS
SELECT c.frame_index, f.time_s, p.name AS part, c.contact_area_mm2, c.contact_point_count,
  c.deepest_depth_mm, c.deepest_x_mm, c.deepest_y_mm, c.deepest_z_mm,
  c.recovery_status, c.d_rec_mm, c.v_rec_x, c.v_rec_y, c.v_rec_z,
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

CREATE VIEW v_episode AS
SELECT e.episode_id, p.name AS part, e.begin_time_s, e.peak_time_s, e.end_time_s,
  e.end_time_s - e.begin_time_s AS duration_s, e.begin_frame, e.peak_frame, e.end_frame, e.frames_in_contact,
  e.peak_depth_mm, e.peak_area_mm2, e.peak_x_mm, e.peak_y_mm, e.peak_z_mm,
  (SELECT group_concat(s.name || ' = ' || es.spacing_at_peak_mm || ' mm', ', ')
   FROM episode_spacing es JOIN spacing s USING (spacing_index) WHERE es.episode_id = e.episode_id) AS spacings_at_peak
FROM episode e JOIN part p USING (part_index);

CREATE VIEW v_event AS
SELECT e.event_id, e.frame_index, e.time_s, e.kind,
  CASE e.kind
    WHEN 'spacing' THEN s.name || ': ' || e.from_mm || ' mm to ' || e.to_mm || ' mm'
    WHEN 'tool' THEN e.tool || CASE e.in_use WHEN 1 THEN ' in use' ELSE ' put away' END
    ELSE e.note
  END AS what
FROM event e LEFT JOIN spacing s USING (spacing_index);

CREATE VIEW v_part AS
SELECT p.part_index, p.name AS part, count(pf.frame_index) AS frames,
  count(*) FILTER (WHERE pf.verdict = 'contact') AS frames_in_contact,
  count(*) FILTER (WHERE pf.verdict = 'near') AS frames_near,
  count(*) FILTER (WHERE pf.verdict = 'undecided') AS frames_undecided,
  count(*) FILTER (WHERE pf.verdict = 'clear') AS frames_clear
FROM part p LEFT JOIN part_frame pf USING (part_index)
GROUP BY p.part_index;

CREATE VIEW v_silhouette AS
SELECT frame_index, time_s, name AS camera, object_px, width_px, height_px, mask_id
FROM silhouette JOIN frame USING (frame_index) JOIN camera USING (camera_index) JOIN mask USING (mask_id);
)sql";

}  // namespace

std::string Schema1Sql() { return fmt::format("{}{}{}", kSetUp, kFrames, kFirstViews); }

}  // namespace elbowroom::sessions
