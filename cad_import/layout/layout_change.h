// Changes the text of a layout file from one layout to another.
#pragma once

#include <string_view>
#include <vector>

#include "cad_import/layout/layout_fields.h"
#include "cad_import/layout/layout_text.h"
#include "core/layout.h"

namespace elbowroom::cad_import {

// Changes `text`, which says `before`, so that it says `after`. Entries are matched by their names, pairs by
// both of theirs. What the two layouts have alike isn't touched, so an entry doesn't get keys that would only
// state a default. Throws: as LayoutText and FieldsOf.
void ChangeInto(LayoutText& text, const core::Layout& before, const core::Layout& after);

// The same for the entries of one kind.
void ChangeEntries(LayoutText& text, std::string_view kind, std::vector<Fields> before,
                   const std::vector<Fields>& after);

}  // namespace elbowroom::cad_import
