#include "app/control/sweep/sweep_cells.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "tests/app/sweep/swept_sessions.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

SweepCellsByKey SampleCells() {
  const review::PartAtSpacing touched{1, 2, 3, 4, 0.1, 0.0, 1.0 / 3.0, 7};
  review::PartAtSpacing far;
  far.lower_mm = 5e-324;
  const review::PartCurve curve{10, {touched, far}, 100.1, {}};
  SweepCell cell;
  cell.tools = {{}, {"a b%", "tongs\n", "", "Zange \xC3\xBC"}};
  cell.part.curves = {curve, curve};
  cell.part.count = {1, 2, 3, 4, 5};
  SweepCell other = cell;
  other.part.curves[1].steps[0].deepest_mm = 1e300;
  return {{"key", cell}, {"another", other}};
}

TEST(SweepCell, ComesBackToTheLastBit) {
  const SweepCellsByKey cells = SampleCells();
  const auto back = ParseSweepCells(BytesOf(cells));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(BytesOf(*back), BytesOf(cells));
  ASSERT_EQ(back->size(), 2U);
  const SweepCell& cell = back->at("key");
  EXPECT_EQ(cell.tools, cells.at("key").tools);
  const review::PartCurve& curve = cell.part.curves.at(1);
  EXPECT_EQ(curve.frames, 10);
  EXPECT_EQ(curve.steps[0].upper_mm, 1.0 / 3.0);
  EXPECT_EQ(curve.steps[0].closest_frame, 7);
  EXPECT_EQ(curve.steps[1].lower_mm, 5e-324);
  EXPECT_EQ(curve.steps[1].upper_mm, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(curve.steps[1].closest_frame.has_value());
  EXPECT_EQ(curve.largest_touched_mm, 100.1);
  EXPECT_FALSE(curve.smallest_free_mm.has_value());
  EXPECT_EQ(cell.part.count.unchanged_frames, 5);
  EXPECT_EQ(back->at("another").part.curves[1].steps[0].deepest_mm, 1e300);
}

TEST(SweepCell, NoDamageIsBelieved) {
  const std::string bytes = BytesOf(SampleCells());
  EXPECT_FALSE(ParseSweepCells("").has_value());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_FALSE(ParseSweepCells(bytes.substr(0, i)).has_value()) << "cut off at " << i;
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(flipped[i] ^ 1);
    EXPECT_FALSE(ParseSweepCells(flipped).has_value()) << "byte " << i;
  }
}

class CellsOfSessions : public testing::Test {
 protected:
  CellsOfSessions() {
    tests::RecordTaskFrames(folder_ / "a.db", 20);
    tests::RecordTaskFrames(folder_ / "b.db", 25);
  }
  [[nodiscard]] SweepCells Of(const char* file, const SpacingRange& range) const {
    return {folder_ / "out", sessions::SessionReader(folder_ / file), range};
  }

  test_support::TemporaryFolder folder_;
  const SpacingRange range_{"payload_a_gap", 140.0, 240.0, 50.0};
  const CellQuestion question_{0, 6, "mesh", true, {core::RigidTransform()}};
};

TEST_F(CellsOfSessions, AreKeptForTheSameQuestion) {
  SweepCells cells = Of("a.db", range_);
  const CellKey key = cells.KeyOf(question_);
  EXPECT_EQ(cells.Find(key), nullptr);
  cells.Keep({{key, SampleCells().at("key")}});
  ASSERT_NE(cells.Find(key), nullptr);
  EXPECT_EQ(cells.FileOf(key), "") << "it wasn't there at first";
  const SweepCells later = Of("a.db", range_);
  EXPECT_EQ(later.KeyOf(question_), key);
  ASSERT_NE(later.Find(key), nullptr);
  EXPECT_EQ(CellFilesIn(folder_ / "out"), std::set<std::string>{later.FileOf(key)});
}

TEST_F(CellsOfSessions, EveryOtherQuestionHasAnotherKey) {
  const SweepCells cells = Of("a.db", range_);
  std::set<CellKey> keys{cells.KeyOf(question_)};
  CellQuestion other = question_;
  other.end = 5;
  keys.insert(cells.KeyOf(other));
  other = question_;
  other.mesh_hash = "another mesh";
  keys.insert(cells.KeyOf(other));
  other = question_;
  other.moves = false;
  keys.insert(cells.KeyOf(other));
  other = question_;
  other.world_from_part[0].translation_mm.x() = std::numeric_limits<double>::denorm_min();
  keys.insert(cells.KeyOf(other));
  SpacingRange finer = range_;
  finer.step_mm = 25.0;
  keys.insert(Of("a.db", finer).KeyOf(question_));
  keys.insert(Of("b.db", range_).KeyOf(question_));
  EXPECT_EQ(keys.size(), 7U);
}

TEST_F(CellsOfSessions, ADamagedFileIsNotThere) {
  SweepCells cells = Of("a.db", range_);
  const CellKey key = cells.KeyOf(question_);
  cells.Keep({{key, SampleCells().at("key")}});
  const std::string file = *CellFilesIn(folder_ / "out").begin();
  std::filesystem::resize_file(CellsIn(folder_ / "out") / file, 40);
  EXPECT_EQ(Of("a.db", range_).Find(key), nullptr);
}

}  // namespace
}  // namespace elbowroom::control
