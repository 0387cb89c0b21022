// Parts of a million triangles: the page's work on them leaves the UI thread to the user.
#include <gtest/gtest.h>

#include <QSignalSpy>
#include <QTest>
#include <QTimer>
#include <cmath>
#include <memory>

#include "app/console/layouts/parts_view.h"
#include "app/console/layouts/placing_steps.h"
#include "tests/app/layouts/box_file.h"

namespace elbowroom::console {
namespace {

constexpr int kLongWaitMs = 120'000;  // far beyond what any step takes on a loaded machine
constexpr int kSegments = 500'000;    // two triangles each
constexpr double kRadiusMm = 40.0, kLengthMm = 90.0;
// A thread that worked on a million triangles itself would run no event in between.
constexpr int kManyEvents = 50;

core::SharedMesh LargeWall() {
  static const auto wall = std::make_shared<const core::TriangleMesh>(
      test_support::Wall(kRadiusMm, kLengthMm, 6.283185307179586, kSegments, false));
  return wall;
}

// Counts the events that the UI thread runs.
class EventCount {
 public:
  EventCount() {
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] { ++count_; });
    timer_.start(0);
  }
  [[nodiscard]] int count() const { return count_; }

 private:
  QTimer timer_;
  int count_ = 0;
};

class LargeParts : public testing::Test {
 protected:
  LargeParts() {
    for (const char* name : {"pin", "plate"}) {
      core::Part part;
      part.name = name;
      part.mesh = LargeWall();
      layout_.parts.push_back(part);
    }
    poses_ = {core::FromPositionAndRollPitchYaw({300.0, 0.0, 0.0}, {30.0, 40.0, 0.0}), {}};
  }
  [[nodiscard]] control::Pick PickOf(core::PartIndex part) const {
    control::Pick pick;
    pick.part = part;
    pick.triangle = 1000;
    return pick;
  }

  core::Layout layout_;
  std::vector<core::RigidTransform> poses_;
};

TEST_F(LargeParts, HolesAreFoundWhileTheWindowAnswers) {
  PlacingSteps steps;
  const QSignalSpy placed(&steps, &PlacingSteps::Placed), failed(&steps, &PlacingSteps::Failed);
  core::RigidTransform pose;
  QObject::connect(&steps, &PlacingSteps::Placed, &steps,
                   [&](const QString&, const core::RigidTransform& to) { pose = to; });
  steps.Begin(Placing::kHoleToHole);
  const QString first_advice = steps.Advice();
  const EventCount events;
  steps.Take(layout_, poses_, PickOf(0));
  EXPECT_TRUE(steps.Advice().contains("Looking")) << "the click was worked on by the UI thread";
  steps.Take(layout_, poses_, PickOf(1));  // too soon: nothing
  ASSERT_TRUE(QTest::qWaitFor([&] { return !steps.Advice().contains("Looking"); }, kLongWaitMs));
  EXPECT_GT(events.count(), kManyEvents);
  EXPECT_NE(steps.Advice(), first_advice);  // the second hole is asked for
  steps.Take(layout_, poses_, PickOf(1));
  ASSERT_TRUE(QTest::qWaitFor([&] { return placed.count() + failed.count() > 0; }, kLongWaitMs));
  ASSERT_EQ(failed.count(), 0) << failed.value(0).value(0).toString().toStdString();
  EXPECT_LT(pose.rotation.col(2).cross(Eigen::Vector3d::UnitZ()).norm(), 1e-6);
  EXPECT_LT(pose.translation_mm.head<2>().norm(), 1e-3);
}

TEST_F(LargeParts, ASearchForAHoleIsGivenUp) {
  PlacingSteps steps;
  const QSignalSpy placed(&steps, &PlacingSteps::Placed), failed(&steps, &PlacingSteps::Failed);
  steps.Begin(Placing::kHoleToHole);
  steps.Take(layout_, poses_, PickOf(0));
  steps.End();  // what Esc does
  EXPECT_TRUE(steps.Advice().isEmpty());
  steps.Begin(Placing::kHoleToHole);
  ASSERT_TRUE(QTest::qWaitFor([&] { return !steps.Advice().contains("Looking"); }, kLongWaitMs));
  EXPECT_TRUE(steps.Advice().contains("of the part that moves"));  // the click is forgotten
  EXPECT_EQ(failed.count() + placed.count(), 0);
}

TEST_F(LargeParts, BoxesAreFoundWhileTheWindowAnswers) {
  PartsView view;
  view.resize(640, 480);
  view.show();
  const EventCount events;
  std::vector<ShownPart> parts;
  for (core::PartIndex i = 0; i < layout_.parts.size(); ++i)
    parts.push_back({QString::fromStdString(layout_.parts[i].name), layout_.parts[i].mesh, poses_[i]});
  view.Show(parts, {});
  EXPECT_TRUE(view.is_measuring()) << "the boxes were found by the UI thread";
  ASSERT_TRUE(QTest::qWaitFor([&] { return view.CanPick() && !view.is_measuring(); }, kLongWaitMs));
  EXPECT_GT(events.count(), kManyEvents);
  // Fitted to what was found: the middle of both is in the middle of the view.
  const auto middle = view.PositionOf({150.0, 0.0, 40.0});
  ASSERT_TRUE(middle);
  EXPECT_LT((*middle - QPointF(320, 240)).manhattanLength(), 120.0);
  parts[0].world_from_part.translation_mm.x() += 50.0;
  parts[0].choice = 1;
  view.Show(parts, {});
  EXPECT_TRUE(view.is_measuring());
  EXPECT_TRUE(view.Gizmo());  // its handles don't wait
  EXPECT_TRUE(QTest::qWaitFor([&] { return !view.is_measuring(); }, kLongWaitMs));
}

}  // namespace
}  // namespace elbowroom::console
