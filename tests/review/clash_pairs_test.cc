#include "review/clash_pairs.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "core/error.h"
#include "tests/core/solids.h"

namespace elbowroom::review {
namespace {

core::Layout FourParts() {
  core::Layout layout;
  const auto box = std::make_shared<const core::TriangleMesh>(core::testing::Box({1, 1, 1}));
  for (const char* name : {"pmt", "payload A", "payload B", "cable"})
    layout.parts.push_back({name, "", {}, box, {}});
  return layout;
}

std::string Text(const PairMatrix& matrix) {
  std::string text;
  for (const PairDemand& pair : matrix.pairs) text += std::to_string(pair.a) + std::to_string(pair.b) + " ";
  return text;
}

std::string ErrorOf(const core::Layout& layout, const PairSelection& selection = {},
                    double required_mm = 0.0) {
  try {
    (void)PairsOf(layout, selection, required_mm);
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::ErrorKind::kRange);
    return error.what();
  }
  return "no error";
}

TEST(PairsOf, AllPairsWithTheDefaultWhereNoRuleSaysOtherwise) {
  core::Layout layout = FourParts();
  layout.pair_rules = {{"payload B", "pmt", 7.5, false}, {"cable", "pmt", 0.0, true}};
  const PairMatrix matrix = PairsOf(layout, {}, 3.0);
  EXPECT_EQ(Text(matrix), "01 02 03 12 13 23 ");
  EXPECT_EQ(matrix.pairs[0].required_mm, 3.0);
  EXPECT_EQ(matrix.pairs[1].required_mm, 7.5);
  EXPECT_FALSE(matrix.pairs[1].authorised_contact);
  EXPECT_EQ(matrix.pairs[2].required_mm, 0.0);
  EXPECT_TRUE(matrix.pairs[2].authorised_contact);
  EXPECT_EQ(matrix.ignored, 0);
}

TEST(PairsOf, AnIgnoredPairIsLeftOutAndCounted) {
  core::Layout layout = FourParts();
  layout.pair_rules = {{"cable", "pmt", 5.0, false, true}};
  EXPECT_EQ(Text(PairsOf(layout)), "01 02 12 13 23 ");
  EXPECT_EQ(PairsOf(layout).ignored, 1);
  EXPECT_EQ(PairsOf(layout, {{"payload A", "cable"}, {}, {}}).ignored, 0);
}

TEST(PairsOf, SelectionsTakeTheirPairsOnce) {
  const core::Layout layout = FourParts();
  EXPECT_EQ(Text(PairsOf(layout, {{"cable", "pmt", "payload A"}, {}, {}})), "01 03 13 ");
  EXPECT_EQ(Text(PairsOf(layout, {{"cable", "cable"}, {}, {}})), "");
  EXPECT_EQ(Text(PairsOf(layout, {{}, {"cable"}, {"pmt", "payload B"}})), "03 23 ");
  // Parts on both sides: every pair across, none twice, none of a part with itself.
  EXPECT_EQ(Text(PairsOf(layout, {{}, {"cable", "pmt"}, {"pmt", "payload B"}})), "02 03 23 ");
}

TEST(PairsOf, MistakesAreNamed) {
  core::Layout layout = FourParts();
  EXPECT_EQ(ErrorOf(layout, {{"payload a"}, {}, {}}),
            "no part is named 'payload a'; did you mean 'payload A'?");
  EXPECT_NE(ErrorOf(layout, {{}, {"cable"}, {}}).find("two sides"), std::string::npos);
  EXPECT_NE(ErrorOf(layout, {{}, {}, {"cable"}}).find("two sides"), std::string::npos);
  EXPECT_NE(ErrorOf(layout, {{"pmt"}, {"cable"}, {"pmt"}}).find("choose one"), std::string::npos);
  EXPECT_NE(ErrorOf(layout, {}, -1.0).find("0 mm or more"), std::string::npos);
  EXPECT_NE(ErrorOf(layout, {}, std::numeric_limits<double>::quiet_NaN()).find("0 mm or more"),
            std::string::npos);
  layout.pair_rules = {{"cable", "pmt", 5.0, false}, {"pmt", "cable", 6.0, false}};
  EXPECT_EQ(ErrorOf(layout), "[[pair]] 'pmt' and 'cable': has two rules; keep one of them");
  layout.pair_rules = {{"pmt", "pmt", 5.0, false}};
  EXPECT_NE(ErrorOf(layout).find("no clearance to itself"), std::string::npos);
}

}  // namespace
}  // namespace elbowroom::review
