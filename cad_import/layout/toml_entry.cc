#include "cad_import/layout/toml_entry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cad_import/layout/toml_nesting.h"
#include "core/file_limits.h"
#include "core/spelling.h"
#include "core/system/configuration_file.h"

namespace elbowroom::cad_import {

using core::Error;
using core::ErrorKind;

namespace {

// Entries are compared with each other, every spacing with every other, and each one costs time at every
// frame.
constexpr std::size_t kMostEntries = 4'000, kMostSpacings = 200;

// The largest number that a key may have, by the unit in its name.
double LargestOf(std::string_view key) {
  constexpr double kMostTurnsDeg = 36'000.0, kLargestFigure = 1e12;
  if (key.ends_with("_mm")) return core::kLongestLengthMm;
  return key.ends_with("_deg") ? kMostTurnsDeg : kLargestFigure;
}

void RequireShort(const TomlEntry& entry, std::string_view key, const std::string& text) {
  constexpr std::size_t kLongestBytes = 4096;  // as long as a path can be
  if (text.size() > kLongestBytes)
    entry.Fail(key, fmt::format("is longer than {} bytes; shorten it", kLongestBytes));
  if (text.find('\0') != std::string::npos) entry.Fail(key, "has a null character in it; leave it out");
}

}  // namespace

std::string ReadTomlText(const std::filesystem::path& path, std::string_view what) {
  return core::ReadConfiguration(path, path.string(), what);
}

toml::table ParseToml(std::string_view text, const std::string& file) {
  RefuseDeepToml(text, file);
  try {
    return toml::parse(text, std::string_view(file));
  } catch (const toml::parse_error& error) {
    throw Error(ErrorKind::kFormat, fmt::format("{}:{}: not TOML: {}; correct this line", file,
                                                error.source().begin.line, error.description()));
  }
}

toml::table ParseTomlFile(const std::filesystem::path& path, std::string_view what) {
  return ParseToml(ReadTomlText(path, what), path.string());
}

TomlEntry::TomlEntry(const toml::table& table, std::string file, std::string title,
                     std::span<const std::string_view> known)
    : table_(table), file_(std::move(file)), title_(std::move(title)) {
  for (const auto& [key, value] : table_) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    FailAt(key.source(), fmt::format("unknown key '{}'; {}", key.str(),
                                     core::SpellingAdvice(key.str(), known, "remove it")));
  }
}

void TomlEntry::FailAt(const toml::source_region& at, const std::string& what, ErrorKind kind) const {
  throw Error(kind,
              fmt::format("{}:{}: {}{}{}", file_, at.begin.line, title_, title_.empty() ? "" : ": ", what));
}

void TomlEntry::Fail(std::string_view key, const std::string& what, ErrorKind kind) const {
  const toml::node* node = table_.get(key);
  FailAt(node != nullptr ? node->source() : table_.source(), fmt::format("key '{}' {}", key, what), kind);
}

std::string TomlEntry::Text(std::string_view key) const {
  const toml::node* node = Find(key);
  if (node == nullptr) Fail(key, "is missing; add it");
  const auto text = node->value_exact<std::string>();
  if (!text) Fail(key, "must be a text in quotes");
  if (text->empty()) Fail(key, "must not be empty");
  RequireShort(*this, key, *text);
  return *text;
}

std::string TomlEntry::TextOr(std::string_view key, const std::string& otherwise) const {
  const toml::node* node = Find(key);
  if (node == nullptr) return otherwise;
  const auto text = node->value_exact<std::string>();
  if (!text) Fail(key, "must be a text in quotes");
  RequireShort(*this, key, *text);
  return *text;
}

double TomlEntry::NumberOf(const toml::node& node, std::string_view key) const {
  const auto number = node.is_number() ? node.value<double>() : std::nullopt;
  if (!number || !std::isfinite(*number)) Fail(key, "must be a finite number");
  const double most = LargestOf(key);
  if (std::abs(*number) > most) Fail(key, fmt::format("must lie between {} and {}", -most, most));
  return *number;
}

double TomlEntry::Number(std::string_view key) const {
  if (Find(key) == nullptr) Fail(key, "is missing; add it");
  return NumberOf(*Find(key), key);
}

double TomlEntry::NumberOr(std::string_view key, double otherwise) const {
  return Find(key) == nullptr ? otherwise : NumberOf(*Find(key), key);
}

Eigen::Vector3d TomlEntry::VectorOrZero(std::string_view key) const {
  return Vector(key).value_or(Eigen::Vector3d::Zero());
}

std::optional<Eigen::Vector3d> TomlEntry::Vector(std::string_view key) const {
  const toml::node* node = Find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != 3) Fail(key, "must be three numbers, [x, y, z]");
  Eigen::Vector3d result;
  for (std::size_t i = 0; i < 3; ++i) result[static_cast<Eigen::Index>(i)] = NumberOf(*array->get(i), key);
  return result;
}

bool TomlEntry::FlagOr(std::string_view key, bool otherwise) const {
  const toml::node* node = Find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->value_exact<bool>();
  if (!value) Fail(key, "must be true or false");
  return *value;
}

std::vector<std::string> TomlEntry::Texts(std::string_view key) const {
  const toml::node* node = Find(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr) Fail(key, "must be a list of texts, [\"tongs\", \"screwdriver\"]");
  if (array->size() > kMostEntries)
    Fail(key, fmt::format("has {} entries; at most {} can be used", array->size(), kMostEntries));
  std::vector<std::string> texts;
  for (const toml::node& element : *array) {
    const auto text = element.value_exact<std::string>();
    if (!text || text->empty()) Fail(key, "must hold nothing but texts in quotes");
    RequireShort(*this, key, *text);
    texts.push_back(*text);
  }
  return texts;
}

std::optional<core::LengthUnit> TomlEntry::Unit() const {
  if (Find("unit") == nullptr) return std::nullopt;
  const auto unit = core::ParseLengthUnit(Text("unit"));
  if (!unit) Fail("unit", "must be \"mm\", \"cm\", \"m\" or \"in\"");
  return unit;
}

std::vector<TomlEntry> TomlEntry::Entries(std::string_view key,
                                          std::span<const std::string_view> known) const {
  const toml::node* node = Find(key);
  if (node == nullptr) return {};
  const toml::array* tables = node->as_array();
  if (tables == nullptr) Fail(key, fmt::format("must be written as [[{}]]", key));
  const std::size_t most = key == "spacing" ? kMostSpacings : kMostEntries;
  if (tables->size() > most)
    Fail(key, fmt::format("has {} entries; at most {} can be used", tables->size(), most));
  std::vector<TomlEntry> entries;
  for (const toml::node& element : *tables) {
    if (!element.is_table()) Fail(key, fmt::format("must be written as [[{}]]", key));
    entries.emplace_back(*element.as_table(), file_, fmt::format("[[{}]]", key), known);
  }
  return entries;
}

}  // namespace elbowroom::cad_import
