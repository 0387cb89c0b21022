// The program where somebody put it: with its modules beside it, and without.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramRun;
using test_support::RunProgram;

class CopiedProgram : public testing::Test {
 protected:
  void SetUp() override { fs::copy_file(test_support::ProgramFile(), program_); }

  // The files whose names begin so. Returns how many there are.
  int CopyThose(const std::string& beginning) const {
    int modules = 0;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(test_support::ProgramFile().parent_path())) {
      if (!entry.path().filename().string().starts_with(beginning)) continue;
      fs::copy_file(entry.path(), folder_ / entry.path().filename());
      ++modules;
    }
    return modules;
  }
  // Reads masks and writes pictures.
  [[nodiscard]] ProgramRun Segment() const {
    const std::string rig = test_support::WriteBallRig(folder_ / "rig").string();
    return RunProgram(program_, {"segment", rig, "--frame", "0", "--out", (folder_ / "masks").string()});
  }
  [[nodiscard]] ProgramRun ImportStep() const {
    test_support::WriteText(folder_ / "part.step",
                            "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n");
    return RunProgram(program_, {"import", (folder_ / "part.step").string()},
                      {.environment = {{"ELBOWROOM_CACHE", "off"}}});
  }

  test_support::TemporaryFolder folder_;
  fs::path program_ = folder_ / "elbowroom";
};

TEST_F(CopiedProgram, WorksWithItsModulesBesideIt) {
  EXPECT_EQ(CopyThose("libelbowroom_"), 4);
  EXPECT_EQ(CopyThose("elbowroom_decoder-"), 1);
  EXPECT_EQ(Segment().err, "");
  EXPECT_FALSE(fs::is_empty(folder_ / "masks"));
  const ProgramRun import = ImportStep();
  EXPECT_NE(import.err.find("part.step"), std::string::npos) << import.err;
  EXPECT_EQ(import.err.find("beside the program"), std::string::npos) << import.err;
}

TEST_F(CopiedProgram, NeedsNoModuleToStart) {
  const ProgramRun run = RunProgram(program_, {"--version"});
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_EQ(run.err, "");
}

TEST_F(CopiedProgram, NamesAModuleThatIsMissing) {
  const ProgramRun without_decoder = Segment();
  EXPECT_EQ(CopyThose("elbowroom_decoder-"), 1);
  for (const auto& [run, module] : {std::pair(without_decoder, "elbowroom_decoder-"),
                                    std::pair(Segment(), "libelbowroom_picture_codecs-"),
                                    std::pair(ImportStep(), "libelbowroom_brep_reader-")}) {
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_NE(run.err.find(module), std::string::npos) << run.err;
    EXPECT_TRUE(run.err.ends_with("it belongs beside the program: build or install them together\n"))
        << run.err;
  }
}

}  // namespace
}  // namespace elbowroom
