#include "cad_import/cad_file.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "cad_import/formats/file_format.h"
#include "cad_import/import_cache.h"
#include "cad_import/import_process.h"
#include "cad_import/mapped_file.h"
#include "cad_import/packed_model.h"
#include "core/error.h"

namespace elbowroom::cad_import {

void ImportOptions::Validate() const {
  const auto check = [](bool holds, const char* name, double value) {
    if (!holds)
      throw core::Error(core::ErrorKind::kRange, fmt::format("{} is {}; it must be positive", name, value));
  };
  const double tolerance = tolerance_mm.value_or(kUsualToleranceMm);
  check(tolerance > 0.0 && std::isfinite(tolerance), "the tolerance in mm", tolerance);
  check(limits.time_s > 0.0 && std::isfinite(limits.time_s), "the time limit in s", limits.time_s);
  check(limits.memory_bytes > 0, "the memory limit in bytes", static_cast<double>(limits.memory_bytes));
}

CadModel ImportCadFile(const std::filesystem::path& file, const ImportOptions& options,
                       const core::Progress& progress, const std::stop_token& stop) {
  options.Validate();
  (void)ReadableBytes(file);  // before all of it is read for its hash
  const std::optional<ImportCache> cache = ImportCache::OfUser();
  std::string key;
  if (cache) {
    key = ImportCache::KeyOf(file, options);
    if (std::optional<CadModel> found = cache->Find(key, file)) return *std::move(found);
  }
  const MappedFile packed = ImportInChild(file, options, progress, stop);
  PackedModel result = Unpack(packed.bytes(), file.string());
  if (!key.empty()) cache->Keep(key, packed.bytes());
  return std::move(result.model);
}

}  // namespace elbowroom::cad_import
