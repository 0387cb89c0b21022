#include "sessions/schema/schema.h"

namespace elbowroom::sessions {

std::string Schema5Sql() {
  return R"sql(
-- How far the mesh and the surface that it stands for may be apart; in every clearance's bounds already.
ALTER TABLE mesh ADD COLUMN deviation_mm REAL NOT NULL DEFAULT 0 CHECK (deviation_mm >= 0);

-- 'file': the part's file was read in a unit of its own, such as feet; `unit` is no matter.
ALTER TABLE part ADD COLUMN unit_of TEXT NOT NULL DEFAULT 'part' CHECK (unit_of IN ('part', 'file'));
)sql";
}

}  // namespace elbowroom::sessions
