// Damaged CAD files, thousands of them: each is imported or refused with one line, and the program that asked
// goes on, within its limits of time and memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "cad_import/cad_file.h"
#include "cad_import/formats/file_format.h"
#include "core/error.h"
#include "tests/cad_import/sample_files.h"
#include "tests/core/solids.h"
#include "tests/fuzz/mutation.h"
#include "tests/support/places.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// ./dev soak's scale of 20 makes 100,000, beside a quarter of that from what is made here.
constexpr int kFilesAScale = 5000, kFilesInASmokeTest = 300;
constexpr std::uintmax_t kLargestSeedBytes = 200'000;

constexpr cad_import::ImportLimits kLimits{.memory_bytes = std::int64_t{1} << 30, .time_s = 20.0};
// A child that is stopped still has to be waited for, on a machine that does something else.
constexpr double kTimeSlackS = 20.0;
// Models of a few hundred kilobytes, four at a time.
constexpr long kMostGrowthKb = 400'000;

struct Seed {
  std::string name;  // with the extension
  std::string bytes;
};

std::vector<Seed> MadeSeeds() {
  namespace samples = cad_import::testing;
  const core::TriangleMesh box = core::testing::Box({10, 20, 30});
  return {{"text.stl", samples::StlText(box)},
          {"binary.stl", samples::StlBinary(box)},
          {"box.obj", samples::ObjText(box)},
          {"text.ply", samples::PlyText(box)},
          {"binary.ply", samples::PlyBinary(box)},
          {"box.glb", samples::Glb(samples::Gltf(box, {R"({"mesh":0})"}, {0}, ""))}};
}

std::vector<Seed> SharedSeeds(const fs::path& folder) {
  std::vector<Seed> seeds;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !cad_import::FindFormat(entry.path()) ||
        entry.file_size() > kLargestSeedBytes)
      continue;
    seeds.push_back({entry.path().filename().string(), test_support::ReadText(entry.path())});
  }
  std::ranges::sort(seeds, {}, &Seed::name);
  return seeds;
}

long MaxRssKb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

struct Tally {
  std::atomic<int> imported{0};
  std::atomic<int> refused{0};
  std::atomic<int> crashed{0};
  std::atomic<int> stopped{0};  // at a limit
  std::atomic<double> longest_s{0.0};
};

void KeepLargest(std::atomic<double>& largest, double value) {
  double before = largest;
  while (value > before && !largest.compare_exchange_weak(before, value)) {
  }
}

// Everything that is asked of one file. gtest's assertions may be used on any thread.
void ImportOne(const fs::path& file, Tally& tally) {
  const auto begin = Clock::now();
  try {
    (void)cad_import::ImportCadFile(
        file, {.unit_if_file_has_none = core::LengthUnit::kMillimetre, .limits = kLimits});
    ++tally.imported;
  } catch (const core::Error& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(file.string())) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    if (message.find("its reader crashed") != std::string::npos) ++tally.crashed;
    if (message.find("reading it takes more than") != std::string::npos) ++tally.stopped;
    ++tally.refused;
  }
  const double time_s = std::chrono::duration<double>(Clock::now() - begin).count();
  EXPECT_LT(time_s, kLimits.time_s + kTimeSlackS) << file;
  KeepLargest(tally.longest_s, time_s);
}

void FuzzFrom(const std::vector<Seed>& seeds, int files, std::uint64_t seed) {
  const test_support::TemporaryFolder folder;
  Tally tally;
  const long before_kb = MaxRssKb();
  tbb::parallel_for(0, files, [&](int i) {
    std::mt19937_64 random(seed + static_cast<std::uint64_t>(i));
    const Seed& from = seeds[random() % seeds.size()];
    const std::string bytes = Mutated(from.bytes, seeds[random() % seeds.size()].bytes, random);
    const fs::path file = folder / (std::to_string(i) + '_' + from.name);
    test_support::WriteText(file, bytes);
    ImportOne(file, tally);
    if (::testing::Test::HasFailure()) {
      fs::copy_file(file, fs::temp_directory_path() / ("elbowroom_fuzz_" + file.filename().string()),
                    fs::copy_options::overwrite_existing);
    }
    fs::remove(file);
  });
  const long growth_kb = MaxRssKb() - before_kb;
  EXPECT_LT(growth_kb, kMostGrowthKb);
  EXPECT_EQ(tally.imported + tally.refused, files);
  EXPECT_GT(tally.imported, files / 100) << "mutations that leave nothing sound test little";
  EXPECT_GT(tally.refused, files / 20);
  std::cout << files << " damaged files: " << tally.imported << " imported, " << tally.refused
            << " refused, of them " << tally.crashed << " crashed their reader and " << tally.stopped
            << " were stopped at a limit; the longest took " << tally.longest_s << " s, this process grew by "
            << growth_kb << " kB\n";
}

int FileCount() {
  const int scale = test_support::SoakScale();
  return scale == 1 ? kFilesInASmokeTest : kFilesAScale * scale;
}

// Runs of other ELBOWROOM_FUZZ_RUN damage other files.
std::uint64_t SeedOfRun(std::uint64_t seed) {
  constexpr std::uint64_t kMostFilesARun = 1'000'000'000;
  const char* run = std::getenv("ELBOWROOM_FUZZ_RUN");
  return run == nullptr ? seed : seed + kMostFilesARun * std::stoull(run);
}

TEST(ImportFuzz, DamagedFilesThatWereMadeHereDoNoHarm) {
  FuzzFrom(MadeSeeds(), FileCount() / 4, SeedOfRun(52'001));
}

TEST(ImportFuzz, DamagedFilesOfOthersDoNoHarm) {
  const fs::path folder = test_support::SharedDataFolder() / "cad";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "NOT TESTED: " << folder << " is not on this machine";
  FuzzFrom(SharedSeeds(folder), FileCount(), SeedOfRun(52'002));
}

}  // namespace
}  // namespace elbowroom::fuzz
