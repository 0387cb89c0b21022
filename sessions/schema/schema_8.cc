#include "sessions/schema/schema.h"

namespace elbowroom::sessions {

std::string Schema8Sql() {
  return R"sql(
-- Which picture of its camera a frame took, and when that was taken: all cameras, or none of them. No rows:
-- the cameras have no stamps.
CREATE TABLE camera_stamp (
  frame_index INTEGER NOT NULL REFERENCES frame (frame_index),
  camera_index INTEGER NOT NULL REFERENCES camera (camera_index),
  picture INTEGER CHECK (picture >= 0),  -- the camera's own count; NULL: its picture is missing in the frame
  taken_at_s REAL,                       -- middle of the exposure, on the clock of frame.time_s; NULL likewise
  CHECK ((picture IS NULL) = (taken_at_s IS NULL)),
  PRIMARY KEY (frame_index, camera_index)
) STRICT, WITHOUT ROWID;

-- 1 sigma of what the trial says that verdicts allow for. NULL or 0: calibration, pixels and segmentation
-- are computed.
ALTER TABLE clearance ADD COLUMN given_mm REAL CHECK (given_mm >= 0);

CREATE VIEW v_stamp AS
SELECT s.frame_index, f.time_s, c.name AS camera, s.picture, s.taken_at_s,
  1000 * (s.taken_at_s - f.time_s) AS skew_ms, s.picture IS NULL AS is_missing
FROM camera_stamp s JOIN frame f USING (frame_index) JOIN camera c USING (camera_index);

DROP VIEW v_clearance;
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
)sql";
}

}  // namespace elbowroom::sessions
