#include "core/units.h"

#include <gtest/gtest.h>

namespace elbowroom::core {
namespace {

TEST(LengthUnit, EachIsItsLengthInMillimetres) {
  EXPECT_EQ(MillimetresPer(LengthUnit::kMillimetre), 1.0);
  EXPECT_EQ(MillimetresPer(LengthUnit::kCentimetre), 10.0);
  EXPECT_EQ(MillimetresPer(LengthUnit::kMetre), 1000.0);
  EXPECT_EQ(MillimetresPer(LengthUnit::kInch), 25.4);
}

TEST(LengthUnit, TextComesBackAsTheSameUnit) {
  for (const auto unit :
       {LengthUnit::kMillimetre, LengthUnit::kCentimetre, LengthUnit::kMetre, LengthUnit::kInch}) {
    EXPECT_EQ(ParseLengthUnit(ToString(unit)), unit);
  }
}

TEST(LengthUnit, NothingElseIsAUnit) {
  for (const char* text : {"", "MM", "mm ", "inch", "ft", "metre", "µm"})
    EXPECT_EQ(ParseLengthUnit(text), std::nullopt);
}

TEST(Angle, RightAngleBothWays) {
  EXPECT_DOUBLE_EQ(RadiansFromDegrees(90.0), 1.5707963267948966);
  EXPECT_DOUBLE_EQ(DegreesFromRadians(1.5707963267948966), 90.0);
}

}  // namespace
}  // namespace elbowroom::core
