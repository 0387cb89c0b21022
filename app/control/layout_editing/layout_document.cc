#include "app/control/layout_editing/layout_document.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "app/control/layout_editing/autosave.h"
#include "app/control/layout_editing/folder_lock.h"
#include "app/control/layout_editing/layout_edit.h"
#include "cad_import/layout/layout_file.h"
#include "cad_import/layout/layout_sections.h"
#include "core/error.h"
#include "core/system/whole_file.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;
using cad_import::LayoutText;

bool IsEmpty(const LayoutText& text) {
  for (const std::string_view kind : cad_import::kEntryKinds)
    if (text.Count(kind) > 0) return false;
  return text.Count("group") == 0;
}

// The last name of a node's path, or the file's.
std::string WantedName(const PartPreview& preview, const std::string& node) {
  return node.empty() ? preview.file.stem().string() : node.substr(node.rfind('/') + 1);
}

}  // namespace

LayoutDocument::State LayoutDocument::Read(LayoutText text, cad_import::PartShelf& shelf,
                                           const core::Progress& progress, const std::stop_token& stop) {
  State state{std::move(text), {}, {}, {}, {}};
  if (IsEmpty(state.text)) {
    state.layout.unit = state.text.unit().value_or(state.layout.unit);
    return state;
  }
  cad_import::ImportedLayout imported = cad_import::ImportLayoutText(state.text, shelf, progress, stop);
  state.layout = std::move(imported.layout);
  state.warnings = std::move(imported.warnings);
  return state;
}

LayoutDocument::LayoutDocument(State first, std::shared_ptr<cad_import::PartShelf> shelf,
                               std::string saved_text, bool has_file)
    : shelf_(std::move(shelf)),
      history_(std::move(first)),
      saved_text_(std::move(saved_text)),
      has_file_(has_file) {}

LayoutDocument::LayoutDocument(const fs::path& folder)
    : LayoutDocument(State{LayoutText({}, UntitledFile(folder)), {}, {}, {}, {}},
                     std::make_shared<cad_import::PartShelf>(), {}, false) {}

fs::path LayoutDocument::UntitledFile(const fs::path& folder) { return folder / "untitled_layout.toml"; }

LayoutDocument LayoutDocument::Open(const fs::path& file, const core::Progress& progress,
                                    const std::stop_token& stop) {
  auto shelf = std::make_shared<cad_import::PartShelf>();
  State state = Read(LayoutText::Read(file), *shelf, progress, stop);
  std::string saved = state.text.text();
  return {std::move(state), std::move(shelf), std::move(saved), true};
}

LayoutDocument LayoutDocument::Recover(const fs::path& file, const core::Progress& progress,
                                       const std::stop_token& stop) {
  std::optional<LayoutText> kept = FindAutosave(file);
  if (!kept)
    throw core::Error(core::ErrorKind::kFile, fmt::format("{}: it has no changes that weren't saved; open it "
                                                          "as it is",
                                                          file.string()));
  auto shelf = std::make_shared<cad_import::PartShelf>();
  const bool has_file = fs::exists(file);
  std::string saved = has_file ? LayoutText::Read(file).text() : std::string();
  return {Read(*std::move(kept), *shelf, progress, stop), std::move(shelf), std::move(saved), has_file};
}

void LayoutDocument::Apply(const std::string& name, const Change& change, const std::string& merge_key) {
  LayoutText text = this->text();
  change(text);
  State state = Read(std::move(text), *shelf_);
  state.name = name;
  state.merge_key = merge_key;
  const bool is_merged =
      may_merge_ && !merge_key.empty() && history_.CanUndo() && history_.now().merge_key == merge_key;
  history_ = (is_merged ? history_.Undone() : history_).Changed(std::move(state));
  may_merge_ = true;
}

std::string LayoutDocument::EnglishNameOfAdding(const std::vector<std::string>& parts) {
  return parts.size() == 1 ? fmt::format("Add {}", parts.front()) : fmt::format("Add {} parts", parts.size());
}

std::vector<std::string> LayoutDocument::AddParts(const PartPreview& preview,
                                                  const std::vector<std::string>& nodes,
                                                  const NameOfAdding& name) {
  if (!preview.asks_for_unit())
    shelf_->Put(preview.file, {.unit = preview.chosen_unit, .unit_if_file_has_none = text().unit()},
                preview.model);
  LayoutText text = this->text();
  std::vector<std::string> names;
  for (const std::string& node : nodes) {
    PartEdit edit;
    edit.file = preview.file;
    edit.node = node;
    edit.unit = preview.chosen_unit;
    edit.name = FreePartName(text, WantedName(preview, node));
    names.push_back(AddPart(text, edit));
  }
  Apply(name(names), [&](LayoutText& changed) { changed = std::move(text); });
  return names;
}

void LayoutDocument::Undo() {
  history_ = history_.Undone();
  may_merge_ = false;
}

void LayoutDocument::Redo() {
  history_ = history_.Redone();
  may_merge_ = false;
}

// Another page of the window saves section planes into the file; they are no reason to refuse.
bool LayoutDocument::TakeSections(const LayoutText& in_file) {
  if (in_file.text() == saved_text_) return true;
  try {
    const std::vector<cad_import::LayoutSection> sections = cad_import::SectionsOf(in_file);
    LayoutText saved(saved_text_, file());
    cad_import::ChangeSections(saved, sections);
    if (saved.text() != in_file.text()) return false;
    history_ = history_.Mapped([&](State state) {
      cad_import::ChangeSections(state.text, sections);
      return state;
    });
    return true;
  } catch (const core::Error&) {  // more than its sections was changed
    return false;
  }
}

void LayoutDocument::Save(AutosaveThen autosave) {
  core::Require(has_file_, "a layout that has a file");
  const FolderLock lock(file(), FolderLock::Waiting::kNo);
  if (fs::exists(file()) && !TakeSections(LayoutText::Read(file())))
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("{}: another program changed it since it was opened; save yours under "
                                  "another name, or open it again",
                                  file().string()));
  core::WriteWholeFile(file(), text().text());
  saved_text_ = text().text();
  may_merge_ = false;
  if (autosave == AutosaveThen::kDropped) DropAutosave(file());
}

void LayoutDocument::SaveAs(const fs::path& file, AutosaveThen autosave) {
  core::History<State> moved = history_.Mapped([&](const State& state) { return Rebased(state, file); });
  const FolderLock lock(file, FolderLock::Waiting::kNo);
  core::WriteWholeFile(file, moved.now().text.text());
  if (autosave == AutosaveThen::kDropped) DropAutosave(this->file());
  history_ = std::move(moved);
  saved_text_ = text().text();
  has_file_ = true;
  may_merge_ = false;
}

LayoutDocument::State LayoutDocument::Rebased(const State& state, const fs::path& file) {
  State moved = state;
  moved.text = LayoutText(state.text.text(), file);
  const fs::path from = fs::absolute(state.text.file()).parent_path();
  if (from.lexically_normal() == fs::absolute(file).parent_path().lexically_normal()) return moved;
  for (std::size_t i = 0; i < state.layout.parts.size(); ++i) {
    const fs::path part_file = state.layout.parts[i].file;
    if (part_file.is_absolute()) continue;
    const std::string beside = FileBeside(file, from / part_file);
    moved.text.Set("part", i, {"file", beside});
    moved.layout.parts[i].file = beside;
  }
  return moved;
}

void LayoutDocument::Autosave() const { WriteAutosave(text()); }

}  // namespace elbowroom::control
