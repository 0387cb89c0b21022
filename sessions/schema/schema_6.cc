#include "sessions/schema/schema.h"

namespace elbowroom::sessions {

std::string Schema6Sql() {
  return R"sql(
-- Parts that spacings name together.
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

-- Of a spacing of groups; moving_part or reference_part is the first of that group then.
ALTER TABLE spacing ADD COLUMN moving_group INTEGER REFERENCES part_group (group_index);
ALTER TABLE spacing ADD COLUMN reference_group INTEGER REFERENCES part_group (group_index);
)sql";
}

}  // namespace elbowroom::sessions
