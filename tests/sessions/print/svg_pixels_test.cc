// Drawings painted on pixels.
#include "sessions/print/svg_pixels.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"

namespace elbowroom::tests {
namespace {

constexpr int kPictureWidthPx = 60, kPictureHeightPx = 30;

class SvgPixels : public testing::Test {
 protected:
  void Paint(const std::string& content, double left_px = 0.0) {
    sessions::PaintSvg("<svg xmlns='http://www.w3.org/2000/svg' width='60' height='30'>" + content + "</svg>",
                       left_px, {kPictureWidthPx, kPictureHeightPx, rgb_});
  }
  [[nodiscard]] int At(int x, int y, int channel) const {
    return rgb_[static_cast<std::size_t>(3 * (y * kPictureWidthPx + x) + channel)];
  }
  [[nodiscard]] int Darkened() const {
    int count = 0;
    for (int y = 0; y < kPictureHeightPx; ++y)
      for (int x = 0; x < kPictureWidthPx; ++x) count += At(x, y, 0) < 128 ? 1 : 0;
    return count;
  }

  std::vector<std::uint8_t> rgb_ =
      std::vector<std::uint8_t>(std::size_t{3} * kPictureWidthPx * kPictureHeightPx, 255);
};

TEST_F(SvgPixels, AnIntegerPositionIsThePixelsMiddle) {
  Paint("<polyline points='10,5 10,20' stroke='#102030' stroke-width='1'/>", 7.0);
  EXPECT_EQ(At(17, 10, 0), 0x10);
  EXPECT_EQ(At(17, 10, 1), 0x20);
  EXPECT_EQ(At(17, 10, 2), 0x30);
  EXPECT_EQ(At(16, 10, 0), 255);
  EXPECT_EQ(At(18, 10, 0), 255);
}

TEST_F(SvgPixels, WhatIsThereStaysWhereNothingIsDrawn) {
  rgb_[0] = 1;
  rgb_[4] = 77;
  Paint("<rect x='40' y='20' width='5' height='5' fill='#000000'/>");
  EXPECT_EQ(At(0, 0, 0), 1);
  EXPECT_EQ(At(1, 0, 1), 77);
  EXPECT_EQ(At(42, 22, 0), 0);
}

TEST_F(SvgPixels, WhatReachesOutOfThePictureIsCutOff) {
  Paint("<rect x='-5' y='-50' width='500' height='500' fill='#000000'/>", 20.0);
  EXPECT_EQ(At(14, 10, 0), 255);
  EXPECT_EQ(At(16, 0, 0), 0) << "the drawing may reach out of its own size";
  EXPECT_EQ(At(kPictureWidthPx - 1, kPictureHeightPx - 1, 0), 0);
}

TEST_F(SvgPixels, TextOfAnyScriptHasLetters) {
  Paint(
      "<text x='5' y='20' font-size='16' font-family='sans-serif' fill='#000000'>\u03A9\u0416\u05D0</text>");
  EXPECT_GT(Darkened(), 40);
}

TEST_F(SvgPixels, WhatIsNoSvgIsRefused) {
  EXPECT_THROW(sessions::PaintSvg("<svg", 0.0, {kPictureWidthPx, kPictureHeightPx, rgb_}),
               core::PreconditionError);
  EXPECT_THROW(sessions::PaintSvg("<svg/>", 0.0, {kPictureWidthPx + 1, kPictureHeightPx, rgb_}),
               core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::tests
