#include "app/control/layout_editing/section_file.h"

#include "app/control/layout_editing/folder_lock.h"
#include "core/system/whole_file.h"

namespace elbowroom::control {

void SaveSections(const std::filesystem::path& layout,
                  const std::vector<cad_import::LayoutSection>& sections) {
  const FolderLock lock(layout, FolderLock::Waiting::kNo);
  cad_import::LayoutText text = cad_import::LayoutText::Read(layout);
  cad_import::ChangeSections(text, sections);
  core::WriteWholeFile(layout, text.text());
}

}  // namespace elbowroom::control
