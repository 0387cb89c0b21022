// A TOML file's tables, with what error messages need: file, line, key, what to do.
#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/units.h"

namespace elbowroom::cad_import {

// Throws: Error{kFile} when there is no such file (`what` names its kind: "layout file"), or it can't be
// read.
[[nodiscard]] std::string ReadTomlText(const std::filesystem::path& path, std::string_view what);

// `file` is for messages. Throws: Error{kFormat} with the line that isn't TOML.
[[nodiscard]] toml::table ParseToml(std::string_view text, const std::string& file);

// ReadTomlText, then ParseToml.
[[nodiscard]] toml::table ParseTomlFile(const std::filesystem::path& path, std::string_view what);

// One table of a file; must not outlive it. Every reader throws Error{kFormat} that begins with file:line.
class TomlEntry {
 public:
  // `title`: what it is called in messages, "[[part]]"; empty for the file itself.
  // Throws: Error{kFormat} for a key that isn't `known`, with the nearest one that is.
  TomlEntry(const toml::table& table, std::string file, std::string title,
            std::span<const std::string_view> known);
  TomlEntry(const toml::table& table, std::string file, std::string title,
            std::initializer_list<std::string_view> known)
      : TomlEntry(table, std::move(file), std::move(title), std::span(known.begin(), known.size())) {}

  [[noreturn]] void FailAt(const toml::source_region& at, const std::string& what,
                           core::ErrorKind kind = core::ErrorKind::kFormat) const;
  [[noreturn]] void Fail(std::string_view key, const std::string& what,
                         core::ErrorKind kind = core::ErrorKind::kFormat) const;

  [[nodiscard]] const toml::node* Find(std::string_view key) const { return table_.get(key); }
  [[nodiscard]] const toml::source_region& source() const { return table_.source(); }

  // The key must be there.
  [[nodiscard]] std::string Text(std::string_view key) const;
  [[nodiscard]] double Number(std::string_view key) const;

  // The key may be absent.
  [[nodiscard]] std::string TextOr(std::string_view key, const std::string& otherwise) const;
  [[nodiscard]] double NumberOr(std::string_view key, double otherwise) const;
  [[nodiscard]] Eigen::Vector3d VectorOrZero(std::string_view key) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> Vector(std::string_view key) const;
  [[nodiscard]] bool FlagOr(std::string_view key, bool otherwise) const;
  [[nodiscard]] std::vector<std::string> Texts(std::string_view key) const;
  [[nodiscard]] std::optional<core::LengthUnit> Unit() const;  // of the key `unit`

  // One entry for each table [[key]], in order; none if the key is absent.
  [[nodiscard]] std::vector<TomlEntry> Entries(std::string_view key,
                                               std::span<const std::string_view> known) const;

 private:
  [[nodiscard]] double NumberOf(const toml::node& node, std::string_view key) const;

  const toml::table& table_;
  std::string file_;
  std::string title_;
};

}  // namespace elbowroom::cad_import
