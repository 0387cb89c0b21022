// Damaged configurations, thousands of them, through the program as a user runs it and through its readers:
// each is taken, or refused with one line, within its limits of time and memory.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "core/plain_text.h"
#include "tests/adversary/damaged_configuration.h"
#include "tests/adversary/foreign_texts.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::adversary {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramRun;
using test_support::TemporaryFolder;

// ./dev soak's scale of 20 makes 4,000 through the program.
constexpr int kRunsAScale = 200, kRunsInASmokeTest = 100;
constexpr double kLongestS = 20.0;
// A sound trial takes some 100 MB.
constexpr long kLargestKb = 600'000;

// The largest child so far, grandchildren among them.
long LargestChildKb() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss;
}

ProgramRun Elbowroom(const std::vector<std::string>& words, const fs::path& folder) {
  return test_support::RunProgram(test_support::ProgramFile(), words,
                                  {.working_folder = folder, .timeout_s = kLongestS});
}

// What uses a file of that kind, and ends soon.
std::vector<std::string> UseOf(ConfigurationKind kind, std::mt19937_64& random) {
  std::vector<std::string> contacts = {
      "contacts", "rig.yml", "--frame",           "0",       "--mesh", "box.stl",
      "--unit",   "mm",      "--world-from-part", "pose.yml"};
  std::vector<std::string> trial = {"trial", "run", "trial.toml", "--session", "s.db", "--headless"};
  const std::vector<std::string> view = {"view",     "rig.yml",  "--frame", "0",
                                         "--camera", "view.yml", "--depth", "d.tiff"};
  const auto one_of = [&](const std::vector<std::vector<std::string>>& uses) {
    return uses[random() % uses.size()];
  };
  switch (kind) {
    case ConfigurationKind::kRig:
      return one_of({{"segment", "rig.yml", "--frame", "0", "--out", "masks"}, contacts, view, trial});
    case ConfigurationKind::kView:
      return one_of({view, trial});
    case ConfigurationKind::kPose:
      return contacts;
    case ConfigurationKind::kLayout:
      return one_of({{"layout", "show", "layout.toml", "--json"}, {"clash", "layout.toml"}, trial});
    case ConfigurationKind::kTrial:
      break;
  }
  return trial;
}

struct Tally {
  std::atomic<int> taken{0};
  std::atomic<int> refused{0};
};

// Exit status 0, or 1 with nothing on stdout and one line on stderr.
void ExpectInOrder(const ProgramRun& run, Tally& tally) {
  ASSERT_TRUE(run.exit_status == 0 || run.exit_status == 1) << run.exit_status << ": " << run.err;
  EXPECT_LE(run.err.size(), core::kLongestMessageBytes) << run.err;
  if (run.exit_status == 0) {
    ++tally.taken;
    return;
  }
  ++tally.refused;
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(run.err.starts_with("elbowroom: ") && run.err.ends_with('\n')) << run.err;
  EXPECT_TRUE(core::IsPlain(run.err.substr(0, run.err.size() - 1))) << run.err;
  EXPECT_EQ(run.err.find("internal error"), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("out of memory"), std::string::npos) << run.err;
}

void KeepForALook(const fs::path& file, int number) {
  fs::copy_file(
      file,
      fs::temp_directory_path() / fmt::format("elbowroom_config_{}_{}", number, file.filename().string()),
      fs::copy_options::overwrite_existing);
}

int RunsOfATest() {
  const int scale = test_support::SoakScale();
  return scale == 1 ? kRunsInASmokeTest : kRunsAScale * scale;
}

void ExpectBothEnds(const char* what, int runs, const Tally& tally) {
  EXPECT_LT(LargestChildKb(), kLargestKb);
  EXPECT_GT(tally.taken, runs / 20) << "damage that leaves nothing sound tests little";
  EXPECT_GT(tally.refused, runs / 4);
  std::cout << runs << " damaged " << what << ": " << tally.taken << " taken, " << tally.refused
            << " refused; the largest child took " << LargestChildKb() / 1000 << " MB\n";
}

TEST(ConfigAdversary, DamagedConfigurationsEndInOneLine) {
  const int runs = RunsOfATest();
  Tally tally;
  tbb::parallel_for(0, runs, [&](int i) {
    std::mt19937_64 random(71'001 + static_cast<std::uint64_t>(i));
    const TemporaryFolder folder;
    WriteSoundTrial(folder.path());
    const auto texts = SoundTexts(folder.path());
    const ConfigurationKind kind = kKinds[random() % kKinds.size()], other = kKinds[random() % kKinds.size()];
    const fs::path file = folder / NameOf(kind);
    test_support::WriteText(file, Damaged(texts.at(kind), texts.at(other), random));
    const std::vector<std::string> use = UseOf(kind, random);
    SCOPED_TRACE(fmt::format("{}: {} {}", i, use[0], file.filename().string()));
    try {
      ExpectInOrder(Elbowroom(use, folder.path()), tally);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
    if (::testing::Test::HasFailure()) KeepForALook(file, i);
  });
  ExpectBothEnds("configurations", runs, tally);
}

TEST(ConfigAdversary, DamagedRigsOfOtherProgramsEndInOneLine) {
  const int runs = RunsOfATest();
  Tally tally;
  tbb::parallel_for(0, runs, [&](int i) {
    std::mt19937_64 random(72'001 + static_cast<std::uint64_t>(i));
    const TemporaryFolder folder;
    const ForeignText& foreign = kForeignTexts[static_cast<std::size_t>(i) % kForeignTexts.size()];
    const ForeignText& other = kForeignTexts[random() % kForeignTexts.size()];
    const bool is_sound = i < static_cast<int>(kForeignTexts.size());
    const fs::path file = folder / foreign.name;
    test_support::WriteText(file, is_sound
                                      ? std::string(foreign.text)
                                      : Damaged(std::string(foreign.text), std::string(other.text), random));
    SCOPED_TRACE(fmt::format("{}: {}", i, foreign.name));
    const ProgramRun run = Elbowroom(
        {"rig", "import", std::string(foreign.name), "--format", std::string(foreign.format), "--size", "640",
         "480", "--unit", "mm", "--workspace", "-100", "-100", "0", "100", "100", "200", "--out", "rig.yml"},
        folder.path());
    if (is_sound) {
      EXPECT_EQ(run.exit_status, 0) << run.err;
    }
    ExpectInOrder(run, tally);
    EXPECT_EQ(fs::exists(folder / "rig.yml"), run.exit_status == 0);
    if (::testing::Test::HasFailure()) KeepForALook(file, i);
  });
  ExpectBothEnds("rigs of other programs", runs, tally);
}

// The file of that kind, its `from` replaced; `from` must be there.
std::string With(const fs::path& folder, ConfigurationKind kind, const std::string& from,
                 const std::string& to) {
  std::string text = test_support::ReadText(folder / NameOf(kind));
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class KnownDamage : public testing::Test {
 protected:
  void SetUp() override { WriteSoundTrial(folder_.path()); }

  // A trial with that text, for a file of that kind, is refused in one line that says `word`.
  void ExpectRefused(ConfigurationKind kind, const std::string& text, const std::string& word) {
    const fs::path file = folder_ / NameOf(kind);
    const std::string sound = test_support::ReadText(file);
    test_support::WriteText(file, text);
    ExpectRefused(kind, word);
    test_support::WriteText(file, sound);
  }
  void ExpectRefused(ConfigurationKind kind, const std::string& word) {
    SCOPED_TRACE(NameOf(kind) + ": " + word);
    std::mt19937_64 random(0);
    const std::vector<std::string> use =
        kind == ConfigurationKind::kPose
            ? UseOf(kind, random)
            : std::vector<std::string>{"trial", "run",        "trial.toml", "--session",
                                       "s.db",  "--headless", "--json"};
    const ProgramRun run = Elbowroom(use, folder_.path());
    Tally tally;
    ExpectInOrder(run, tally);
    EXPECT_EQ(tally.refused, 1);
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder_ / "s.db"));
  }
  TemporaryFolder folder_;
};

TEST_F(KnownDamage, ASoundTrialIsTaken) {
  const ProgramRun run =
      Elbowroom({"trial", "run", "trial.toml", "--session", "s.db", "--headless", "--json"}, folder_.path());
  EXPECT_EQ(run.exit_status, 0) << run.err;
}

TEST_F(KnownDamage, WhatNestsDeep) {
  for (const ConfigurationKind kind : {ConfigurationKind::kTrial, ConfigurationKind::kLayout})
    for (const std::string& nested :
         {"a = " + Repeated("[", 40'000), "a = " + Repeated("{a=", 40'000), Repeated("a.", 40'000) + "a = 1"})
      ExpectRefused(kind, nested, "nested too deep");
  for (const ConfigurationKind kind :
       {ConfigurationKind::kRig, ConfigurationKind::kView, ConfigurationKind::kPose})
    for (const char* nested : {"[", "- ", "{ a: ", "a: "})
      ExpectRefused(kind, "%YAML:1.0\n---\na: " + Repeated(nested, 40'000), "nested more than 64 deep");
}

TEST_F(KnownDamage, WhatIsNoFileOrNoConfiguration) {
  for (const ConfigurationKind kind : kKinds) {
    const fs::path file = folder_ / NameOf(kind);
    const std::string sound = test_support::ReadText(file);
    const auto with = [&](const auto& make, const std::string& word) {
      fs::remove_all(file);
      make();
      ExpectRefused(kind, word);
      fs::remove_all(file);
      test_support::WriteText(file, sound);
    };
    with([&] { ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0); }, "isn't a file");
    with([&] { fs::create_symlink("/dev/zero", file); }, "isn't a file");
    with([&] { fs::create_directory(file); }, "isn't a file");
    with([&] { fs::create_symlink("nowhere", file); }, "no such");
    with(
        [&] {
          test_support::WriteText(file, sound);
          fs::resize_file(file, std::uintmax_t{10} << 30U);
        },
        "is larger than 4 MiB");
    const bool is_yaml = file.extension() == ".yml";
    const std::string word = is_yaml ? "%YAML:1.0" : "not TOML";
    ExpectRefused(kind, std::string("RIFF\x10\0\0\0AVI ", 12).append(3'000'000, '\0'), word);
    ExpectRefused(kind, std::string(3'000'000, '\0'), word);
    ExpectRefused(kind, "\x1f\x8b\x08" + std::string(1000, '\xAA'), word);
    ExpectRefused(kind, std::string("\xFF\xFE%\0Y\0", 6), word);
    if (!is_yaml) continue;
    ExpectRefused(kind, "<?xml version=\"1.0\"?><opencv_storage></opencv_storage>", word);
    ExpectRefused(kind, "{ \"cameras\": [] }", word);
    ExpectRefused(kind, "", word);
  }
}

TEST_F(KnownDamage, NumbersBeyondSense) {
  using enum ConfigurationKind;
  const auto with = [&](ConfigurationKind kind, const std::string& from, const std::string& to) {
    return With(folder_.path(), kind, from, to);
  };
  ExpectRefused(kRig, with(kRig, "image_width: 320", "image_width: 100000"), "more than a picture");
  ExpectRefused(kRig, with(kRig, "image_width: 320", "image_width: 1000000000"), "more than a picture");
  ExpectRefused(kRig, with(kRig, "image_width: 320", "image_width: -320"), "not positive");
  ExpectRefused(kRig, with(kRig, "350.0", "1e300"), "workspace_mm");
  ExpectRefused(kRig, with(kRig, "350.0", "nan"), "workspace_mm");
  ExpectRefused(kRig, with(kRig, "[ 500.0,", "[ 1e308,"), "camera_matrix");
  ExpectRefused(kRig, with(kRig, "[ 500.0,", "[ 1e-320,"), "camera_matrix");
  ExpectRefused(kRig, with(kRig, "cameras:", "cameras:\n" + Repeated("   - { name: \"c\" }\n", 10'000)),
                "255");
  ExpectRefused(kRig, with(kRig, "rows: 3", "rows: 1000000000"), "wrong size");
  ExpectRefused(kRig, with(kRig, "      image_width", "      image"), "image_width");
  ExpectRefused(kView, with(kView, "image_height: 240", "image_height: 2000000"), "more than a picture");
  ExpectRefused(kPose, with(kPose, "[ 80.,", "[ 1e300,"), "check its unit");
  ExpectRefused(kLayout, with(kLayout, "[80, 0, 60]", "[1e300, 0, 60]"),
                "layout.toml:5: [[part]]: key 'position_mm'");
  ExpectRefused(kLayout, with(kLayout, "max_mm = 200.0", "max_mm = 1e300"), "max_mm");
  ExpectRefused(kLayout, with(kLayout, "30.5", "1e300"), "rotation_rpy_deg");
  ExpectRefused(kTrial, with(kTrial, "140", "-1e308"), "estimate_mm");
  ExpectRefused(kTrial, with(kTrial, "20", "1e18"), "min_blob_px");
}

TEST_F(KnownDamage, MoreEntriesThanCanBeHeldAgainstEachOther) {
  std::string parts = "unit = \"mm\"\n", names, spacings;
  for (int i = 0; i < 3'900; ++i) {
    parts += fmt::format("[[part]]\nname = \"p{}\"\nfile = \"box.stl\"\n", i);
    names += fmt::format("\"p{}\",", i);
    spacings += fmt::format(
        "[[spacing]]\nname = \"s{0}\"\nmoving = \"p{0}\"\nreference = \"p0\"\naxis = \"z\"\nmin_mm = "
        "0\nmax_mm = "
        "1\ninitial_mm = 0\n",
        i);
  }
  using enum ConfigurationKind;
  ExpectRefused(kLayout, parts + spacings, "3900 entries");
  ExpectRefused(kLayout,
                parts + "[[group]]\nname = \"g\"\nparts = [" + names + "]\n[[pair]]\na = \"g\"\nb = \"g\"\n",
                "more than 500000 pairs");
}

TEST_F(KnownDamage, NamesThatBreakLines) {
  using enum ConfigurationKind;
  const std::string name = fmt::format("{}\\u001b[2J\\n\\u2028", std::string(2000, 'n'));
  ExpectRefused(kTrial, With(folder_.path(), kTrial, "\"rig.yml\"", "\"" + name + "\""),
                R"(\x1b[2J\x0a\xe2\x80\xa8)");
  ExpectRefused(kRig, With(folder_.path(), kRig, "\"cam1\"", "\"\x1b[2J\""), "characters that are no text");
  ExpectRefused(kLayout, With(folder_.path(), kLayout, "\"box.stl\"", "\"\\u0000.stl\""), "null character");
}

}  // namespace
}  // namespace elbowroom::adversary
