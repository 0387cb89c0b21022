// A child process that reads a file, so that no file can take this program down.
#pragma once

#include <filesystem>
#include <stop_token>

#include "cad_import/mapped_file.h"
#include "cad_import/model/import_options.h"
#include "core/progress.h"

namespace elbowroom::cad_import {

// Reads the file in a child of this program. Returns a packed model that hasn't been checked yet. Throws:
// Error{kCad} naming the file when the child crashed, took more memory or time than the limits, or handed
// over what isn't a model; Error{kCancelled}; else what the child threw. PreconditionError unless the
// program's main called ServeImport. Thread: any.
[[nodiscard]] MappedFile ImportInChild(const std::filesystem::path& file, const ImportOptions& options,
                                       const core::Progress& progress = {}, const std::stop_token& stop = {});

}  // namespace elbowroom::cad_import
