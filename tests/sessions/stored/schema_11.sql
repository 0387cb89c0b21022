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
, uncertainty_mm REAL NOT NULL DEFAULT 0 CHECK (uncertainty_mm >= 0), condition TEXT NOT NULL DEFAULT '', trial_order INTEGER NOT NULL DEFAULT 0 CHECK (trial_order >= 0), block TEXT NOT NULL DEFAULT '') STRICT;

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
, deviation_mm REAL NOT NULL DEFAULT 0 CHECK (deviation_mm >= 0)) STRICT, WITHOUT ROWID;

CREATE TABLE part (
  part_index INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  file TEXT NOT NULL,
  unit TEXT NOT NULL CHECK (unit IN ('mm', 'cm', 'm', 'in')),
  mesh_hash TEXT NOT NULL REFERENCES mesh (mesh_hash),
  rotation_world_from_part TEXT NOT NULL CHECK (json_array_length(rotation_world_from_part) = 9),
  position_mm TEXT NOT NULL CHECK (json_array_length(position_mm) = 3)  -- in world, before spacings
, recovery TEXT NOT NULL DEFAULT 'reference'
  CHECK (recovery IN ('reference', 'direction', 'slider', 'hinge')), reference_mm TEXT CHECK (json_array_length(reference_mm) = 3), recovery_axis TEXT CHECK (json_array_length(recovery_axis) = 3), recovery_at_mm TEXT CHECK (json_array_length(recovery_at_mm) = 3), unit_of TEXT NOT NULL DEFAULT 'part' CHECK (unit_of IN ('part', 'file'))) STRICT;

CREATE TABLE spacing (
  spacing_index INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  moving_part INTEGER NOT NULL REFERENCES part (part_index),
  reference_part INTEGER NOT NULL REFERENCES part (part_index),
  axis TEXT NOT NULL CHECK (axis IN ('x', 'y', 'z')),
  min_mm REAL NOT NULL,
  max_mm REAL NOT NULL,
  initial_mm REAL NOT NULL CHECK (initial_mm BETWEEN min_mm AND max_mm)
, moving_group INTEGER REFERENCES part_group (group_index), reference_group INTEGER REFERENCES part_group (group_index)) STRICT;

CREATE TABLE pair_rule (
  pair_index INTEGER PRIMARY KEY,
  part_a INTEGER NOT NULL REFERENCES part (part_index),
  part_b INTEGER NOT NULL REFERENCES part (part_index),
  required_clearance_mm REAL NOT NULL,
  authorised_contact INTEGER NOT NULL CHECK (authorised_contact IN (0, 1))
, ignored INTEGER NOT NULL DEFAULT 0 CHECK (ignored IN (0, 1))) STRICT;

CREATE TABLE frame (frame_index INTEGER PRIMARY KEY, time_s REAL NOT NULL) STRICT;

CREATE TABLE frame_spacing (
  frame_index INTEGER NOT NULL REFERENCES frame (frame_index),
  spacing_index INTEGER NOT NULL REFERENCES spacing (spacing_index),
  spacing_mm REAL NOT NULL,
  PRIMARY KEY (frame_index, spacing_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE mask (
  mask_id INTEGER PRIMARY KEY,
  content_hash BLOB NOT NULL UNIQUE CHECK (length(content_hash) = 16),
  width_px INTEGER NOT NULL CHECK (width_px > 0),
  height_px INTEGER NOT NULL CHECK (height_px > 0),
  object_px INTEGER NOT NULL,
  words_zstd BLOB NOT NULL          -- rows of little-endian 64-bit words, lowest bit = smallest x
, levels_zstd BLOB) STRICT;

CREATE TABLE silhouette (
  frame_index INTEGER NOT NULL REFERENCES frame (frame_index),
  camera_index INTEGER NOT NULL REFERENCES camera (camera_index),
  mask_id INTEGER NOT NULL REFERENCES mask (mask_id),
  PRIMARY KEY (frame_index, camera_index)
) STRICT, WITHOUT ROWID;

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
  peak_x_mm REAL NOT NULL, peak_y_mm REAL NOT NULL, peak_z_mm REAL NOT NULL, peak_part_x_mm REAL, peak_part_y_mm REAL, peak_part_z_mm REAL, tools TEXT NOT NULL DEFAULT '[]' CHECK (json_type(tools) = 'array'), finding_id TEXT CHECK (length(finding_id) = 32),
  CHECK (begin_frame <= peak_frame AND peak_frame <= end_frame)
) STRICT;

CREATE INDEX episode_by_part ON episode (part_index, begin_frame);

CREATE TABLE episode_spacing (
  episode_id INTEGER NOT NULL REFERENCES episode (episode_id),
  spacing_index INTEGER NOT NULL REFERENCES spacing (spacing_index),
  spacing_at_peak_mm REAL NOT NULL,
  PRIMARY KEY (episode_id, spacing_index)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_spacing AS
SELECT frame_index, time_s, name AS spacing, spacing_mm
FROM frame_spacing JOIN frame USING (frame_index) JOIN spacing USING (spacing_index);

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

CREATE TABLE "contact" (
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

CREATE TABLE "contact_point" (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  point_index INTEGER NOT NULL,
  x_mm REAL NOT NULL, y_mm REAL NOT NULL, z_mm REAL NOT NULL,
  depth_mm REAL NOT NULL,
  area_mm2 REAL NOT NULL,
  PRIMARY KEY (frame_index, part_index, point_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES "contact" (frame_index, part_index)
) STRICT, WITHOUT ROWID;

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

CREATE TABLE clearance (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  lower_mm REAL CHECK (lower_mm >= 0),         -- never above the true distance; NULL: the hull has no points
  upper_mm REAL CHECK (upper_mm >= lower_mm),  -- never below it; NULL: not looked for, lower_mm is enough
  part_x_mm REAL, part_y_mm REAL, part_z_mm REAL,  -- on the part, in world, upper_mm from
  hull_x_mm REAL, hull_y_mm REAL, hull_z_mm REAL,  -- a point of the hull
  queries INTEGER NOT NULL, calibration_mm REAL CHECK (calibration_mm >= 0), footprint_mm REAL CHECK (footprint_mm >= 0), segmentation_mm REAL CHECK (segmentation_mm >= 0), skew_mm REAL CHECK (skew_mm >= 0), given_mm REAL CHECK (given_mm >= 0),
  PRIMARY KEY (frame_index, part_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES part_frame (frame_index, part_index)
) STRICT, WITHOUT ROWID;

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
  tools TEXT NOT NULL CHECK (json_type(tools) = 'array'), finding_id TEXT CHECK (length(finding_id) = 32), closest_part_x_mm REAL, closest_part_y_mm REAL, closest_part_z_mm REAL,
  CHECK (begin_frame <= closest_frame AND closest_frame <= end_frame),
  FOREIGN KEY (closest_frame, part_index) REFERENCES clearance (frame_index, part_index)
) STRICT;

CREATE TABLE heat_map (
  part_index INTEGER PRIMARY KEY REFERENCES part (part_index),
  patch_mm REAL NOT NULL CHECK (patch_mm > 0),
  patch_count INTEGER NOT NULL CHECK (patch_count > 0),
  dwell_s_zstd BLOB NOT NULL,       -- little-endian 32-bit floats, triangle by triangle
  peak_depth_mm_zstd BLOB NOT NULL  -- likewise
) STRICT;

CREATE VIEW v_near_miss AS
SELECT n.near_miss_id, p.name AS part, n.verdict, n.begin_time_s, n.closest_time_s, n.end_time_s,
  n.begin_frame, n.closest_frame, n.end_frame, n.frames_below, c.lower_mm, c.upper_mm,
  c.part_x_mm, c.part_y_mm, c.part_z_mm, c.hull_x_mm, c.hull_y_mm, c.hull_z_mm, n.tools, c.spacings
FROM near_miss n
JOIN part p USING (part_index)
JOIN v_clearance c ON c.frame_index = n.closest_frame AND c.part = p.name;

CREATE VIEW v_episode AS
SELECT e.episode_id, p.name AS part, e.begin_time_s, e.peak_time_s, e.end_time_s,
  e.end_time_s - e.begin_time_s AS duration_s, e.begin_frame, e.peak_frame, e.end_frame, e.frames_in_contact,
  e.peak_depth_mm, e.peak_area_mm2, e.peak_x_mm, e.peak_y_mm, e.peak_z_mm,
  e.peak_part_x_mm, e.peak_part_y_mm, e.peak_part_z_mm, e.tools,
  (SELECT group_concat(s.name || ' = ' || es.spacing_at_peak_mm || ' mm', ', ')
   FROM episode_spacing es JOIN spacing s USING (spacing_index) WHERE es.episode_id = e.episode_id) AS spacings_at_peak
FROM episode e JOIN part p USING (part_index);

CREATE TABLE cloth (
  part_index INTEGER PRIMARY KEY REFERENCES part (part_index),
  pins TEXT NOT NULL CHECK (json_type(pins) = 'array'),  -- sides of the part's bounds
  stretch_stiffness_n_per_m REAL NOT NULL,
  bending_stiffness_n_per_m REAL NOT NULL,
  mass_per_area_kg_per_m2 REAL NOT NULL,
  damping_per_s REAL NOT NULL,
  friction REAL NOT NULL
) STRICT;

CREATE TABLE pushed (
  part_index INTEGER PRIMARY KEY REFERENCES part (part_index),
  max_speed_mm_per_s REAL NOT NULL
) STRICT;

CREATE TABLE stream (
  stream_index INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  position_mm TEXT NOT NULL CHECK (json_array_length(position_mm) = 3),
  direction TEXT NOT NULL CHECK (json_array_length(direction) = 3),
  rate_per_s REAL NOT NULL,
  speed_mm_per_s REAL NOT NULL,
  radius_mm REAL NOT NULL
) STRICT;

CREATE TABLE part_motion (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  rotation_rest_from_part TEXT NOT NULL CHECK (json_array_length(rotation_rest_from_part) = 9),
  translation_mm TEXT NOT NULL CHECK (json_array_length(translation_mm) = 3),
  PRIMARY KEY (frame_index, part_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES part_frame (frame_index, part_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE part_group (
  group_index INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
) STRICT;

CREATE TABLE part_group_member (
  group_index INTEGER NOT NULL REFERENCES part_group (group_index),
  member_index INTEGER NOT NULL,  -- in the group, from 0
  part_index INTEGER NOT NULL REFERENCES part (part_index),
  PRIMARY KEY (group_index, member_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE rig_quality (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  -- Of all cameras' parameters: the lower triangle row by row, little-endian 64-bit floats. For each camera
  -- fx fy cx cy in px, its distortion coefficients, rotation in rad, translation in mm, time offset in s.
  covariance BLOB,           -- NULL: verdicts allow for session.uncertainty_mm
  boundary_sigma_px REAL CHECK (boundary_sigma_px >= 0),  -- of a silhouette's boundary; NULL as covariance
  gauge_made TEXT,           -- NULL, as the next: no gauge was measured
  gauge_true_diameter_mm REAL,
  gauge_diameter_mm REAL,    -- of the place with the largest error, as the next two
  gauge_error_mm REAL,
  gauge_bound_mm REAL,
  gauge_places INTEGER,
  gauge_passed INTEGER CHECK (gauge_passed IN (0, 1)),  -- 0: no part is near or clear, but undecided
  CHECK ((covariance IS NULL) = (boundary_sigma_px IS NULL)),
  CHECK ((gauge_made IS NULL) = (gauge_passed IS NULL))
) STRICT;

CREATE TABLE camera_stamp (
  frame_index INTEGER NOT NULL REFERENCES frame (frame_index),
  camera_index INTEGER NOT NULL REFERENCES camera (camera_index),
  picture INTEGER CHECK (picture >= 0),  -- the camera's own count; NULL: its picture is missing in the frame
  taken_at_s REAL,                       -- middle of the exposure, on the clock of frame.time_s; NULL likewise
  CHECK ((picture IS NULL) = (taken_at_s IS NULL)),
  PRIMARY KEY (frame_index, camera_index)
) STRICT, WITHOUT ROWID;

CREATE VIEW v_stamp AS
SELECT s.frame_index, f.time_s, c.name AS camera, s.picture, s.taken_at_s,
  1000 * (s.taken_at_s - f.time_s) AS skew_ms, s.picture IS NULL AS is_missing
FROM camera_stamp s JOIN frame f USING (frame_index) JOIN camera c USING (camera_index);

CREATE VIEW v_clearance AS
SELECT c.frame_index, f.time_s, p.name AS part, pf.verdict, s.required_clearance_mm,
  coalesce(2 * sqrt(c.calibration_mm * c.calibration_mm + c.footprint_mm * c.footprint_mm
    + c.segmentation_mm * c.segmentation_mm + c.skew_mm * c.skew_mm
    + coalesce(c.given_mm * c.given_mm, 0)), s.uncertainty_mm) AS uncertainty_mm,
  c.calibration_mm, c.footprint_mm, c.segmentation_mm, c.skew_mm, c.given_mm,
  c.lower_mm, c.upper_mm, c.part_x_mm, c.part_y_mm, c.part_z_mm, c.hull_x_mm, c.hull_y_mm, c.hull_z_mm,
  (SELECT group_concat(v.spacing || ' = ' || v.spacing_mm || ' mm', ', ')
   FROM v_spacing v WHERE v.frame_index = c.frame_index) AS spacings
FROM clearance c
JOIN part_frame pf USING (frame_index, part_index)
JOIN frame f USING (frame_index)
JOIN part p USING (part_index)
JOIN session s;

CREATE TABLE origin (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  file TEXT NOT NULL,                                          -- as it was given
  recording_id TEXT NOT NULL,                                  -- its setting 'recording.id'
  first_recording_id TEXT NOT NULL,                            -- of the session that cameras or footage gave
  replayed_at_utc TEXT NOT NULL,
  changes TEXT NOT NULL CHECK (json_type(changes) = 'array')   -- in words; []: nothing was changed
) STRICT;

CREATE TABLE absent_finding (
  finding_id TEXT PRIMARY KEY CHECK (length(finding_id) = 32),
  kind TEXT NOT NULL CHECK (kind IN ('touch', 'near miss')),
  part TEXT NOT NULL,
  begin_time_s REAL NOT NULL,
  end_time_s REAL NOT NULL CHECK (end_time_s >= begin_time_s),
  part_x_mm REAL, part_y_mm REAL, part_z_mm REAL,             -- where on the part, in its frame
  was_checked INTEGER NOT NULL CHECK (was_checked IN (0, 1))      -- 1: its part and time were judged again
) STRICT, WITHOUT ROWID;

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

CREATE TABLE footage (
  footage_index INTEGER PRIMARY KEY,
  file TEXT NOT NULL,  -- relative to the session's folder
  bytes INTEGER NOT NULL CHECK (bytes >= 0),
  content_hash BLOB NOT NULL CHECK (length(content_hash) = 16)
) STRICT;

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

CREATE TABLE step (step_index INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE) STRICT;

CREATE TABLE survey_item (
  item_index INTEGER PRIMARY KEY,
  asked TEXT NOT NULL CHECK (asked IN ('before', 'after')),
  item TEXT NOT NULL,
  least INTEGER NOT NULL,
  most INTEGER NOT NULL CHECK (most > least),
  UNIQUE (asked, item)
) STRICT;

CREATE TABLE questionnaire (
  questionnaire_index INTEGER PRIMARY KEY,
  asked TEXT NOT NULL CHECK (asked IN ('before', 'after')),
  name TEXT NOT NULL,
  UNIQUE (asked, name)
) STRICT;

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

CREATE TABLE score_term (
  score_index INTEGER NOT NULL REFERENCES score (score_index),
  term_index INTEGER NOT NULL CHECK (term_index >= 0),
  question_index INTEGER NOT NULL REFERENCES question (question_index),
  weight REAL NOT NULL CHECK (weight <> 0),
  PRIMARY KEY (score_index, term_index),
  UNIQUE (score_index, question_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE "event" (
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

CREATE INDEX event_by_frame ON event (frame_index);

CREATE INDEX event_by_step ON event (step_index, frame_index, event_id);

CREATE INDEX event_by_question ON event (question_index, frame_index, event_id);

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

CREATE VIEW v_estimate AS
SELECT w.asked, coalesce(
  (SELECT e.estimate_mm FROM event e WHERE e.asked = w.asked ORDER BY e.frame_index DESC, e.event_id DESC LIMIT 1),
  CASE w.asked WHEN 'before' THEN nullif(s.estimate_mm, 0) END) AS estimate_mm
FROM session s JOIN (SELECT 'before' AS asked UNION ALL SELECT 'after') w;

CREATE VIEW v_answer AS
SELECT i.item_index, i.asked, i.item, i.least, i.most,
  (SELECT e.answer FROM event e WHERE e.item_index = i.item_index
   ORDER BY e.frame_index DESC, e.event_id DESC LIMIT 1) AS answer
FROM survey_item i;

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

