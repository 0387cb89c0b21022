// A TRIAL.toml for a layout, and layouts told from trials.
#include "app/control/layout_editing/trial_draft.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using test_support::ReadText;
using test_support::WriteText;

class TrialDraftTest : public ::testing::Test {
 protected:
  TrialDraftTest() {
    WriteText(folder_ / "bench/layout.toml", "[[part]]\nname = \"a\"\nfile = \"a.stl\"\n");
    WriteText(folder_ / "rigs/rig.yml", "%YAML:1.0\n");
    draft_.layout = folder_ / "bench/layout.toml";
    draft_.rig = folder_ / "rigs/rig.yml";
  }
  std::string MessageOf(const std::filesystem::path& file) {
    try {
      WriteTrial(draft_, file);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }

  test_support::TemporaryFolder folder_;
  TrialDraft draft_;
};

TEST_F(TrialDraftTest, NamesRigAndLayoutAsSeenFromItsFolder) {
  WriteTrial(draft_, folder_ / "bench/trial.toml");
  EXPECT_EQ(ReadText(folder_ / "bench/trial.toml"), "rig = \"../rigs/rig.yml\"\nlayout = \"layout.toml\"\n");
  draft_.participant = "P07";
  draft_.task = "pipe \"and\" cable";
  draft_.estimate_mm = 184.0;
  draft_.required_clearance_mm = 10.0;
  draft_.tools = {"tongs", "pipe"};
  EXPECT_EQ(TrialText(draft_, folder_ / "trial.toml"),
            "rig = \"rigs/rig.yml\"\nlayout = \"bench/layout.toml\"\nparticipant = \"P07\"\n"
            "task = \"pipe \\\"and\\\" cable\"\nestimate_mm = 184.0\nrequired_clearance_mm = 10.0\n"
            "tools = [\"tongs\", \"pipe\"]\n");
}

TEST_F(TrialDraftTest, SaysWhatIsMissingAndWritesNothing) {
  const std::filesystem::path file = folder_ / "bench/trial.toml";
  draft_.rig.clear();
  EXPECT_NE(MessageOf(file).find("needs a rig"), std::string::npos);
  draft_.rig = folder_ / "rigs/none.yml";
  EXPECT_NE(MessageOf(file).find("none.yml"), std::string::npos);
  draft_.rig = folder_ / "rigs/rig.yml";
  draft_.required_clearance_mm = -1.0;
  EXPECT_NE(MessageOf(file).find("negative"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(TrialDraftTest, DoesNotWriteOverWhatIsNoTrial) {
  const std::string before = ReadText(draft_.layout);
  EXPECT_NE(MessageOf(draft_.layout).find("is no trial"), std::string::npos);
  EXPECT_EQ(ReadText(draft_.layout), before);
}

TEST_F(TrialDraftTest, KindsAreToldByTheirKeys) {
  WriteTrial(draft_, folder_ / "trial.toml");
  EXPECT_EQ(KindOf(folder_ / "trial.toml"), TomlKind::kTrial);
  EXPECT_EQ(KindOf(draft_.layout), TomlKind::kLayout);
  WriteText(folder_ / "new.toml", "# nothing yet\n");
  EXPECT_EQ(KindOf(folder_ / "new.toml"), TomlKind::kLayout);
  WriteText(folder_ / "calib.toml", "board = \"chessboard\"\n");
  EXPECT_THROW((void)KindOf(folder_ / "calib.toml"), core::Error);
  WriteText(folder_ / "bad.toml", "[[part");
  EXPECT_THROW((void)KindOf(folder_ / "bad.toml"), core::Error);
  EXPECT_THROW((void)KindOf(folder_ / "none.toml"), core::Error);
}

}  // namespace
}  // namespace elbowroom::control
