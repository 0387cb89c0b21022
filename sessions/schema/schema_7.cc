#include "sessions/schema/schema.h"

namespace elbowroom::sessions {

std::string Schema7Sql() {
  return R"sql(
-- How exact the rig is. No row: nothing is known, and verdicts allow for session.uncertainty_mm.
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

-- What the verdict allows for is 2 sigma of these together; NULL: session.uncertainty_mm.
ALTER TABLE clearance ADD COLUMN calibration_mm REAL CHECK (calibration_mm >= 0);
ALTER TABLE clearance ADD COLUMN footprint_mm REAL CHECK (footprint_mm >= 0);
ALTER TABLE clearance ADD COLUMN segmentation_mm REAL CHECK (segmentation_mm >= 0);
ALTER TABLE clearance ADD COLUMN skew_mm REAL CHECK (skew_mm >= 0);

DROP VIEW v_clearance;
CREATE VIEW v_clearance AS
SELECT c.frame_index, f.time_s, p.name AS part, pf.verdict, s.required_clearance_mm,
  coalesce(2 * sqrt(c.calibration_mm * c.calibration_mm + c.footprint_mm * c.footprint_mm
    + c.segmentation_mm * c.segmentation_mm + c.skew_mm * c.skew_mm), s.uncertainty_mm) AS uncertainty_mm,
  c.calibration_mm, c.footprint_mm, c.segmentation_mm, c.skew_mm,
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
