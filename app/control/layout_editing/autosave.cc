#include "app/control/layout_editing/autosave.h"

#include <system_error>

#include "core/error.h"
#include "core/system/whole_file.h"

namespace elbowroom::control {

std::filesystem::path AutosaveOf(const std::filesystem::path& layout) {
  std::filesystem::path kept = layout;
  kept += ".unsaved";
  return kept;
}

void WriteAutosave(const cad_import::LayoutText& text) {
  core::WriteWholeFile(AutosaveOf(text.file()), text.text());
}

std::optional<cad_import::LayoutText> FindAutosave(const std::filesystem::path& layout) {
  try {
    const std::string kept = cad_import::LayoutText::Read(AutosaveOf(layout)).text();
    if (std::filesystem::exists(layout) && cad_import::LayoutText::Read(layout).text() == kept)
      return std::nullopt;
    return cad_import::LayoutText(kept, layout);
  } catch (const core::Error&) {  // what can't be read can't be recovered
    return std::nullopt;
  }
}

void DropAutosave(const std::filesystem::path& layout) {
  std::error_code ignored;
  std::filesystem::remove(AutosaveOf(layout), ignored);
}

}  // namespace elbowroom::control
