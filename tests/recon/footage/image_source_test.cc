#include "recon/footage/image_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "recon/footage/container_check.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/text_file.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::AllOf;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::NumberedPicture;
using testing::NumberIn;
using testing::PlainCamera;
using testing::TestFolder;

std::string OpenError(const std::string& location, ErrorKind kind = ErrorKind::kFile) {
  std::string message = ErrorOf(kind, [&] { (void)OpenImageSource(location, PlainCamera("cam3")); });
  EXPECT_THAT(message, HasSubstr("camera 'cam3'"));
  return message;
}

void WriteSequence(const TestFolder& folder, int first, int count) {
  for (int i = 0; i < count; ++i) {
    cv::imwrite(folder.File("f_" + std::to_string(1000 + first + i).substr(1) + ".png"), NumberedPicture(i));
  }
}

TEST(ImageSequence, BeginsAtZeroOrOne) {
  for (const int first : {0, 1}) {
    const TestFolder folder;
    WriteSequence(folder, first, 12);
    const auto source = OpenImageSource(folder.File("f_%03d.png"), PlainCamera("cam3"));
    ASSERT_EQ(source->frame_count(), 12);
    EXPECT_FALSE(source->frame_rate_hz().has_value());
    for (const int i : {0, 11, 5}) EXPECT_EQ(NumberIn(source->Read(i).value().image_bgr), i);
    EXPECT_FALSE(source->Read(12).has_value());
    EXPECT_THAT(ErrorOf(ErrorKind::kRange, [&] { (void)source->Read(-1); }), HasSubstr("frame -1"));
  }
}

TEST(ImageSequence, CountsUnpaddedNumbersAsNumbers) {
  const TestFolder folder;
  for (int i = 0; i < 12; ++i) cv::imwrite(folder.File("f" + std::to_string(i) + ".png"), NumberedPicture(i));
  const auto source = OpenImageSource(folder.File("f%d.png"), PlainCamera("cam3"));
  ASSERT_EQ(source->frame_count(), 12);
  EXPECT_EQ(NumberIn(source->Read(10).value().image_bgr), 10);  // by name it would come after f1
}

TEST(ImageSequence, SaysWhereItHasAGapOrNoBeginning) {
  const TestFolder folder;
  EXPECT_THAT(OpenError(folder.File("f_%03d.png")), HasSubstr("no files"));
  WriteSequence(folder, 0, 9);
  std::filesystem::remove(folder.File("f_004.png"));
  EXPECT_THAT(OpenError(folder.File("f_%03d.png")), AllOf(HasSubstr("f_004.png"), HasSubstr("missing")));
  for (int i = 0; i < 4; ++i) std::filesystem::remove(folder.File("f_00" + std::to_string(i) + ".png"));
  EXPECT_THAT(OpenError(folder.File("f_%03d.png")), HasSubstr("begins at number 5"));
  EXPECT_THAT(OpenError(folder.File("f_%s.png"), ErrorKind::kFormat), HasSubstr("%0Nd"));
  EXPECT_THAT(OpenError(folder.File("f_%d_%d.png"), ErrorKind::kFormat), HasSubstr("%0Nd"));
}

TEST(ImageSequence, NamesABadImageWhenItIsRead) {
  const TestFolder folder;
  WriteSequence(folder, 0, 3);
  testing::WriteText(folder.path() / "f_001.png", "");
  cv::imwrite(folder.File("f_002.png"), NumberedPicture(2, 80, 64));
  const auto source = OpenImageSource(folder.File("f_%03d.png"), PlainCamera("cam3"));
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)source->Read(1); }),
              AllOf(HasSubstr("cam3"), HasSubstr("f_001.png"), HasSubstr("empty")));
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)source->Read(2); }),
              AllOf(HasSubstr("cam3"), HasSubstr("80 x 64"), HasSubstr("96 x 64")));
}

TEST(ImageSource, TakesOneImageAndAFolder) {
  const TestFolder folder;
  EXPECT_THAT(OpenError(folder.path().string()), HasSubstr("no images"));
  EXPECT_THAT(OpenError(folder.File("none.png")), AllOf(HasSubstr("none.png"), HasSubstr("exist")));
  WriteSequence(folder, 7, 3);
  const auto all = OpenImageSource(folder.path().string(), PlainCamera("cam3"));
  EXPECT_EQ(all->frame_count(), 3);
  EXPECT_EQ(NumberIn(all->Read(2).value().image_bgr), 2);
  const auto one = OpenImageSource(folder.File("f_008.png"), PlainCamera("cam3"));
  EXPECT_EQ(one->frame_count(), 1);
  EXPECT_EQ(NumberIn(one->Read(0).value().image_bgr), 1);
}

TEST(VideoFile, GivesTheRightFrameInAnyOrder) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("v.avi"), 40);
  const auto source = OpenImageSource(folder.File("v.avi"), PlainCamera("cam3"));
  ASSERT_EQ(source->frame_count(), 40);
  EXPECT_NEAR(source->frame_rate_hz().value_or(0.0), 30.0, 1e-3);  // the container keeps it as a ratio
  for (int i = 0; i < 40; ++i) EXPECT_EQ(NumberIn(source->Read(i).value().image_bgr), i);
  std::mt19937 random(11);
  for (int k = 0; k < 30; ++k) {
    const int i = static_cast<int>(random() % 40U);
    EXPECT_EQ(NumberIn(source->Read(i).value().image_bgr), i);
    EXPECT_EQ(NumberIn(source->Read(i).value().image_bgr), i);
  }
  for (const int i : {40, 55, 40}) EXPECT_FALSE(source->Read(i).has_value());
  EXPECT_EQ(NumberIn(source->Read(39).value().image_bgr), 39);
}

TEST(VideoFile, PicturesStayAsTheyWereWhenMoreAreRead) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("v.avi"), 3);
  const auto source = OpenImageSource(folder.File("v.avi"), PlainCamera("cam3"));
  const cv::Mat first = source->Read(0).value().image_bgr;
  (void)source->Read(1);
  (void)source->Read(2);
  EXPECT_EQ(NumberIn(first), 0);
}

TEST(VideoFile, SaysWhereItBreaksOffAndWhatWasPromised) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("v.avi"), 60);
  ASSERT_FALSE(FindContainerDamage(folder.File("v.avi")).has_value());
  for (const double share : {0.3, 0.6, 0.95}) {
    testing::CutFile(folder.File("v.avi"), folder.File("cut.avi"), share);
    EXPECT_THAT(OpenError(folder.File("cut.avi")),
                AllOf(HasSubstr("cut.avi"), HasSubstr("cut short"), HasSubstr("breaks off at frame"),
                      HasSubstr("of 60 promised")))
        << share;
  }
}

TEST(VideoFile, FindsSpaceThatWasReservedAndNeverWritten) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("v.avi"), 60);
  const auto whole_bytes = std::filesystem::file_size(folder.File("v.avi"));
  testing::CutFile(folder.File("v.avi"), folder.File("hole.avi"), 0.5);
  std::filesystem::resize_file(folder.File("hole.avi"), whole_bytes);
  const std::string message = OpenError(folder.File("hole.avi"));
  EXPECT_THAT(message, AllOf(HasSubstr("hole.avi"), HasSubstr("cut short")));
}

// Where picture `number` of an AVI begins: its chunk's header.
std::size_t PictureAt(const std::string& bytes, int number) {
  std::size_t at = bytes.find("00dc", bytes.find("movi"));
  for (int i = 0; i < number; ++i) at = bytes.find("00dc", at + 4);
  return at;
}

void Overwrite(std::string* bytes, std::size_t at, std::size_t count) {
  std::mt19937 random(12);
  for (std::size_t i = at; i < at + count; ++i) (*bytes)[i] = static_cast<char>(random() % 256U);
}

TEST(VideoFile, NamesTheFrameWhereItIsOverwritten) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("v.avi"), 60);
  const std::string whole = test_support::ReadText(folder.path() / "v.avi");
  std::string headless = whole, blank = whole;
  Overwrite(&headless, PictureAt(whole, 23), 8);     // its chunk's header: decoders pass over it
  Overwrite(&blank, PictureAt(whole, 41) + 8, 700);  // its picture's headers: decoders stop there
  testing::WriteText(folder.path() / "headless.avi", headless);
  testing::WriteText(folder.path() / "blank.avi", blank);
  EXPECT_THAT(OpenError(folder.File("headless.avi")),
              AllOf(HasSubstr("cam3"), HasSubstr("headless.avi"), HasSubstr("damaged at about frame 23")));
  // What comes before the damage can be used.
  const auto source = OpenImageSource(folder.File("blank.avi"), PlainCamera("cam3"));
  for (int i = 0; i < 38; ++i) EXPECT_EQ(NumberIn(source->Read(i).value().image_bgr), i);
  const auto read_on = [&] {
    for (int i = 38; i < 60; ++i) (void)source->Read(i);
  };
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, read_on),
              AllOf(HasSubstr("cam3"), HasSubstr("blank.avi"), HasSubstr("damaged at about frame 4")));
  EXPECT_THAT(ErrorOf(ErrorKind::kFile, [&] { (void)source->Read(50); }), HasSubstr("damaged"));
  EXPECT_EQ(NumberIn(source->Read(3).value().image_bgr), 3);
}

TEST(VideoFile, IsAsLongAsItsPicturesNotAsItsPromise) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("v.avi"), 30);
  for (const std::uint32_t promised : {0U, 30U, 50U, 5000U, 0xFFFFFFFFU}) {
    SCOPED_TRACE(promised);
    testing::PromiseFrames(folder.File("v.avi"), promised);
    const auto source = OpenImageSource(folder.File("v.avi"), PlainCamera("cam3"));
    for (int i = 0; i < 30; ++i) EXPECT_EQ(NumberIn(source->Read(i).value().image_bgr), i);
    EXPECT_FALSE(source->Read(30).has_value());
    EXPECT_EQ(source->frame_count(), 30);
    EXPECT_EQ(NumberIn(source->Read(7).value().image_bgr), 7);
    const auto other = OpenImageSource(folder.File("v.avi"), PlainCamera("cam3"));
    EXPECT_FALSE(other->Read(44).has_value());
    EXPECT_EQ(other->frame_count(), 30);
  }
}

TEST(VideoFile, SaysWhatIsMissingOrUnreadable) {
  const TestFolder folder;
  EXPECT_THAT(OpenError(folder.File("none.avi")), AllOf(HasSubstr("none.avi"), HasSubstr("does not exist")));
  testing::WriteText(folder.path() / "empty.avi", "");
  EXPECT_THAT(OpenError(folder.File("empty.avi")), HasSubstr("empty.avi"));
  testing::WriteText(folder.path() / "text.avi", std::string(5000, 'x'));
  EXPECT_THAT(OpenError(folder.File("text.avi")), HasSubstr("can't be opened"));
  testing::WriteVideo(folder.File("v.avi"), 5);
  EXPECT_THAT(ErrorOf(ErrorKind::kFile,
                      [&] { (void)OpenImageSource(folder.File("v.avi"), PlainCamera("cam3", 98, 64)); }),
              AllOf(HasSubstr("frame 0"), HasSubstr("96 x 64"), HasSubstr("98 x 64")));
}

TEST(VideoFile, StopsOpeningWhenAskedTo) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("v.avi"), 5);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THAT(
      ErrorOf(ErrorKind::kCancelled,
              [&] { (void)OpenImageSource(folder.File("v.avi"), PlainCamera("cam3"), stop.get_token()); }),
      HasSubstr("cancelled"));
}

TEST(LiveCamera, IsNoRecordedFootage) {
  for (const char* location : {"device:0", "v4l2:/dev/video0", "gige:Fake-GV01", "rtsp://10.0.0.1/live"})
    EXPECT_THAT(OpenError(location), HasSubstr("is a live camera")) << location;
}

// The box structure of an MP4 by hand: [size, type, content].
std::string Box(const std::string& type, std::size_t content_bytes, std::size_t more_promised = 0) {
  const std::size_t size = 8 + content_bytes + more_promised;
  std::string box;
  for (int shift = 24; shift >= 0; shift -= 8) box += static_cast<char>((size >> shift) & 0xFFU);
  return box + type + std::string(content_bytes, 'c');
}

TEST(ContainerCheck, KnowsTheMp4Family) {
  const TestFolder folder;
  const std::string start = Box("ftyp", 16) + Box("moov", 100);
  testing::WriteText(folder.path() / "whole.mp4", start + Box("mdat", 500));
  EXPECT_FALSE(FindContainerDamage(folder.path() / "whole.mp4").has_value());
  testing::WriteText(folder.path() / "cut.mp4", start + Box("mdat", 300, 200));
  const auto damage = FindContainerDamage(folder.path() / "cut.mp4");
  ASSERT_TRUE(damage.has_value());
  EXPECT_EQ(damage->promised_bytes - damage->at_byte, 200U);
  EXPECT_THAT(OpenError(folder.File("cut.mp4")),
              AllOf(HasSubstr("cut short"), HasSubstr("none of its frames")));
}

// An AVI's frames by hand: their chunks, the odd ones padded or not.
std::string Avi(const std::vector<std::size_t>& picture_bytes, bool is_padded) {
  const auto chunk = [](const std::string& type, const std::string& content) {
    std::string header = type;
    for (int shift = 0; shift < 32; shift += 8)
      header += static_cast<char>((content.size() >> static_cast<unsigned>(shift)) & 0xFFU);
    return header + content;
  };
  std::string movi = "movi";
  for (const std::size_t bytes : picture_bytes) {
    movi += chunk("00dc", std::string(bytes, '\xFE'));
    if (is_padded && bytes % 2 == 1) movi += '\0';
  }
  return chunk("RIFF", "AVI " + chunk("LIST", movi));
}

TEST(ContainerCheck, FollowsChunksPaddedOrNot) {
  const TestFolder folder;
  for (const bool is_padded : {true, false}) {
    std::string bytes = Avi({301, 200, 77, 33, 400}, is_padded);
    testing::WriteText(folder.path() / "v.avi", bytes);
    EXPECT_FALSE(FindContainerDamage(folder.path() / "v.avi").has_value()) << is_padded;
    bytes[PictureAt(bytes, 3) + 5] = 'x';  // a size beyond the end
    testing::WriteText(folder.path() / "v.avi", bytes);
    const auto damage = FindContainerDamage(folder.path() / "v.avi");
    ASSERT_TRUE(damage.has_value()) << is_padded;
    EXPECT_EQ(damage->frame, 3);
    EXPECT_EQ(damage->at_byte, PictureAt(bytes, 3));
  }
}

TEST(ContainerCheck, LetsPassWhatItCannotJudge) {
  const TestFolder folder;
  testing::WriteVideo(folder.File("v.avi"), 20);
  // A stream's writer never learns the size; some writers count their own header twice.
  for (const std::uint32_t riff_bytes :
       {0U, 0xFFFFFFFFU, static_cast<std::uint32_t>(std::filesystem::file_size(folder.File("v.avi")))}) {
    std::fstream file(folder.File("v.avi"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(4);
    for (int shift = 0; shift < 32; shift += 8) file.put(static_cast<char>((riff_bytes >> shift) & 0xFFU));
    file.close();
    EXPECT_FALSE(FindContainerDamage(folder.File("v.avi")).has_value()) << riff_bytes;
    EXPECT_EQ(OpenImageSource(folder.File("v.avi"), PlainCamera("cam3"))->frame_count(), 20) << riff_bytes;
  }
}

}  // namespace
}  // namespace elbowroom::recon
