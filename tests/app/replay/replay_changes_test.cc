#include "app/control/replay/replay_changes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "app/control/demo_trial.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using ::testing::HasSubstr;

core::Layout Recorded() { return MakeDemoTrial(DemoPlay::kOnce).layout; }

core::SharedMesh Lower(const core::TriangleMesh& mesh, double by_mm) {
  auto lower = std::make_shared<core::TriangleMesh>(mesh);
  for (Eigen::Vector3d& vertex : lower->vertices_mm) vertex.z() -= by_mm;
  return lower;
}

core::SharedMesh Stretched(const core::TriangleMesh& mesh, double factor) {
  auto stretched = std::make_shared<core::TriangleMesh>(mesh);
  for (Eigen::Vector3d& vertex : stretched->vertices_mm) vertex *= factor;
  return stretched;
}

TEST(ReplayLayout, TheRecordedOneIsNoChange) {
  ReplayChanges changes;
  changes.layout = Recorded();
  for (core::Part& part : changes.layout->parts)
    part.mesh = std::make_shared<core::TriangleMesh>(*part.mesh);  // read again from its file
  const ReplayLayout replay(Recorded(), changes);
  EXPECT_TRUE(replay.changes().empty());
  const std::vector<double> spacing_mm = Recorded().InitialSpacings();
  EXPECT_EQ(replay.SpacingsFrom(spacing_mm), spacing_mm);
}

TEST(ReplayLayout, ARevisedPartStaysWhereItStood) {
  const core::Layout recorded = Recorded();
  const core::Spacing& spacing = recorded.spacings[0];
  const auto part = recorded.PartsNamed(spacing.moving).front();
  ReplayChanges changes;
  changes.parts = {{recorded.parts[part].name, "new.step", Lower(*recorded.parts[part].mesh, 12.5)}};
  const ReplayLayout replay(recorded, changes);
  ASSERT_EQ(replay.changes().size(), 2U);
  EXPECT_THAT(replay.changes()[0], HasSubstr("'new.step'"));
  std::vector<double> spacing_mm = recorded.InitialSpacings();
  spacing_mm[0] = 0.5 * (spacing.min_mm + spacing.max_mm);
  const auto before = core::PosesAt(recorded, spacing_mm);
  const auto now = core::PosesAt(replay.layout(), replay.SpacingsFrom(spacing_mm));
  for (core::PartIndex i = 0; i < before.size(); ++i)
    EXPECT_LT((before[i].translation_mm - now[i].translation_mm).norm(), 1e-9);
  EXPECT_FALSE(replay.RecordedOf(part)->has_same_mesh);
}

TEST(ReplayLayout, NamesWhatItDoesNotHave) {
  const auto told = [&](const ReplayChanges& changes) {
    try {
      const ReplayLayout replay(Recorded(), changes);
    } catch (const core::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const core::Spacing spacing = Recorded().spacings[0];
  EXPECT_THAT(told({.held_mm = {{spacing.name + "x", 140.0}}}), HasSubstr("did you mean '" + spacing.name));
  EXPECT_THAT(told({.held_mm = {{spacing.name, spacing.max_mm + 1.0}}}), HasSubstr("its limits are"));
  ReplayChanges changes;
  changes.parts = {{"nobody's part", "x.stl", Recorded().parts[0].mesh}};
  EXPECT_THAT(told(changes), HasSubstr("no part is named 'nobody's part'"));
}

TEST(ReplayLayout, TellsWhatAnotherLayoutChanges) {
  ReplayChanges changes;
  changes.layout = Recorded();
  changes.layout->parts[0].world_from_part.translation_mm.x() += 3.0;
  changes.layout->parts[1].mesh = Stretched(*changes.layout->parts[1].mesh, 1.01);
  const ReplayLayout replay(Recorded(), changes);
  ASSERT_EQ(replay.changes().size(), 2U);
  EXPECT_THAT(replay.changes()[0], HasSubstr("moved by (3.00, 0.00, 0.00) mm"));
  EXPECT_THAT(replay.changes()[1], HasSubstr("another shape"));
}

}  // namespace
}  // namespace elbowroom::control
