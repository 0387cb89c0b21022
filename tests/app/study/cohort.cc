#include "tests/app/study/cohort.h"

#include <algorithm>
#include <memory>

#include "app/control/frame_pipeline.h"
#include "app/control/outcome_tracker.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "sessions/session_writer.h"
#include "tests/core/solids.h"

namespace elbowroom::tests {
namespace {

constexpr double kFloorMm = 20.0;  // its top, in world
constexpr double kLidMm = 250.0, kWidthMm = 240.0;
constexpr double kHandRadiusMm = 30.0, kToolRadiusMm = 6.0;
const Eigen::Vector2d kAt(10.0, -5.0);  // of the reach, in world
constexpr core::FrameIndex kFrames = 6, kFirstWithTool = 3;

core::Part Plate(const char* name, double bottom_mm) {
  core::Part part;
  part.name = name;
  part.mesh = std::make_shared<const core::TriangleMesh>(core::testing::Box({kWidthMm, kWidthMm, kFloorMm}));
  part.world_from_part.translation_mm = {-0.5 * kWidthMm, -0.5 * kWidthMm, bottom_mm};
  return part;
}

core::Layout LidAboveFloor() {
  core::Layout layout;
  layout.parts = {Plate("floor", 0.0), Plate("lid", kFloorMm + kLidMm)};
  layout.spacings = {{"lid_gap", "lid", "floor", core::Axis::kZ, 20.0, 300.0, kLidMm}};
  return layout;
}

recon::Solid At(const decltype(recon::Solid::shape)& shape, double z_mm) {
  recon::Solid solid;
  solid.shape = shape;
  solid.world_from_solid.translation_mm = {kAt.x(), kAt.y(), z_mm};
  return solid;
}

// The last frame without a tool, and the last one with it, are the highest.
std::vector<recon::SyntheticObject> ObjectsAt(const Reach& reach, core::FrameIndex frame) {
  const bool with_tool = reach.tool_mm > 0.0 && frame >= kFirstWithTool;
  const double below_mm = 5.0 * static_cast<double>((with_tool ? kFrames : kFirstWithTool) - 1 - frame);
  const double top_mm = kFloorMm + reach.hand_mm - std::abs(below_mm);
  recon::SyntheticObject hand{"hand", {At(recon::Sphere{kHandRadiusMm}, top_mm - kHandRadiusMm)}};
  if (with_tool) {
    const double tip_mm = kFloorMm + reach.tool_mm - below_mm, foot_mm = kFloorMm + kToolRadiusMm + 5.0;
    hand.solids.push_back(At(recon::Capsule{kToolRadiusMm, tip_mm - kToolRadiusMm - foot_mm}, foot_mm));
  }
  return {hand};
}

// Downwards from the lid along a grid of verticals around the reach.
double HighestMm(const recon::VisualHull& hull) {
  constexpr double kGridMm = 2.5, kReachMm = 20.0, kStepMm = 0.25;
  double highest_mm = kFloorMm;
  for (double x = -kReachMm; x <= kReachMm; x += kGridMm)
    for (double y = -kReachMm; y <= kReachMm; y += kGridMm)
      for (double z = kFloorMm + kLidMm; z > highest_mm; z -= kStepMm)
        if (hull.Contains({kAt.x() + x, kAt.y() + y, z})) highest_mm = z;
  return highest_mm - kFloorMm;
}

// Its score is 9.54 times what the answer is worth.
core::Questionnaire Sickness() {
  core::QuestionnaireItem nausea{"nausea", "Nausea", core::ItemKind::kChoice, 0.0, 3.0};
  nausea.choices = {"none", "slight", "moderate", "severe"};
  nausea.values = {0.0, 1.0, 2.0, 3.0};
  return {
      core::AskedWhen::kAfter, "sickness", {nausea}, {{"total", core::ScoreRule::kSum, {{"nausea"}}, 9.54}}};
}

}  // namespace

Seen SeenOf(const Reach& reach) {
  const core::Rig rig = recon::EightCameraRig();
  const recon::SyntheticRig source(rig, [](double) { return std::vector<recon::SyntheticObject>(); });
  const auto shared = std::make_shared<const core::Rig>(rig);
  const auto highest_mm = [&](core::FrameIndex frame) {
    return HighestMm(recon::MakeVisualHull(shared, source.TrueMasks(ObjectsAt(reach, frame))));
  };
  const double hand_mm = highest_mm(kFirstWithTool - 1);
  return {hand_mm, std::max(hand_mm, highest_mm(kFrames - 1))};
}

void RecordReach(const std::filesystem::path& path, const Reach& reach) {
  const core::Rig rig = recon::EightCameraRig();
  const recon::SyntheticRig source(rig, [](double) { return std::vector<recon::SyntheticObject>(); });
  core::SessionHeader header;
  header.rig = rig;
  header.layout = LidAboveFloor();
  header.started_at_utc = "2027-03-01T09:00:00.000Z";
  header.trial.participant = reach.participant;
  header.trial.condition = reach.condition;
  header.trial.order = reach.order;
  header.trial.estimate_mm = reach.estimate_before_mm;
  header.trial.tools = {"tongs"};
  header.trial.steps = {"reach in"};
  header.trial.block = reach.block;
  if (reach.sickness >= 0) header.trial.questionnaires = {Sickness()};
  header.trial.survey = {{core::AskedWhen::kAfter, "presence", 1, 7}};
  control::FramePipeline pipeline(rig, header.layout,
                                  std::vector<recon::BackgroundReference>(rig.cameras.size()), {});
  sessions::SessionWriter writer(path, header);
  control::OutcomeTracker tracker(header.trial, pipeline.part_trees());
  for (core::FrameIndex frame = 0; frame < kFrames; ++frame) {
    recon::FrameSet frames;
    frames.index = frame;
    frames.time_s = 0.2 * static_cast<double>(frame);
    for (core::BitMask& mask : source.TrueMasks(ObjectsAt(reach, frame)))
      frames.cameras.push_back({{}, std::move(mask)});
    const double time_s = frames.time_s;
    if (frame == 0) writer.Append(core::SessionEvent{0, 0.0, core::StepMarked{"reach in", true}});
    if (reach.tool_mm > 0.0 && frame == kFirstWithTool)
      writer.Append(core::SessionEvent{frame, time_s, core::ToolMarked{"tongs", true}});
    const auto result = pipeline.Process(std::move(frames), std::vector{reach.lid_mm});
    tracker.Add(*result, {});
    writer.Append(result->record);
  }
  const double end_s = 0.2 * static_cast<double>(kFrames - 1);
  writer.Append(
      core::SessionEvent{kFrames - 1, std::min(reach.step_s, end_s), core::StepMarked{"reach in", false}});
  if (reach.estimate_after_mm > 0.0)
    writer.Append(core::SessionEvent{kFrames - 1, end_s,
                                     core::EstimateGiven{core::AskedWhen::kAfter, reach.estimate_after_mm}});
  if (reach.presence > 0)
    writer.Append(core::SessionEvent{
        kFrames - 1, end_s, core::SurveyAnswered{core::AskedWhen::kAfter, "presence", reach.presence}});
  if (reach.sickness >= 0)
    writer.Append(
        core::SessionEvent{kFrames - 1, end_s,
                           core::QuestionnaireAnswered{
                               core::AskedWhen::kAfter, "sickness", "nausea",
                               Sickness().items[0].choices.at(static_cast<std::size_t>(reach.sickness))}});
  writer.Finish(tracker.Outcome());
}

}  // namespace elbowroom::tests
