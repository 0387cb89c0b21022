// From what a layout file says to what it shall say.
#pragma once

#include "cad_import/layout/layout_text.h"
#include "core/layout.h"

namespace elbowroom::cad_import {

// Changes `text` from `before`, which it says, to `after`. Entries are known by their names, pairs by both of
// theirs; what the two layouts have alike isn't touched, and keys that only say what holds anyway aren't
// added. Throws: as LayoutText and FieldsOf.
void ChangeInto(LayoutText& text, const core::Layout& before, const core::Layout& after);

}  // namespace elbowroom::cad_import
