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

// A folder of packed models by what they were made from. Nothing it does fails an import: what can't be read,
// is damaged or is of other files is a miss, what can't be written is not kept. Several programs may use one
// folder at once. Thread: any.
class ImportCache {
 public:
  // `most_bytes`: the least recently used go when there is more.
  explicit ImportCache(std::filesystem::path folder, std::int64_t most_bytes = std::int64_t{2} << 30);

  // That of the user: $ELBOWROOM_CACHE, or elbowroom/import in $XDG_CACHE_HOME or ~/.cache. Nothing: it is
  // "off", or there is no home.
  [[nodiscard]] static std::optional<ImportCache> OfUser();

  // By the content of the file and all that changes what is made of it. Throws: Error{kFile} if the file
  // can't be read.
  [[nodiscard]] static std::string KeyOf(const std::filesystem::path& file, const ImportOptions& options);

  // The model, if the files that it referred to are still what they were. `file`: whose folder they are found
  // from.
  [[nodiscard]] std::optional<CadModel> Find(const std::string& key, const std::filesystem::path& file) const;
  void Keep(const std::string& key, std::span<const std::byte> packed) const;

 private:
  [[nodiscard]] std::filesystem::path PathOf(const std::string& key) const;
  void DropOldest() const;

  std::filesystem::path folder_;
  std::int64_t most_bytes_;
};

}  // namespace elbowroom::cad_import
