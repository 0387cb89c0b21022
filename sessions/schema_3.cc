#include "sessions/schema.h"

namespace elbowroom::sessions {

// A CHECK can't be altered, so `contact` is made anew with what refers to it; `contact_point` as it was.
std::string Schema3Sql() {
  return R"sql(
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
}

}  // namespace elbowroom::sessions
