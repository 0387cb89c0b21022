// The keys of a [[part]] that say how it gives way.
#pragma once

#include "cad_import/layout/layout_fields.h"
#include "cad_import/layout/toml_entry.h"
#include "core/gives_way.h"

namespace elbowroom::cad_import {

// Reads `gives_way = "cloth" | "pushed" | "none"` (absent: none) and the keys that go with it. Throws:
// core::Error{kFormat} with file, line and key: another word, a side that the bounds don't have, a key that
// this way of giving way doesn't have.
[[nodiscard]] core::GivesWay ReadGivesWay(const TomlEntry& entry);

// The same keys; none for a part that doesn't give way.
[[nodiscard]] Fields GivesWayFields(const core::GivesWay& gives_way);

}  // namespace elbowroom::cad_import
