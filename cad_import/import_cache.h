// Models of files that were imported before.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "cad_import/model/import_options.h"
#include "cad_import/packed_model.h"

namespace elbowroom::cad_import {

// A folder of packed models, each under a key of what it was made from. The cache never makes an import fail:
// an entry that can't be read, is damaged or is of other files is a miss, and what can't be written isn't
// kept. Several programs may use one folder at once. Thread: any.
class ImportCache {
 public:
  // `most_bytes`: if there is more, the least recently used entries are removed. An entry above a quarter of
  // it isn't kept.
  explicit ImportCache(std::filesystem::path folder, std::int64_t most_bytes = std::int64_t{2} << 30);

  // The user's cache: $ELBOWROOM_CACHE, or elbowroom/import in $XDG_CACHE_HOME or ~/.cache. Nothing if it is
  // "off", or if there is no home.
  [[nodiscard]] static std::optional<ImportCache> OfUser();

  // A hash of the file's name and content and of all that changes what is made of it. Throws: Error{kFile} if
  // the file can't be read.
  [[nodiscard]] static std::string KeyOf(const std::filesystem::path& file, const ImportOptions& options);

  // The model, if the files that it referred to are unchanged. `file`: they are found relative to its folder.
  [[nodiscard]] std::optional<CadModel> Find(const std::string& key, const std::filesystem::path& file) const;
  void Keep(const std::string& key, std::span<const std::byte> packed) const;

 private:
  [[nodiscard]] std::filesystem::path PathOf(const std::string& key) const;
  void DropOldest() const;

  std::filesystem::path folder_;
  std::int64_t most_bytes_;
};

}  // namespace elbowroom::cad_import
