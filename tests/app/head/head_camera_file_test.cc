// The head camera in HEAD.toml: written among what else is there, and read again.
#include <gtest/gtest.h>

#include "app/control/head/head_settings.h"
#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using test_support::ReadText;
using test_support::WriteText;

recon::HeadCamera SomeCamera() {
  recon::HeadCamera camera;
  camera.head_from_camera = core::FromPositionAndRollPitchYaw({12.5, -61.25, 40.0}, {3.0, -7.5, 1.25});
  camera.focal_px = 712.5;
  camera.width_px = 800;
  camera.height_px = 600;
  return camera;
}

void ExpectHas(const std::filesystem::path& file, const recon::HeadCamera& camera) {
  const auto read = ReadHeadFile(file).head_camera;
  ASSERT_TRUE(read.has_value());
  EXPECT_LT((read->head_from_camera.translation_mm - camera.head_from_camera.translation_mm).norm(), 2e-3);
  EXPECT_LT((read->head_from_camera.rotation - camera.head_from_camera.rotation).norm(), 1e-6);
  EXPECT_NEAR(read->focal_px, camera.focal_px, 1e-3);
  EXPECT_EQ(read->width_px, camera.width_px);
  EXPECT_EQ(read->height_px, camera.height_px);
}

TEST(HeadCameraFile, IsMadeWhereThereIsNone) {
  const test_support::TemporaryFolder folder;
  WriteHeadCamera(folder / "HEAD.toml", SomeCamera());
  ExpectHas(folder / "HEAD.toml", SomeCamera());
}

TEST(HeadCameraFile, KeepsCommentsAndAllElse) {
  const test_support::TemporaryFolder folder;
  const auto file = folder / "HEAD.toml";
  WriteText(file,
            "# Käthe's headset\nsource = \"freed\"   # the studio's\nport = 40001\n\n[tracker] # taped to "
            "the table\n"
            "position_mm = [1, 2, 3]");
  WriteHeadCamera(file, SomeCamera());
  const std::string text = ReadText(file);
  EXPECT_EQ(
      text.rfind("# Käthe's headset\nsource = \"freed\"   # the studio's\nport = 40001\n\n[tracker] # taped "
                 "to the table\nposition_mm = [1, 2, 3]\n",
                 0),
      0U)
      << text;
  ExpectHas(file, SomeCamera());
  EXPECT_EQ(ReadHeadFile(file).port, 40001);
}

TEST(HeadCameraFile, ReplacesValuesWhereTheyStand) {
  const test_support::TemporaryFolder folder;
  const auto file = folder / "HEAD.toml";
  WriteText(
      file,
      "[head_camera] # a lipstick camera\nfocal_px = 600 # by hand\nposition_mm = [0,\n  0, # flat\n 0]\n\n"
      "[fixed]\neyes_mm = [0, -700, 500] # seated\n");
  WriteHeadCamera(file, SomeCamera());
  const std::string text = ReadText(file);
  for (const char* kept :
       {"[head_camera] # a lipstick camera\n", "focal_px = 712.500 # by hand\n", "# seated\n"})
    EXPECT_NE(text.find(kept), std::string::npos) << text;
  ExpectHas(file, SomeCamera());
  const std::string once = text;
  WriteHeadCamera(file, SomeCamera());
  EXPECT_EQ(ReadText(file), once);
}

TEST(HeadCameraFile, ChangesNothingWhereItCannot) {
  const test_support::TemporaryFolder folder;
  const auto file = folder / "HEAD.toml";
  for (const char* text : {"head_camera = 3\n", "source = \n"}) {
    WriteText(file, text);
    EXPECT_THROW(WriteHeadCamera(file, SomeCamera()), core::Error);
    EXPECT_EQ(ReadText(file), text);
  }
}

TEST(HeadCameraFile, NamesWhatIsWrong) {
  const test_support::TemporaryFolder folder;
  const auto file = folder / "HEAD.toml";
  for (const auto& [text, line] : {std::pair{"[head_camera]\nfocal_px = -3\n", ":2:"},
                                   {"[head_camera]\nfocal_px = 600\nsize_px = [640]\n", ":3:"},
                                   {"[head_camera]\nfocal = 600\n", ":2:"}}) {
    WriteText(file, text);
    try {
      (void)ReadHeadFile(file);
      ADD_FAILURE() << text;
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(line), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace elbowroom::control
