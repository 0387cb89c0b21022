// The layout as rows: parts, their meshes by content, spacings, pair rules, what gives way.
#pragma once

#include "core/layout.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// The layout is valid; parts with equal meshes share one mesh row.
void InsertLayout(Database& database, const core::Layout& layout);

// Without the layout's own default unit. Parts with equal meshes share one in memory too.
// Throws: Error{kFormat} naming file and mesh where one is damaged.
[[nodiscard]] core::Layout ReadLayout(Database& database);

// Throws: Error{kFormat} naming the file.
[[nodiscard]] core::LengthUnit UnitFromText(const std::string& text, const Database& database);

}  // namespace elbowroom::sessions
