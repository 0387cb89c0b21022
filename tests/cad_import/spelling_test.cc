#include "core/spelling.h"

#include <gtest/gtest.h>

namespace elbowroom::cad_import {
namespace {

constexpr std::string_view kKeys[] = {"name", "file", "position_mm", "rotation_rpy_deg", "min_mm", "max_mm"};

TEST(NearestWord, FindsTheKeyThatWasMeant) {
  EXPECT_EQ(core::NearestWord("positon_mm", kKeys), "position_mm");
  EXPECT_EQ(core::NearestWord("rotation_deg", kKeys), "rotation_rpy_deg");
  EXPECT_EQ(core::NearestWord("Name", kKeys), "name");
  EXPECT_EQ(core::NearestWord("mx_mm", kKeys), "max_mm");
}

TEST(NearestWord, OffersNothingForAWordUnlikeAll) {
  EXPECT_EQ(core::NearestWord("colour", kKeys), std::nullopt);
  EXPECT_EQ(core::NearestWord("xyz", kKeys), std::nullopt);
  EXPECT_EQ(core::NearestWord("", kKeys), std::nullopt);
}

}  // namespace
}  // namespace elbowroom::cad_import
