// docs/cad_models.md, all its tables.
#pragma once

#include <filesystem>
#include <string>

namespace elbowroom::cad_models {

// Imports every file of the collections, asks a second reader of each, and writes the document's sections;
// or, with a part of names in `only`, prints the rows of those. Collections that aren't on this machine are
// named on stderr and in the document. Throws: core::Error{kFile} without a second reader.
void WriteModelTables(const std::filesystem::path& docs, const std::string& only);

}  // namespace elbowroom::cad_models
