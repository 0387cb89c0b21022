#include "core/bit_mask.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/error.h"

namespace elbowroom::core {
namespace {

TEST(BitMask, BeginsAsBackground) {
  const BitMask mask(130, 3);
  EXPECT_EQ(mask.words_per_row(), 3U);
  EXPECT_EQ(mask.words().size(), 9U);
  EXPECT_EQ(mask.CountObjectPixels(), 0U);
}

TEST(BitMask, AgreesWithAPlainArrayOverRandomWrites) {
  constexpr int kWidth = 197, kHeight = 31;  // no multiple of 64
  std::mt19937 random(2);
  BitMask mask(kWidth, kHeight);
  std::vector<bool> plain(kWidth * kHeight, false);
  for (int i = 0; i < 20'000; ++i) {
    const int x = static_cast<int>(random() % kWidth), y = static_cast<int>(random() % kHeight);
    const bool object = random() % 3 == 0;
    mask.Set(x, y, object);
    plain[static_cast<std::size_t>(y * kWidth + x)] = object;
  }
  std::size_t count = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_EQ(mask.At(x, y), plain[static_cast<std::size_t>(y * kWidth + x)]) << x << ", " << y;
      count += mask.At(x, y) ? 1 : 0;
    }
  }
  EXPECT_EQ(mask.CountObjectPixels(), count);
}

TEST(BitMask, SmallestXIsTheLowestBitAndPaddingStaysZero) {
  BitMask mask(66, 2);
  for (int x = 0; x < 66; ++x) mask.Set(x, 1, true);
  EXPECT_EQ(mask.words()[0], 0U);
  EXPECT_EQ(mask.words()[2], ~std::uint64_t{0});
  EXPECT_EQ(mask.words()[3], 0b11U);
  mask.Set(0, 1, false);
  EXPECT_EQ(mask.words()[2], ~std::uint64_t{1});
}

TEST(BitMask, EqualWhenSizeAndPixelsAre) {
  BitMask a(10, 4), b(10, 4);
  EXPECT_EQ(a, b);
  b.Set(9, 3, true);
  EXPECT_NE(a, b);
  EXPECT_NE(BitMask(10, 4), BitMask(4, 10));
}

TEST(BitMask, SizesMayBeZeroButNotNegative) {
  EXPECT_EQ(BitMask(0, 0).CountObjectPixels(), 0U);
  EXPECT_THROW(BitMask(-1, 5), PreconditionError);
  EXPECT_THROW(BitMask(5, -1), PreconditionError);
}

TEST(BitMask, SetAllSetsThePixelsAndNotThePadding) {
  for (const int width_px : {1, 63, 64, 65, 130}) {
    BitMask all(width_px, 3), one_by_one(width_px, 3);
    all.SetAll();
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < width_px; ++x) one_by_one.Set(x, y, true);
    EXPECT_EQ(all, one_by_one) << width_px;
  }
  BitMask none(0, 3);
  none.SetAll();
  EXPECT_FALSE(none.ShowsObject());
}

}  // namespace
}  // namespace elbowroom::core
