// Damaged configurations through their readers, without a process each: so many that they run under
// sanitizers.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "cad_import/layout/toml_entry.h"
#include "core/error.h"
#include "recon/rig_files/pose_file.h"
#include "recon/rig_files/rig_file.h"
#include "tests/adversary/damaged_configuration.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::adversary {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kReadingsAScale = 2'000;
constexpr double kLongestS = 20.0;

void ReadOne(ConfigurationKind kind, const fs::path& file) {
  switch (kind) {
    case ConfigurationKind::kRig:
      return (void)recon::ReadRigFile(file);
    case ConfigurationKind::kView:
      return (void)recon::ReadViewFile(file);
    case ConfigurationKind::kPose:
      return (void)recon::ReadPoseFile(file);
    case ConfigurationKind::kLayout:
    case ConfigurationKind::kTrial:
      return (void)cad_import::ParseTomlFile(file, "trial file");
  }
}

TEST(ConfigAdversary, ReadersThrowNothingButErrors) {
  const test_support::TemporaryFolder folder;
  WriteSoundTrial(folder.path());
  const auto texts = SoundTexts(folder.path());
  const int readings = kReadingsAScale * test_support::SoakScale();
  int refused = 0;
  for (int i = 0; i < readings; ++i) {
    std::mt19937_64 random(72'001 + static_cast<std::uint64_t>(i));
    const ConfigurationKind kind = kKinds[random() % kKinds.size()], other = kKinds[random() % kKinds.size()];
    const fs::path file = folder / "damaged";
    test_support::WriteText(file, Damaged(texts.at(kind), texts.at(other), random));
    const auto begin = Clock::now();
    try {
      ReadOne(kind, file);
    } catch (const core::Error& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("damaged"), std::string::npos) << i << ": " << error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << i << " " << NameOf(kind) << ": " << error.what();
    }
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - begin).count(), kLongestS) << i;
  }
  EXPECT_GT(refused, readings / 4);
  EXPECT_LT(refused, readings);
}

}  // namespace
}  // namespace elbowroom::adversary
