#include "app/control/samples/sample_trial.h"

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "app/control/demo_parts.h"
#include "app/control/demo_trial.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/sample_motion.h"
#include "recon/synthetic/synthetic_rig.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

core::Part PartOf(std::string name, core::TriangleMesh mesh, const core::RigidTransform& world_from_part) {
  core::Part part;
  part.name = std::move(name);
  part.mesh = std::make_shared<const core::TriangleMesh>(std::move(mesh));
  part.world_from_part = world_from_part;
  return part;
}

core::RigidTransform StandingAt(const Vector3d& position_mm) {
  return {Eigen::Matrix3d::Identity(), position_mm};
}

// As many triangles as the paper's curtain: 720, in squares of 20 mm; in the y-z plane, hung at z = 0.
core::TriangleMesh CurtainMesh() {
  constexpr std::int32_t kAcross = 20, kDown = 18;
  constexpr double kSquareMm = 20.0;
  core::TriangleMesh mesh;
  for (std::int32_t row = 0; row <= kDown; ++row)
    for (std::int32_t column = 0; column <= kAcross; ++column)
      mesh.vertices_mm.emplace_back(0.0, kSquareMm * (column - kAcross / 2), -kSquareMm * row);
  for (std::int32_t row = 0; row < kDown; ++row) {
    for (std::int32_t column = 0; column < kAcross; ++column) {
      const std::int32_t at = row * (kAcross + 1) + column, below = at + kAcross + 1;
      mesh.triangles.push_back({at, below, at + 1});
      mesh.triangles.push_back({at + 1, below, below + 1});
    }
  }
  return mesh;
}

// A window: a pane in a frame, 420 mm square, its sunk side along the part's z axis.
core::TriangleMesh WindowMesh() {
  return MeshThrough(
      std::array<ProfileRing, 4>{RectangleRing(420.0, 420.0, 0.0), RectangleRing(420.0, 420.0, 36.0),
                                 RectangleRing(350.0, 350.0, 36.0), RectangleRing(350.0, 350.0, 8.0)});
}

core::TriangleMesh BlockMesh(double size_x_mm, double size_y_mm, double height_mm) {
  return MeshThrough(std::array<ProfileRing, 2>{RectangleRing(size_x_mm, size_y_mm, 0.0),
                                                RectangleRing(size_x_mm, size_y_mm, height_mm)});
}

core::Layout WindowLayout() {
  core::Layout layout;
  const core::RigidTransform upright{
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()).toRotationMatrix(), {-130.0, 0.0, 240.0}};
  layout.parts.push_back(PartOf("window", WindowMesh(), upright));
  core::Part curtain = PartOf("curtain", CurtainMesh(), StandingAt({recon::kCurtainXMm, 0.0, 450.0}));
  core::ClothRule cloth;
  cloth.pins = {core::BoundsSide::kZMax};
  curtain.gives_way = cloth;
  layout.parts.push_back(std::move(curtain));
  layout.Validate();
  return layout;
}

core::Layout FaucetLayout() {
  core::Layout layout;
  layout.parts.push_back(PartOf("basin",
                                MeshThrough(std::array<ProfileRing, 4>{
                                    RectangleRing(320.0, 320.0, 0.0), RectangleRing(320.0, 320.0, 70.0),
                                    CircleRing(140.0, 70.0), CircleRing(110.0, 12.0)}),
                                {}));
  layout.parts.push_back(PartOf("column", BlockMesh(40.0, 40.0, 380.0), StandingAt({-190.0, 0.0, 0.0})));
  layout.parts.push_back(PartOf("arm", BlockMesh(232.0, 32.0, 28.0), StandingAt({-94.0, 0.0, 382.0})));
  layout.parts.push_back(
      PartOf("spout", MeshThrough(std::array<ProfileRing, 2>{CircleRing(11.0, 0.0), CircleRing(14.0, 40.0)}),
             StandingAt({0.0, 0.0, 340.0})));
  core::Stream water;
  water.name = "water";
  water.position_mm = {0.0, 0.0, 334.0};
  water.rate_per_s = 240.0;
  water.speed_mm_per_s = 400.0;
  water.radius_mm = 4.0;
  layout.streams.push_back(water);
  layout.Validate();
  return layout;
}

TrialSetup TrialOf(std::string task, core::Layout layout, recon::SceneAtTime hands_at) {
  TrialSetup setup;
  setup.info.participant = "simulated hands";
  setup.info.task = std::move(task);
  setup.layout = std::move(layout);
  setup.source = std::make_shared<recon::SyntheticRig>(recon::FourCameraRig(), std::move(hands_at),
                                                       recon::SyntheticRigOptions{});
  return setup;
}

}  // namespace

std::optional<Sample> ParseSample(std::string_view text) {
  for (const Sample sample : kSamples)
    if (text == ToString(sample)) return sample;
  return std::nullopt;
}

std::string_view ToString(Sample sample) {
  switch (sample) {
    case Sample::kPayload:
      return "payload";
    case Sample::kCurtain:
      return "curtain";
    case Sample::kFaucet:
      return "faucet";
  }
  return "";
}

TrialSetup MakeSampleTrial(Sample sample) {
  switch (sample) {
    case Sample::kPayload:
      break;
    case Sample::kCurtain:
      return TrialOf("push the curtain before the window aside", WindowLayout(), recon::HandsAtCurtain);
    case Sample::kFaucet:
      return TrialOf("catch the faucet's water in cupped hands", FaucetLayout(), recon::HandsAtFaucet);
  }
  return MakeDemoTrial(DemoPlay::kForever);
}

}  // namespace elbowroom::control
