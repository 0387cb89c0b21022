#include "sessions/schema/schema.h"

namespace elbowroom::sessions {

// One byte a boundary pixel (core::SoftMask), row by row; NULL: its boundary is halfway between pixel
// centres.
std::string Schema2Sql() { return "ALTER TABLE mask ADD COLUMN levels_zstd BLOB"; }

}  // namespace elbowroom::sessions
