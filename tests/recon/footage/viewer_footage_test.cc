#include "recon/footage/viewer_footage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::NumberIn;
using testing::TestFolder;

std::shared_ptr<RecordedRig> RigOf(const TestFolder& folder, int frames) {
  testing::WriteVideo(folder.File("a.avi"), frames);
  return std::make_shared<RecordedRig>(testing::PlainRig({{folder.File("a.avi"), "", ""}}));
}

TEST(ViewerFootage, GivesThePictureOfTheSameNumberInAnyOrderAsLongAsThereIsOne) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("head.avi"), 8, 100);
  ViewerFootage footage(RigOf(folder, 12), testing::PlainCamera("head"), folder.File("head.avi"));
  EXPECT_EQ(footage.frame_count(), 12);
  EXPECT_EQ(footage.viewer_frame_count(), 8);
  EXPECT_EQ(footage.rig().cameras.size(), 1U);
  for (const int i : {0, 1, 2, 7, 11, 8, 3, 4}) {
    const FrameSet set = footage.Read(i);
    EXPECT_EQ(NumberIn(set.cameras[0].image_bgr), i);
    ASSERT_EQ(set.viewer.has_value(), i < 8) << i;
    if (!set.viewer) continue;
    EXPECT_EQ(NumberIn(set.viewer->image_bgr), 100 + i);
    EXPECT_EQ(set.viewer->camera->name(), "head");
  }
}

TEST(ViewerFootage, WrongFootageIsNamed) {
  const TestFolder folder;
  const auto rig = RigOf(folder, 3);
  const auto error_of = [&](core::ErrorKind kind, const char* file) {
    return testing::ErrorOf(
        kind, [&] { const ViewerFootage footage(rig, testing::PlainCamera("head"), folder.File(file)); });
  };
  EXPECT_THAT(error_of(core::ErrorKind::kFile, "none.avi"), AllOf(HasSubstr("head"), HasSubstr("none.avi")));
  testing::WriteVideo(folder.File("slow.avi"), 3, 0, 15.0);
  EXPECT_THAT(error_of(core::ErrorKind::kFormat, "slow.avi"),
              AllOf(HasSubstr("'cam1' runs at 30"), HasSubstr("'head' at 15")));
}

}  // namespace
}  // namespace elbowroom::recon
