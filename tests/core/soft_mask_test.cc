#include "core/soft_mask.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"

namespace elbowroom::core {
namespace {

BitMask RandomMask(int width_px, int height_px, std::mt19937_64& random) {
  BitMask mask(width_px, height_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) mask.Set(x, y, random() % 3 == 0);
  return mask;
}

TEST(BoundaryPixels, AreThoseWithANeighbourOfTheOtherLabel) {
  std::mt19937_64 random(1);
  for (const int width_px : {1, 2, 63, 64, 65, 127, 128, 200}) {
    const BitMask mask = RandomMask(width_px, 9, random);
    const BitMask boundary = BoundaryPixels(mask);
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < width_px; ++x) {
        const bool own = mask.At(x, y);
        const bool differs = (x > 0 && mask.At(x - 1, y) != own) ||
                             (x + 1 < width_px && mask.At(x + 1, y) != own) ||
                             (y > 0 && mask.At(x, y - 1) != own) || (y + 1 < 9 && mask.At(x, y + 1) != own);
        ASSERT_EQ(boundary.At(x, y), differs) << "width " << width_px << ", pixel " << x << ", " << y;
      }
    }
    // Also the padding stays zero.
    std::size_t counted = 0;
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < width_px; ++x) counted += boundary.At(x, y) ? 1 : 0;
    EXPECT_EQ(boundary.CountObjectPixels(), counted);
  }
}

TEST(SoftMask, LevelsMustBeOneABoundaryPixelAndAgreeWithTheBits) {
  SoftMask soft{BitMask(3, 1), {}};
  EXPECT_NO_THROW(soft.Validate());
  soft.mask.Set(1, 0, true);
  EXPECT_NO_THROW(soft.Validate()) << "coverage not known";
  soft.levels = {10, 200, 127};
  EXPECT_NO_THROW(soft.Validate());
  soft.levels = {10, 200};
  EXPECT_THROW(soft.Validate(), PreconditionError);
  soft.levels = {10, 127, 0};
  EXPECT_THROW(soft.Validate(), PreconditionError);
  soft.levels = {10, 255, 128};
  EXPECT_THROW(soft.Validate(), PreconditionError);
}

}  // namespace
}  // namespace elbowroom::core
