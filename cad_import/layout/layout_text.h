// A LAYOUT.toml as its author wrote it, changed in place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cad_import/layout/layout_fields.h"
#include "core/units.h"

namespace elbowroom::cad_import {

// A change keeps comments, the order of keys and the way in which other things are written. An entry that is
// removed takes its own lines along, and the comments right above and below it. The changed text is parsed
// again, and a change that doesn't say what was meant isn't kept. Entries [[kind]] count from 0. Every change
// throws: Error{kFormat} with file and line where the text can't be changed so (an entry that isn't written
// as [[kind]]); PreconditionError for an entry that doesn't exist.
class LayoutText {
 public:
  // `file` is for messages. Throws: Error{kFormat} with the line that isn't TOML.
  explicit LayoutText(std::string text = {}, std::filesystem::path file = {});
  // Throws: Error{kFile} when there is no such file; the same.
  [[nodiscard]] static LayoutText Read(const std::filesystem::path& file);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  [[nodiscard]] std::size_t Count(std::string_view kind) const;
  [[nodiscard]] std::int64_t LineOf(std::string_view kind, std::size_t index) const;  // from 1
  // A key's text, or the texts of its list; none where it is absent or something else.
  [[nodiscard]] std::vector<std::string> TextsOf(std::string_view kind, std::size_t index,
                                                 std::string_view key) const;
  [[nodiscard]] bool Has(std::string_view kind, std::size_t index, std::string_view key) const;

  // Of the layout as a whole; nothing where it names none, or none that is known.
  [[nodiscard]] std::optional<core::LengthUnit> unit() const;

  void SetUnit(core::LengthUnit unit);
  void Insert(std::string_view kind, std::size_t index, const Fields& fields);  // before that one
  void Append(std::string_view kind, const Fields& fields) { Insert(kind, Count(kind), fields); }
  void Remove(std::string_view kind, std::size_t index);
  void Move(std::string_view kind, std::size_t from, std::size_t to);
  void Set(std::string_view kind, std::size_t index, const Field& field);
  void Unset(std::string_view kind, std::size_t index, std::string_view key);

 private:
  class Edit;
  static void InsertBlock(Edit& edit, std::string_view kind, std::size_t index, std::string block);

  std::string text_;
  std::filesystem::path file_;
};

}  // namespace elbowroom::cad_import
