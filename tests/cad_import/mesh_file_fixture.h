// One CAD file in a folder of its own, read in this process.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "cad_import/file_reader.h"
#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "tests/cad_import/error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::cad_import::testing {

// In this process: a crash here is a finding, and hundreds of files take a moment.
inline ImportedMesh ImportHere(const std::filesystem::path& file, const ImportOptions& options = {}) {
  CadModel model = ReadCadFile(file, options).model;
  FlatModel flat = Flatten(model);
  return {std::move(flat.mesh), std::move(flat.parts), std::move(model.report)};
}

inline constexpr double kSinglePrecision = 1e-6;  // relative: files and parser hold floats

class MeshFileTest : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& name, const std::string& bytes) {
    test_support::WriteText(folder_ / name, bytes);
    return folder_ / name;
  }
  ImportedMesh Import(const std::string& name, const std::string& bytes,
                      core::LengthUnit unit = core::LengthUnit::kMillimetre) {
    return ImportHere(Write(name, bytes), {.unit = unit});
  }
  std::string FormatError(const std::string& name, const std::string& bytes) {
    const auto path = Write(name, bytes);
    std::string message = ErrorOf(core::ErrorKind::kFormat,
                                  [&] { (void)ImportHere(path, {.unit = core::LengthUnit::kMillimetre}); });
    EXPECT_TRUE(Mentions(message, path.string())) << message;
    return message;
  }

  test_support::TemporaryFolder folder_;
};

}  // namespace elbowroom::cad_import::testing
