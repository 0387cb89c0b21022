#include "recon/decoding/codec_complaint.h"

#include <gtest/gtest.h>

#include <string>

namespace elbowroom::recon {
namespace {

TEST(ComplaintIn, IsTheFirstLineThatTellsOfDamage) {
  EXPECT_EQ(ComplaintIn("[DEBUG:0@0.008] global ./modules/x.cpp (1) open\n[OPENCV:FFMPEG:16] ac-tex damaged "
                        "at 3 4\nmore\n"),
            "ac-tex damaged at 3 4");
  EXPECT_EQ(ComplaintIn("libpng warning: IDAT: Too much image data\n"), "warning: IDAT: Too much image data");
  EXPECT_EQ(ComplaintIn("Corrupt JPEG data: premature end of data segment"),
            "Corrupt JPEG data: premature end of data segment");
}

TEST(ComplaintIn, IsNoneOfWhatIsHarmless) {
  for (const std::string printed :
       {"", "\n \n", "[ INFO:0@0.1] global x\n",
        "OpenCV TIFF: TIFFReadDirectory: Warning, Unknown field with tag 700 (0x2bc) encountered\n",
        "[OPENCV:FFMPEG:16] deprecated pixel format used, make sure you did set range correctly\n",
        "imdecode_(''): can't read data: OpenCV(4.6.0) ./modules/x.cpp:1: error\n"}) {
    EXPECT_EQ(ComplaintIn(printed), "") << printed;
  }
}

TEST(ComplaintIn, IsShortAndPrintable) {
  const std::string complaint = ComplaintIn("a\x1b[31m" + std::string(5000, 'x'));
  EXPECT_EQ(complaint.size(), 100U);
  EXPECT_EQ(complaint.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::recon
