// A layout while somebody edits it: its text, what the text says, and every step back.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/layout_editing/part_preview.h"
#include "cad_import/layout/layout_text.h"
#include "cad_import/layout/part_shelf.h"
#include "core/history.h"
#include "core/layout.h"
#include "core/progress.h"

namespace elbowroom::control {

// The text is what is edited and saved, so that comments stay; the layout is read from it anew after each
// change. A change that doesn't give a valid layout is refused, and nothing has changed. Every change has a
// name, and can be undone and redone, also after the file was saved. Part files are read once.
// Thread: one at a time.
class LayoutDocument {
 public:
  using Change = std::function<void(cad_import::LayoutText&)>;
  enum class AutosaveThen { kDropped, kKept };  // kept: it holds another run's changes

  // An empty layout without a file. Until it is saved, its text names part files as seen from `folder`, and
  // its autosave lies there.
  explicit LayoutDocument(const std::filesystem::path& folder);
  // Throws: as cad_import::ImportLayoutFile; a layout without parts is none of its faults here.
  [[nodiscard]] static LayoutDocument Open(const std::filesystem::path& file,
                                           const core::Progress& progress = {},
                                           const std::stop_token& stop = {});
  // What the autosave of that file holds, as a change that isn't saved yet. `file` may be that of a layout
  // that was never saved (UntitledFile). Throws: likewise; Error{kFile} where there is no autosave.
  [[nodiscard]] static LayoutDocument Recover(const std::filesystem::path& file,
                                              const core::Progress& progress = {},
                                              const std::stop_token& stop = {});
  // The name under which a layout without a file has its autosave in that folder.
  [[nodiscard]] static std::filesystem::path UntitledFile(const std::filesystem::path& folder);

  [[nodiscard]] const cad_import::LayoutText& text() const { return history_.now().text; }
  [[nodiscard]] const core::Layout& layout() const { return history_.now().layout; }
  // Of the part files, each naming its part.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return history_.now().warnings; }
  [[nodiscard]] const std::filesystem::path& file() const { return text().file(); }
  [[nodiscard]] bool has_file() const { return has_file_; }
  [[nodiscard]] bool is_changed() const { return text().text() != saved_text_; }

  // `name` says in the menu what was done: "Move lid". Changes with the same `merge_key`, one after the
  // other, are one step back; an empty key is never merged. Throws: what `change` throws;
  // Error{kFormat, kRange} as ImportLayoutText.
  void Apply(const std::string& name, const Change& change, const std::string& merge_key = {});

  // One change that adds a part for each node of the preview's file, named after the node; an empty node is
  // the whole file. `name`: of the change, given the parts' names, as Apply's. Returns these. Throws: as
  // Apply.
  using NameOfAdding = std::function<std::string(const std::vector<std::string>& parts)>;
  std::vector<std::string> AddParts(const PartPreview& preview, const std::vector<std::string>& nodes,
                                    const NameOfAdding& name = EnglishNameOfAdding);
  static std::string EnglishNameOfAdding(const std::vector<std::string>& parts);  // "Add lid", "Add 3 parts"

  [[nodiscard]] bool CanUndo() const { return history_.CanUndo(); }
  [[nodiscard]] bool CanRedo() const { return history_.CanRedo(); }
  [[nodiscard]] const std::string& UndoName() const { return history_.now().name; }
  [[nodiscard]] const std::string& RedoName() const { return history_.next().name; }
  void Undo();
  void Redo();

  // Writes the text whole or not at all, and drops the autosave. Throws: PreconditionError without a
  // file; Error{kFile} when it can't be written, when another program changed the file since it was read, or
  // is changing the folder's layouts just now. Sections that were saved there since (SaveSections) are kept.
  void Save(AutosaveThen autosave = AutosaveThen::kDropped);
  // Likewise into another file, which may be in another folder: every state's relative part files are named
  // as seen from there. A file that is there is replaced.
  void SaveAs(const std::filesystem::path& file, AutosaveThen autosave = AutosaveThen::kDropped);
  // Brings the text beside the file, for Recover.
  void Autosave() const;

 private:
  struct State {
    cad_import::LayoutText text;
    core::Layout layout;
    std::vector<std::string> warnings;
    std::string name;  // of the change that led here
    std::string merge_key;

    [[nodiscard]] bool operator==(const State& other) const { return text.text() == other.text.text(); }
  };

  LayoutDocument(State first, std::shared_ptr<cad_import::PartShelf> shelf, std::string saved_text,
                 bool has_file);
  static State Read(cad_import::LayoutText text, cad_import::PartShelf& shelf,
                    const core::Progress& progress = {}, const std::stop_token& stop = {});
  [[nodiscard]] bool TakeSections(const cad_import::LayoutText& in_file);
  static State Rebased(const State& state, const std::filesystem::path& file);

  std::shared_ptr<cad_import::PartShelf> shelf_;
  core::History<State> history_;
  std::string saved_text_;
  bool has_file_ = false;
  bool may_merge_ = false;  // not across an undo or a save
};

}  // namespace elbowroom::control
