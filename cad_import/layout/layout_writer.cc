#include "cad_import/layout/layout_change.h"
#include "cad_import/layout/layout_file.h"
#include "cad_import/layout/layout_text.h"
#include "core/system/whole_file.h"

namespace elbowroom::cad_import {

void WriteLayoutFile(const core::Layout& layout, const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) {
    LayoutText text = LayoutText::Read(path);
    ChangeInto(text, ImportLayoutText(text).layout, layout);
    core::WriteWholeFile(path, text.text());
    return;
  }
  LayoutText text({}, path);
  text.SetUnit(layout.unit);
  core::Layout empty;
  empty.unit = layout.unit;
  ChangeInto(text, empty, layout);
  core::WriteWholeFile(path, text.text());
}

}  // namespace elbowroom::cad_import
