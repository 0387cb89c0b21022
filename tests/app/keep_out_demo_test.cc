// The keep-out volume of the whole demo against the recorded silhouettes, by oracles that share no code with
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cad_import/mesh_file.h"
#include "core/spread.h"
#include "recon/hull/visual_hull.h"
#include "sessions/session_reader.h"
#include "tests/oracles/camera_projection.h"
#include "tests/oracles/mesh_sides.h"
#include "tests/oracles/picture_labels.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

using Eigen::Vector3d;
using recon::Random;

constexpr int kPoints = 100'000;
constexpr std::array kEdgesMm = {20.0, 10.0, 5.0};

// A frame's hull straight from its masks, under the rule that what a camera can't see is outside.
class MaskHull {
 public:
  MaskHull(core::Rig rig, const std::vector<core::SoftMask>& masks) : rig_(std::move(rig)) {
    EXPECT_EQ(rig_.unseen, core::UnseenPolicy::kOutside);
    for (const core::SoftMask& mask : masks)
      labels_.emplace_back(mask, oracles::BoundaryConvention::kMarchingSquares, false);
    for (std::size_t i = 0; i < masks.size(); ++i)
      for (int y = 0; y < masks[i].mask.height_px(); ++y)
        for (int x = 0; x < masks[i].mask.width_px(); ++x)
          if (masks[i].mask.At(x, y)) pixels_.push_back({i, {x, y}});
  }

  [[nodiscard]] bool Contains(const Vector3d& point) const {
    if (!rig_.workspace_mm.contains(point)) return false;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      const auto pixel = oracles::Project(rig_.cameras[i], point.cast<long double>());
      if (!pixel || !labels_[i].IsObject(*pixel)) return false;
    }
    return true;
  }

  // At any depth behind some object pixel; nothing if that isn't in the hull.
  [[nodiscard]] std::optional<Vector3d> PointBehindAPixel(Random* random) const {
    if (pixels_.empty()) return std::nullopt;
    const auto& [i, pixel] =
        pixels_[static_cast<std::size_t>(random->Whole(0, static_cast<int>(pixels_.size()) - 1))];
    const core::CameraModel& camera = rig_.cameras[i];
    const auto normalised = camera.NormalisedFromPixel(
        pixel + Eigen::Vector2d(random->Uniform(-0.5, 0.5), random->Uniform(-0.5, 0.5)));
    if (!normalised) return std::nullopt;
    const double depth_mm = random->Uniform(0.0, 3000.0);
    const Vector3d point = camera.cam_from_world().Inverse() *
                           Vector3d(normalised->x() * depth_mm, normalised->y() * depth_mm, depth_mm);
    return Contains(point) ? std::optional(point) : std::nullopt;
  }

 private:
  core::Rig rig_;
  std::vector<oracles::PictureLabels> labels_;
  std::vector<std::pair<std::size_t, Eigen::Vector2d>> pixels_;
};

class KeepOutDemo : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test_support::TemporaryFolder>();
    const auto run = test_support::RunProgram(test_support::ProgramFile(),
                                              {"demo", "--out", folder_->path().string(), "--headless"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    for (const double edge_mm : kEdgesMm) {
      const auto keepout = test_support::RunProgram(
          test_support::ProgramFile(),
          {"keepout", (*folder_ / "session.db").string(), "--edge", std::to_string(edge_mm), "--out",
           (*folder_ / "keep_out.ply").string(), "--json"});
      ASSERT_EQ(keepout.exit_status, 0) << keepout.err;
      reports_.push_back(nlohmann::json::parse(keepout.out));
      meshes_.push_back(*cad_import::ImportMeshFile(*folder_ / "keep_out.ply",
                                                    {.unit_if_file_has_none = core::LengthUnit::kMillimetre})
                             .mesh);
    }
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static inline std::unique_ptr<test_support::TemporaryFolder> folder_;
  static inline std::vector<nlohmann::json> reports_;
  static inline std::vector<core::TriangleMesh> meshes_;
};

TEST_F(KeepOutDemo, HoldsRandomPointsOfEveryRecordedHull) {
  const sessions::SessionReader session(*folder_ / "session.db");
  const auto frames = session.frames();
  Random random(2412);
  std::vector<Vector3d> points;
  constexpr int kPointsAFrame = 240;  // 480 frames; nothing real is in the workspace in a few of them
  int frames_with_points = 0;
  for (const auto& frame : frames) {
    const core::FrameRecord record = session.ReadFrame(frame.frame);
    const MaskHull hull(session.header().rig, *record.masks);
    const std::size_t before = points.size();
    for (int tries = 0; tries < 200 * kPointsAFrame; ++tries) {
      if (points.size() - before == static_cast<std::size_t>(kPointsAFrame)) break;
      if (const auto point = hull.PointBehindAPixel(&random)) points.push_back(*point);
    }
    frames_with_points += points.size() > before ? 1 : 0;
  }
  EXPECT_GE(points.size(), static_cast<std::size_t>(kPoints));
  EXPECT_GT(frames_with_points, 450);
  for (std::size_t i = 0; i < kEdgesMm.size(); ++i) {
    EXPECT_TRUE(core::IsWatertight(meshes_[i]));
    const oracles::MeshSides sides(meshes_[i]);
    const auto missed =
        std::ranges::count_if(points, [&](const Vector3d& point) { return !sides.Holds(point); });
    EXPECT_EQ(missed, 0) << kEdgesMm[i];
  }
}

// The distance of a vertex from the nearest hull, as its cameras bound it: the radius from which on no camera
// excludes the ball around the vertex.
double ExcessMm(const Vector3d& vertex, const std::vector<std::unique_ptr<recon::VisualHull>>& hulls,
                double most_mm) {
  double least_mm = most_mm;
  const auto is_near = [&](const recon::VisualHull& hull, double radius_mm) {
    return hull.Classify(vertex, radius_mm) != recon::BallAnswer::kOutside;
  };
  for (const auto& hull : hulls) {
    if (!is_near(*hull, least_mm - 0.05)) continue;
    double far_mm = least_mm, near_mm = 0.0;
    while (far_mm - near_mm > 0.02) {
      const double middle_mm = 0.5 * (near_mm + far_mm);
      (is_near(*hull, middle_mm) ? far_mm : near_mm) = middle_mm;
    }
    least_mm = far_mm;
  }
  return least_mm;
}

TEST_F(KeepOutDemo, ReachesBeyondTheHullsByLessThanItSays) {
  const sessions::SessionReader session(*folder_ / "session.db");
  const auto rig = std::make_shared<const core::Rig>(session.header().rig);
  std::vector<std::unique_ptr<recon::VisualHull>> hulls;
  for (const auto& frame : session.frames()) {
    const core::FrameRecord record = session.ReadFrame(frame.frame);
    hulls.push_back(std::make_unique<recon::VisualHull>(recon::MakeVisualHull(rig, *record.masks)));
    hulls.back()->Prepare();
  }
  Random random(2413);
  for (std::size_t i = 0; i < kEdgesMm.size(); ++i) {
    const double bound_mm = reports_[i]["bound_mm"];
    std::vector<double> excess_mm;
    for (int k = 0; k < 500; ++k) {
      const auto vertex =
          static_cast<std::size_t>(random.Whole(0, static_cast<int>(meshes_[i].vertices_mm.size()) - 1));
      excess_mm.push_back(ExcessMm(meshes_[i].vertices_mm[vertex], hulls, bound_mm + 1.0));
    }
    const core::Spread spread = *core::SpreadOf(excess_mm);
    EXPECT_LE(spread.max, bound_mm);
    EXPECT_LE(spread.p95, 2.0 * kEdgesMm[i]) << "half a cell in most places, a cell's diagonal at thin ends";
    RecordProperty("edge_" + std::to_string(static_cast<int>(kEdgesMm[i])),
                   "median " + std::to_string(spread.median) + " p95 " + std::to_string(spread.p95) +
                       " max " + std::to_string(spread.max) + " bound " + std::to_string(bound_mm));
  }
}

}  // namespace
}  // namespace elbowroom
