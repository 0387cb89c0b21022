#include "app/control/layout_editing/autosave.h"

#include <string>
#include <system_error>

#include "core/error.h"
#include "core/system/whole_file.h"

namespace elbowroom::control {
namespace {

std::filesystem::path Autosave(const std::filesystem::path& layout, int place) {
  std::filesystem::path kept = layout;
  kept += place == 1 ? ".unsaved" : ".unsaved" + std::to_string(place);
  return kept;
}

}  // namespace

std::filesystem::path AutosaveOf(const std::filesystem::path& layout) { return Autosave(layout, 1); }

void AppendAutosave(const cad_import::LayoutText& text) {
  int place = 1;
  while (std::filesystem::exists(Autosave(text.file(), place))) ++place;
  core::WriteWholeFile(Autosave(text.file(), place), text.text());
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
  for (int place = 2; std::filesystem::exists(Autosave(layout, place), ignored); ++place)
    std::filesystem::rename(Autosave(layout, place), Autosave(layout, place - 1), ignored);
}

}  // namespace elbowroom::control
