#include "cad_import/import_cache.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "cad_import/cad_file.h"
#include "cad_import/import_process.h"
#include "core/error.h"
#include "tests/cad_import/sample_files.h"
#include "tests/core/solids.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::cad_import {
namespace {

using test_support::ReadText;
using test_support::WriteText;

constexpr ImportOptions kMillimetres{.unit = core::LengthUnit::kMillimetre};

class Cache : public ::testing::Test {
 protected:
  Cache() { ::setenv("ELBOWROOM_CACHE", (folder_ / "cache").c_str(), 1); }
  ~Cache() override { ::setenv("ELBOWROOM_CACHE", "off", 1); }

  std::filesystem::path WriteBox(double edge_mm) {
    WriteText(folder_ / "box.stl", testing::StlBinary(core::testing::Box({edge_mm, edge_mm, edge_mm})));
    return folder_ / "box.stl";
  }
  std::vector<std::filesystem::path> Entries() const {
    std::vector<std::filesystem::path> entries;
    if (!std::filesystem::exists(folder_ / "cache")) return entries;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache"))
      entries.push_back(entry.path());
    return entries;
  }
  static double VolumeMm3(const std::filesystem::path& file, const ImportOptions& options = kMillimetres) {
    return core::VolumeMm3(*Flatten(ImportCadFile(file, options)).mesh);
  }

  test_support::TemporaryFolder folder_;
};

// No child can be started for it, so what comes is kept.
TEST_F(Cache, TheSecondImportStartsNoChild) {
  const auto file = WriteBox(10.0);
  EXPECT_NEAR(VolumeMm3(file), 1000.0, 1e-3);
  ASSERT_EQ(Entries().size(), 1U);
  const ImportOptions no_time{.unit = core::LengthUnit::kMillimetre,
                              .limits = {.memory_bytes = 1, .time_s = 1e-9}};
  EXPECT_NEAR(VolumeMm3(file, no_time), 1000.0, 1e-3);
  EXPECT_THROW((void)ImportInChild(file, no_time), core::Error);
}

TEST_F(Cache, AnotherContentUnitOrToleranceIsAnotherEntry) {
  const auto file = WriteBox(10.0);
  EXPECT_NEAR(VolumeMm3(file), 1000.0, 1e-3);
  EXPECT_NEAR(VolumeMm3(file, {.unit = core::LengthUnit::kCentimetre}), 1e6, 1.0);
  EXPECT_EQ(Entries().size(), 2U);
  EXPECT_NEAR(VolumeMm3(WriteBox(20.0)), 8000.0, 1e-2);
  EXPECT_EQ(Entries().size(), 3U);
}

TEST_F(Cache, ADamagedEntryIsMadeAgain) {
  const auto file = WriteBox(10.0);
  (void)VolumeMm3(file);
  const auto entry = Entries().at(0);
  const std::string sound = ReadText(entry);
  std::string damaged = sound;
  damaged[damaged.size() / 2] ^= 1;
  for (const std::string& bytes : {damaged, sound.substr(0, 100), std::string(), std::string("nonsense")}) {
    WriteText(entry, bytes);
    EXPECT_NEAR(VolumeMm3(file), 1000.0, 1e-3);
    EXPECT_EQ(ReadText(entry), sound);
  }
}

TEST_F(Cache, AChangedFileThatItRefersToIsAMiss) {
  const auto small = testing::Gltf(core::testing::Box({1, 1, 1}), {R"({"mesh":0})"}, {0}, "a.bin");
  const auto large = testing::Gltf(core::testing::Box({2, 2, 2}), {R"({"mesh":0})"}, {0}, "a.bin");
  WriteText(folder_ / "a.gltf", small.json);
  WriteText(folder_ / "a.bin", small.buffer);
  EXPECT_NEAR(VolumeMm3(folder_ / "a.gltf", {}), 1e9, 1e3);
  WriteText(folder_ / "a.bin", large.buffer);
  EXPECT_NEAR(VolumeMm3(folder_ / "a.gltf", {}), 8e9, 1e4);
}

TEST_F(Cache, NothingFailsWhereItCantBeWritten) {
  WriteText(folder_ / "cache", "a file where the folder should be");
  EXPECT_NEAR(VolumeMm3(WriteBox(10.0)), 1000.0, 1e-3);
}

TEST_F(Cache, OffKeepsNothing) {
  ::setenv("ELBOWROOM_CACHE", "off", 1);
  EXPECT_NEAR(VolumeMm3(WriteBox(10.0)), 1000.0, 1e-3);
  EXPECT_TRUE(Entries().empty());
}

TEST_F(Cache, TheLeastRecentlyUsedGoFirst) {
  const ImportCache cache(folder_ / "cache", 100'000);
  const std::vector<std::byte> packed(20'000);
  const auto age = [&](const std::string& key, int hours) {
    std::filesystem::last_write_time(
        folder_ / "cache" / (key + ".cad"),
        std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  for (int i = 0; i < 5; ++i) {
    cache.Keep(std::to_string(i), packed);
    age(std::to_string(i), i == 1 ? 50 : 10 - i);
  }
  EXPECT_EQ(Entries().size(), 5U);
  cache.Keep("new", packed);
  EXPECT_EQ(Entries().size(), 5U);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cache/1.cad"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cache/new.cad"));
}

}  // namespace
}  // namespace elbowroom::cad_import
