#include "app/control/sweep/sweep_cells.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/app/sweep/swept_sessions.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

SweepCell SampleCell() {
  review::PartAtSpacing touched{1, 2, 3, 4, 0.1, 0.0, 1.0 / 3.0, 7};
  review::PartAtSpacing far;
  far.lower_mm = 5e-324;
  review::SpacingCurve curve{10, {{100.1, {touched, far}}, {200.0, {far, touched}}}, 100.1, {}};
  SweepCell cell;
  cell.curves = {{{}, curve}, {{"a b%", "tongs\n", "", "Zange \xC3\xBC"}, curve}};
  cell.count = {1, 2, 3, 4, 5};
  return cell;
}

TEST(SweepCell, ComesBackToTheLastBit) {
  const SweepCell cell = SampleCell();
  const auto back = ParseSweepCell(TextOf(cell, "key"), "key");
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(TextOf(*back, "key"), TextOf(cell, "key"));
  EXPECT_EQ(back->curves[1].tools, cell.curves[1].tools);
  EXPECT_EQ(back->curves[0].curve.steps[1].parts[1].upper_mm, 1.0 / 3.0);
  EXPECT_EQ(back->curves[0].curve.steps[0].parts[1].upper_mm, std::numeric_limits<double>::infinity());
  EXPECT_EQ(back->curves[0].curve.largest_touched_mm, 100.1);
  EXPECT_FALSE(back->curves[0].curve.smallest_free_mm.has_value());
  EXPECT_EQ(back->count.unchanged_frames, 5);
}

TEST(SweepCell, NoDamageIsBelieved) {
  const std::string text = TextOf(SampleCell(), "key");
  EXPECT_FALSE(ParseSweepCell(text, "another key").has_value());
  EXPECT_FALSE(ParseSweepCell("", "key").has_value());
  for (std::size_t i = 0; i < text.size(); ++i) {
    EXPECT_FALSE(ParseSweepCell(text.substr(0, i), "key").has_value()) << "cut off at " << i;
    std::string flipped = text;
    flipped[i] = static_cast<char>(flipped[i] ^ 1);
    EXPECT_FALSE(ParseSweepCell(flipped, "key").has_value()) << "byte " << i;
  }
}

TEST(SweepCells, AreOfOneSessionAndRange) {
  const test_support::TemporaryFolder folder;
  tests::RecordTaskFrames(folder / "a.db", 20);
  tests::RecordTaskFrames(folder / "b.db", 25);
  const sessions::SessionReader a(folder / "a.db"), b(folder / "b.db");
  const SpacingRange range{"payload_a_gap", 140.0, 240.0, 50.0};
  const SweepCells of_a(folder / "out", a, range);
  of_a.Keep(0, 6, SampleCell());
  EXPECT_TRUE(of_a.Find(0, 6).has_value());
  EXPECT_FALSE(of_a.Find(0, 5).has_value());
  EXPECT_FALSE(SweepCells(folder / "out", b, range).Find(0, 6).has_value());
  SpacingRange other = range;
  other.step_mm = 25.0;
  EXPECT_FALSE(SweepCells(folder / "out", a, other).Find(0, 6).has_value());
}

}  // namespace
}  // namespace elbowroom::control
