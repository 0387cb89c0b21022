#include "cad_import/layout/layout_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>

#include "cad_import/layout/toml_entry.h"
#include "cad_import/layout/toml_lines.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

void Assign(toml::table& table, const Field& field) {
  std::visit(
      [&](const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
          table.insert_or_assign(field.key, toml::array{value.x(), value.y(), value.z()});
        } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
          toml::array list;
          for (const std::string& text : value) list.push_back(text);
          table.insert_or_assign(field.key, std::move(list));
        } else {
          table.insert_or_assign(field.key, value);
        }
      },
      field.value);
}

toml::table TableOf(const Fields& fields) {
  toml::table table;
  for (const Field& field : fields) Assign(table, field);
  return table;
}

// As `node` is written: a whole number without a point stays one.
std::string TomlLike(const toml::node& node, const FieldValue& value) {
  constexpr double kExact = 9e15;  // whole numbers below are themselves
  const double* number = std::get_if<double>(&value);
  if (number && node.is_integer() && std::trunc(*number) == *number && std::abs(*number) < kExact)
    return fmt::format("{:.0f}", *number);
  return TomlOf(value);
}

// The elements of a list, if it replaces one with as many elements; otherwise none.
std::vector<FieldValue> ElementsFor(const toml::node& node, const FieldValue& value) {
  std::vector<FieldValue> elements;
  if (const auto* v = std::get_if<Eigen::Vector3d>(&value)) elements = {v->x(), v->y(), v->z()};
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value))
    elements.assign(texts->begin(), texts->end());
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != elements.size()) elements.clear();
  return elements;
}

const toml::key* FindKey(const toml::table& table, std::string_view key) {
  for (const auto& [name, value] : table)
    if (name.str() == key) return &name;
  return nullptr;
}

}  // namespace

// One change: the text, what it says, and what it shall say.
class LayoutText::Edit {
 public:
  explicit Edit(LayoutText& owner)
      : owner_(owner),
        document_(ParseToml(owner.text_, owner.file_.string())),
        lines_(owner.text_, document_),
        meant_(document_),
        text_(owner.text_) {}

  [[nodiscard]] const TomlLines& lines() const { return lines_; }
  [[nodiscard]] const toml::table& document() const { return document_; }
  [[nodiscard]] toml::table& meant() { return meant_; }

  [[nodiscard]] const toml::table& Entry(std::string_view kind, std::size_t index) const {
    const toml::node* entry = document_[kind][index].node();
    core::Require(entry != nullptr, "an entry that the layout has");
    const toml::source_index line = entry->source().begin.line;
    if (!entry->is_table() || !lines_.IsHeader(line - 1))
      Fail(line, fmt::format("isn't written as [[{}]]; write it so, or change it in an editor", kind));
    return *entry->as_table();
  }
  [[nodiscard]] LineRange LinesOf(std::string_view kind, std::size_t index) const {
    return lines_.LinesOf(Entry(kind, index));
  }
  [[nodiscard]] toml::array& MeantEntries(std::string_view kind) {
    if (meant_.get(kind) == nullptr) meant_.insert(kind, toml::array());
    toml::array* entries = meant_[kind].as_array();
    if (entries == nullptr)
      Fail(document_.get(kind)->source().begin.line,
           fmt::format("'{0}' isn't written as [[{0}]]; write it so, or change it in an editor", kind));
    return *entries;
  }
  [[nodiscard]] toml::table& MeantEntry(std::string_view kind, std::size_t index) {
    return *MeantEntries(kind)[index].as_table();
  }

  // `region` counts in the text as it was read, so several replacements must go from the end to the
  // beginning.
  void Replace(const toml::source_region& region, std::string_view by) {
    const std::size_t from = lines_.Offset(region.begin);
    text_.replace(from, lines_.Offset(region.end) - from, by);
  }
  void RemoveLines(const LineRange& range) {
    const std::size_t from = lines_.Start(range.first);
    text_.erase(from, lines_.Start(range.last + 1) - from);
  }
  // Before that line, which may be the one after the last.
  void InsertLines(std::size_t line, std::string inserted) {
    const bool is_open = line == lines_.size() && !text_.empty() && !text_.ends_with('\n');
    if (is_open) inserted.insert(0, lines_.EndOfLine());
    text_.insert(lines_.Start(line), inserted);
  }

  // Throws unless the text now says what is meant.
  void Keep() {
    bool is_meant = false;
    try {
      is_meant = SaysTheSame(ParseToml(text_, owner_.file_.string()), meant_);
    } catch (const Error&) {
      // Reported below: the line of this error is in a text that the author never sees.
    }
    if (!is_meant) Fail(1, "can't be changed in place; change it in an editor");
    owner_.text_ = std::move(text_);
  }

 private:
  [[noreturn]] void Fail(toml::source_index line, const std::string& what) const {
    throw Error(ErrorKind::kFormat, fmt::format("{}:{}: {}", owner_.file_.string(), line, what));
  }

  LayoutText& owner_;
  toml::table document_;
  TomlLines lines_;
  toml::table meant_;
  std::string text_;
};

LayoutText::LayoutText(std::string text, std::filesystem::path file)
    : text_(std::move(text)), file_(std::move(file)) {
  (void)ParseToml(text_, file_.string());
}

LayoutText LayoutText::Read(const std::filesystem::path& file) {
  return LayoutText(ReadTomlText(file, "layout file"), file);
}

std::size_t LayoutText::Count(std::string_view kind) const {
  const toml::table document = ParseToml(text_, file_.string());
  const toml::array* entries = document[kind].as_array();
  return entries == nullptr ? 0 : entries->size();
}

std::int64_t LayoutText::LineOf(std::string_view kind, std::size_t index) const {
  const toml::table document = ParseToml(text_, file_.string());
  const toml::node* entry = document[kind][index].node();
  core::Require(entry != nullptr, "an entry that the layout has");
  return entry->source().begin.line;
}

std::vector<std::string> LayoutText::TextsOf(std::string_view kind, std::size_t index,
                                             std::string_view key) const {
  const toml::table document = ParseToml(text_, file_.string());
  const auto value = document[kind][index][key];
  if (const auto text = value.value<std::string>()) return {*text};
  std::vector<std::string> texts;
  if (const toml::array* array = value.as_array()) {
    for (const toml::node& element : *array)
      if (const auto text = element.value<std::string>()) texts.push_back(*text);
  }
  return texts;
}

bool LayoutText::Has(std::string_view kind, std::size_t index, std::string_view key) const {
  const toml::table document = ParseToml(text_, file_.string());
  return document[kind][index][key].node() != nullptr;
}

std::optional<core::LengthUnit> LayoutText::unit() const {
  const toml::table document = ParseToml(text_, file_.string());
  const auto named = document["unit"].value<std::string>();
  return named ? core::ParseLengthUnit(*named) : std::nullopt;
}

void LayoutText::SetUnit(core::LengthUnit unit) {
  Edit edit(*this);
  const std::string written = TomlOf(std::string(core::ToString(unit)));
  if (const toml::node* node = edit.document().get("unit")) {
    edit.Replace(node->source(), written);
  } else {
    const TomlLines& lines = edit.lines();
    std::size_t line = 0;
    while (line < lines.size() && lines.IsComment(line)) ++line;
    const bool is_tight = line < lines.size() && !lines.IsBlank(line);
    edit.InsertLines(
        line, fmt::format("unit = {}{}{}", written, lines.EndOfLine(), is_tight ? lines.EndOfLine() : ""));
  }
  edit.meant().insert_or_assign("unit", core::ToString(unit));
  edit.Keep();
}

void LayoutText::Insert(std::string_view kind, std::size_t index, const Fields& fields) {
  Edit edit(*this);
  const std::string_view end = edit.lines().EndOfLine();
  std::string block = fmt::format("[[{}]]{}", kind, end);
  for (const Field& field : fields) block += fmt::format("{} = {}{}", field.key, TomlOf(field.value), end);
  InsertBlock(edit, kind, index, block);
  toml::array& entries = edit.MeantEntries(kind);
  entries.insert(entries.cbegin() + static_cast<std::ptrdiff_t>(index), TableOf(fields));
  edit.Keep();
}

void LayoutText::InsertBlock(Edit& edit, std::string_view kind, std::size_t index, std::string block) {
  const TomlLines& lines = edit.lines();
  const std::size_t count = edit.MeantEntries(kind).size();
  core::Require(index <= count, "a place among the entries, or after them");
  if (index < count) {
    edit.InsertLines(edit.LinesOf(kind, index).first, block.append(lines.EndOfLine()));
    return;
  }
  const std::size_t line = count > 0 ? edit.LinesOf(kind, count - 1).last + 1 : lines.size();
  if (line > 0 && !lines.IsBlank(line - 1)) block.insert(0, lines.EndOfLine());
  if (line < lines.size() && !lines.IsBlank(line)) block.append(lines.EndOfLine());
  edit.InsertLines(line, std::move(block));
}

void LayoutText::Remove(std::string_view kind, std::size_t index) {
  Edit edit(*this);
  const TomlLines& lines = edit.lines();
  LineRange range = edit.LinesOf(kind, index);
  if (range.first == 0 || lines.IsBlank(range.first - 1))
    while (range.last + 1 < lines.size() && lines.IsBlank(range.last + 1)) ++range.last;
  if (range.last + 1 == lines.size())
    while (range.first > 0 && lines.IsBlank(range.first - 1)) --range.first;
  edit.RemoveLines(range);
  toml::array& entries = edit.MeantEntries(kind);
  entries.erase(entries.cbegin() + static_cast<std::ptrdiff_t>(index));
  if (entries.empty()) edit.meant().erase(kind);
  edit.Keep();
}

void LayoutText::Move(std::string_view kind, std::size_t from, std::size_t to) {
  LayoutText moved = *this;
  const Edit before(moved);
  std::string block(before.lines().Text(before.LinesOf(kind, from)));
  if (!block.ends_with('\n')) block += before.lines().EndOfLine();
  toml::table table = before.Entry(kind, from);
  moved.Remove(kind, from);
  Edit edit(moved);
  InsertBlock(edit, kind, to, std::move(block));
  toml::array& entries = edit.MeantEntries(kind);
  entries.insert(entries.cbegin() + static_cast<std::ptrdiff_t>(to), std::move(table));
  edit.Keep();
  *this = std::move(moved);
}

void LayoutText::Set(std::string_view kind, std::size_t index, const Field& field) {
  Edit edit(*this);
  const toml::table& entry = edit.Entry(kind, index);
  if (const toml::node* node = entry.get(field.key)) {
    const std::vector<FieldValue> elements = ElementsFor(*node, field.value);
    for (std::size_t i = elements.size(); i-- > 0;) {
      const toml::node& element = *node->as_array()->get(i);
      edit.Replace(element.source(), TomlLike(element, elements[i]));
    }
    if (elements.empty()) edit.Replace(node->source(), TomlLike(*node, field.value));
  } else {
    toml::source_index above = entry.source().begin.line;
    for (const std::string_view key : KeysOf(kind)) {
      if (key == field.key) break;
      if (const toml::node* other = entry.get(key)) above = LastLineOf(*other);
    }
    edit.InsertLines(above, fmt::format("{}{} = {}{}", edit.lines().Indent(above - 1), field.key,
                                        TomlOf(field.value), edit.lines().EndOfLine()));
  }
  Assign(edit.MeantEntry(kind, index), field);
  edit.Keep();
}

void LayoutText::Unset(std::string_view kind, std::size_t index, std::string_view key) {
  Edit edit(*this);
  const toml::table& entry = edit.Entry(kind, index);
  const toml::node* node = entry.get(key);
  if (node == nullptr) return;
  edit.RemoveLines({FindKey(entry, key)->source().begin.line - 1, LastLineOf(*node) - 1});
  edit.MeantEntry(kind, index).erase(key);
  edit.Keep();
}

}  // namespace elbowroom::cad_import
