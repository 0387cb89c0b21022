#include "core/history.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "core/layout.h"
#include "tests/core/solids.h"

namespace elbowroom::core {
namespace {

Layout TwoBoxes() {
  const auto box = std::make_shared<const TriangleMesh>(testing::Box({100, 200, 300}));
  Layout layout;
  for (const char* name : {"pmt", "payload"}) {
    Part& part = layout.parts.emplace_back();
    part.name = name;
    part.file = "box.stl";
    part.mesh = box;
  }
  layout.parts[1].world_from_part = FromPositionAndRollPitchYaw({1, 2, 3}, {12, -34, 56});
  layout.spacings = {{"gap", "payload", "pmt", Axis::kZ, -1000, 1000, 140}};
  return layout;
}

void ChangeAtRandom(Layout& layout, std::mt19937& random) {
  std::uniform_real_distribution<double> length_mm(-500, 500);
  switch (random() % 4U) {
    case 0:
      layout.spacings[0].initial_mm = length_mm(random);
      break;
    case 1:
      layout.parts[random() % layout.parts.size()].world_from_part =
          FromPositionAndRollPitchYaw({length_mm(random), 0, 0}, {length_mm(random), 0, 0});
      break;
    case 2:
      layout.pair_rules.push_back({"pmt", "payload", length_mm(random), false});
      break;
    default:
      layout.groups.push_back({"group", {"pmt"}});
  }
}

TEST(History, UndoingAndRedoingAnySequenceGivesEqualValues) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::vector<Layout> values = {TwoBoxes()};
    History<Layout> history(values.front());
    for (int edit = 0; edit < 30; ++edit) {
      if (random() % 5U == 0 && history.CanUndo()) {
        history = history.Undone();
        values.pop_back();
      } else {
        Layout next = history.now();
        ChangeAtRandom(next, random);
        history = history.Changed(next);
        values.push_back(std::move(next));
      }
    }
    for (std::size_t i = values.size(); i-- > 1; history = history.Undone())
      EXPECT_EQ(history.now(), values[i]);
    EXPECT_EQ(history.now(), values.front());
    EXPECT_FALSE(history.CanUndo());
    for (std::size_t i = 1; i < values.size(); ++i) {
      history = history.Redone();
      EXPECT_EQ(history.now(), values[i]);
    }
  }
}

TEST(History, AGapMovedOutUndoneAndRedoneGivesBitEqualPoses) {
  History<Layout> history(TwoBoxes());
  const auto poses = [&] { return PosesAt(history.now(), history.now().InitialSpacings()); };
  const auto moved_to = [&](double gap_mm) {
    Layout layout = history.now();
    layout.spacings[0].initial_mm = gap_mm;
    return history.Changed(std::move(layout));
  };
  const auto at_140 = poses();
  history = moved_to(240.0);
  const auto at_240 = poses();
  EXPECT_NE(at_140, at_240);
  EXPECT_EQ((history = moved_to(140.0), poses()), at_140);
  EXPECT_EQ((history = history.Undone(), poses()), at_240);
  EXPECT_EQ((history = history.Undone(), poses()), at_140);
  EXPECT_EQ((history = history.Redone(), poses()), at_240);
}

TEST(History, AChangeForgetsWhatWasUndoneAndNoChangeDoesnt) {
  const History<int> one = History<int>(1).Changed(2).Undone();
  EXPECT_TRUE(one.Changed(1).CanRedo());
  EXPECT_FALSE(one.Changed(3).CanRedo());
  EXPECT_EQ(one.Changed(3).Undone().now(), 1);
  EXPECT_EQ(one.Redone().now(), 2) << "the value itself hasn't changed";
  EXPECT_THROW((void)one.Undone(), PreconditionError);
  EXPECT_THROW((void)one.Redone().Redone(), PreconditionError);
}

}  // namespace
}  // namespace elbowroom::core
