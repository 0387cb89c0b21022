#include "recon/rig_files/yaml_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/spelling.h"
#include "core/system/configuration_file.h"
#include "recon/rig_files/storage_xml.h"

namespace elbowroom::recon {
namespace {

// Appends every number of a list or of lists in it; false if something else is among them.
bool AppendNumbers(const YamlNode& node, std::vector<double>& numbers) {
  if (node.IsNumber()) {
    numbers.push_back(node.number);
    return true;
  }
  return node.kind == YamlKind::kList &&
         std::ranges::all_of(node.items, [&](const YamlNode& item) { return AppendNumbers(item, numbers); });
}

// The size that an !!opencv-matrix declares; -1 if it declares none.
std::int64_t Declared(const YamlNode& matrix, std::string_view size) {
  const YamlNode* node = matrix.Find(size);
  return node != nullptr && node->kind == YamlKind::kInteger ? static_cast<std::int64_t>(node->number) : -1;
}

}  // namespace

void YamlSection::FailAt(int line, const std::string& what, core::ErrorKind kind) const {
  throw core::Error(kind,
                    fmt::format("{}, line {}: {}{}{}", file, line, title, title.empty() ? "" : ": ", what));
}

void YamlSection::Fail(const std::string& what, core::ErrorKind kind) const {
  FailAt(node->line, what, kind);
}

const YamlNode* YamlSection::Find(const char* key) const {
  const YamlNode* found = node->Find(key);
  return found == nullptr || found->kind == YamlKind::kNothing ? nullptr : found;
}

const YamlNode& YamlSection::Get(const char* key, const char* shape) const {
  const YamlNode* found = Find(key);
  if (found == nullptr) Fail(fmt::format("key '{}' is missing; add it: {}", key, shape));
  return *found;
}

std::string YamlSection::TextOr(const char* key, const std::string& otherwise) const {
  const YamlNode* found = Find(key);
  if (found == nullptr) return otherwise;
  if (found->kind != YamlKind::kText)
    FailAt(found->line, fmt::format("key '{}' must be text in quotes", key), core::ErrorKind::kFormat);
  return found->text;
}

double YamlSection::NumberOr(const char* key, double otherwise) const {
  const YamlNode* found = Find(key);
  if (found == nullptr) return otherwise;
  if (!found->IsNumber())
    FailAt(found->line, fmt::format("key '{}' must be a number", key), core::ErrorKind::kFormat);
  return found->number;
}

int YamlSection::Integer(const char* key, const char* shape) const {
  const YamlNode& found = Get(key, shape);
  if (found.kind != YamlKind::kInteger)
    FailAt(found.line, fmt::format("key '{}' must be {}", key, shape), core::ErrorKind::kFormat);
  return static_cast<int>(found.number);
}

std::vector<double> YamlSection::Numbers(const char* key, int rows, std::size_t count,
                                         const char* shape) const {
  const YamlNode& found = Get(key, shape);
  const auto fail = [&](const std::string& what) { FailAt(found.line, what, core::ErrorKind::kFormat); };
  const bool is_matrix = found.kind == YamlKind::kMap;
  const YamlNode* data = is_matrix ? found.Find("data") : &found;
  std::vector<double> numbers;
  if (data == nullptr || !AppendNumbers(*data, numbers))
    fail(fmt::format("key '{}' must hold numbers: {}", key, shape));
  const std::int64_t declared_rows = is_matrix ? Declared(found, "rows") : 0,
                     declared_columns = is_matrix ? Declared(found, "cols") : 0;
  const bool is_shaped = !is_matrix || rows == 0 || declared_rows == rows || declared_columns == rows;
  const bool is_filled =
      !is_matrix || (declared_rows >= 0 && declared_columns >= 0 &&
                     declared_rows * declared_columns == static_cast<std::int64_t>(numbers.size()));
  if (!is_shaped || !is_filled || (count != 0 && numbers.size() != count)) {
    const std::string size =
        is_matrix ? fmt::format("{} x {}", declared_rows, declared_columns) : std::string("a list");
    fail(fmt::format("key '{}' has the wrong size ({}, {} numbers); it must be {}", key, size, numbers.size(),
                     shape));
  }
  return numbers;
}

void YamlSection::RefuseMisspelt(std::span<const std::string_view> known) const {
  for (std::size_t i = 0; i < node->keys.size(); ++i) {
    const std::string& key = node->keys[i];
    if (std::ranges::find(known, key) != known.end()) continue;
    if (const auto meant = core::NearestWord(key, known))
      FailAt(node->items[i].line, fmt::format("unknown key '{}'; did you mean '{}'?", key, *meant),
             core::ErrorKind::kFormat);
  }
}

YamlNode ReadYamlFile(const std::filesystem::path& path, const std::string& who, std::string_view what) {
  return ParseYaml(core::ReadConfiguration(path, who, what), who);
}

YamlNode ParseStorage(std::string_view text, const std::string& who) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string_view::npos && text[first] == '<') return ParseStorageXml(text, who);
  return ParseYaml(text, who, YamlHeader::kOptional);
}

}  // namespace elbowroom::recon
