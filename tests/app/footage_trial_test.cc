// Trials on videos that are shorter than they promise, or damaged: what could be judged is kept, and said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <variant>

#include "recon/rig_files/rig_file.h"
#include "sessions/session_reader.h"
#include "tests/app/mask_rig.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using recon::testing::DamageFrame;
using recon::testing::PromiseFrames;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kFrames = 60;

// Two cameras with videos of 60 frames, one box.
class FootageTrial : public testing::Test {
 protected:
  FootageTrial() {
    cv::imwrite((folder_ / "background.png").string(), recon::testing::NumberedPicture(0));
    for (const char* name : {"a.avi", "b.avi"})
      recon::testing::WriteVideo((folder_ / name).string(), kFrames);
    const auto sources = [&](const char* name) {
      return recon::CameraSources{(folder_ / name).string(), (folder_ / "background.png").string(), ""};
    };
    recon::WriteRigFile(recon::testing::PlainRig({sources("a.avi"), sources("b.avi")}), folder_ / "rig.yml");
    test_support::WriteBoxStl(folder_ / "box.stl", 10.0);
    test_support::WriteText(folder_ / "layout.toml",
                            "unit = \"mm\"\n[[part]]\nname = \"box\"\nfile = \"box.stl\"\n");
    test_support::WriteText(folder_ / "trial.toml", "rig = \"rig.yml\"\nlayout = \"layout.toml\"\n");
  }

  [[nodiscard]] test_support::ProgramRun Run(const std::vector<std::string>& more = {}) const {
    std::filesystem::remove(session_);
    std::vector<std::string> arguments = {
        "trial",      "run",   (folder_ / "trial.toml").string(), "--session", session_.string(),
        "--headless", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }

  [[nodiscard]] std::string LastNote() const {
    std::string note;
    for (const core::SessionEvent& event : sessions::SessionReader(session_).events())
      if (const auto* last = std::get_if<core::Note>(&event.what)) note = last->text;
    return note;
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path session_ = folder_ / "s.db";
};

TEST_F(FootageTrial, IsAsLongAsThePicturesNotAsThePromise) {
  for (const std::uint32_t promised : {0U, 60U, 90U}) {
    SCOPED_TRACE(promised);
    PromiseFrames(folder_ / "a.avi", promised);
    PromiseFrames(folder_ / "b.avi", 100);
    const test_support::ProgramRun run = Run();
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["frames"], kFrames);
    EXPECT_EQ(json["ended"], "ended with the shortest source, camera 'cam1' (60 frames)");
    EXPECT_EQ(sessions::SessionReader(session_).frame_count(), kFrames);
  }
}

TEST_F(FootageTrial, ARangeThatWasPromisedInVainIsAnErrorThatKeepsItsFrames) {
  PromiseFrames(folder_ / "a.avi", 90);
  PromiseFrames(folder_ / "b.avi", 90);
  const test_support::ProgramRun cut = Run({"--frames", "50:80"});
  EXPECT_EQ(cut.exit_status, 1);
  EXPECT_THAT(cut.err, AllOf(HasSubstr("frames 50:80: the footage has 60 frames (0:60)"),
                             HasSubstr("10 of 10 frames are kept in")));
  EXPECT_THAT(LastNote(), HasSubstr("ended by a failure: frames 50:80"));
  const test_support::ProgramRun none = Run({"--frames", "70:80"});
  EXPECT_EQ(none.exit_status, 1);
  EXPECT_THAT(none.err, HasSubstr("frames 70:80: the footage has 60 frames (0:60)"));
  EXPECT_FALSE(std::filesystem::exists(session_));
  const test_support::ProgramRun beyond = Run({"--frames", "0:91"});
  EXPECT_EQ(beyond.exit_status, 1);
  EXPECT_THAT(beyond.err, HasSubstr("frames 0:91: the footage has 90 frames (0:90); choose a range"));
  EXPECT_FALSE(std::filesystem::exists(session_));
}

TEST_F(FootageTrial, DamageEndsItWhereItIsMetAndTheSessionSaysSo) {
  DamageFrame(folder_ / "b.avi", 43);
  const test_support::ProgramRun run = Run();
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("camera 'cam2'"), HasSubstr("b.avi"),
                             HasSubstr("damaged at about frame 4"), HasSubstr("frames are kept in")));
  const sessions::SessionReader session(session_);
  EXPECT_GE(session.frame_count(), 38);
  EXPECT_LE(session.frame_count(), 43);
  EXPECT_THAT(LastNote(), AllOf(HasSubstr("ended by a failure"), HasSubstr("damaged at about frame 4")));
  EXPECT_EQ(Run({"--frames", "0:30"}).exit_status, 0);  // what comes before it is sound
}

}  // namespace
}  // namespace elbowroom
