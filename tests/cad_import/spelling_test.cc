#include "cad_import/spelling.h"

#include <gtest/gtest.h>

namespace elbowroom::cad_import {
namespace {

constexpr std::string_view kKeys[] = {"name", "file", "position_mm", "rotation_rpy_deg", "min_mm", "max_mm"};

TEST(NearestWord, FindsTheKeyThatWasMeant) {
  EXPECT_EQ(NearestWord("positon_mm", kKeys), "position_mm");
  EXPECT_EQ(NearestWord("rotation_deg", kKeys), "rotation_rpy_deg");
  EXPECT_EQ(NearestWord("Name", kKeys), "name");
  EXPECT_EQ(NearestWord("mx_mm", kKeys), "max_mm");
}

TEST(NearestWord, OffersNothingForAWordUnlikeAll) {
  EXPECT_EQ(NearestWord("colour", kKeys), std::nullopt);
  EXPECT_EQ(NearestWord("xyz", kKeys), std::nullopt);
  EXPECT_EQ(NearestWord("", kKeys), std::nullopt);
}

}  // namespace
}  // namespace elbowroom::cad_import
