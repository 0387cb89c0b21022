#include "sessions/schema/schema.h"

namespace elbowroom::sessions {

std::string Schema4Sql() {
  return R"sql(
ALTER TABLE pair_rule ADD COLUMN ignored INTEGER NOT NULL DEFAULT 0 CHECK (ignored IN (0, 1));

-- Parts that give way: a row in one of these two, or in none.
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

-- Where a frame found a part that had been pushed before, from where layout and spacings have it. No row: there.
CREATE TABLE part_motion (
  frame_index INTEGER NOT NULL,
  part_index INTEGER NOT NULL,
  rotation_rest_from_part TEXT NOT NULL CHECK (json_array_length(rotation_rest_from_part) = 9),
  translation_mm TEXT NOT NULL CHECK (json_array_length(translation_mm) = 3),
  PRIMARY KEY (frame_index, part_index),
  FOREIGN KEY (frame_index, part_index) REFERENCES part_frame (frame_index, part_index)
) STRICT, WITHOUT ROWID;
)sql";
}

}  // namespace elbowroom::sessions
