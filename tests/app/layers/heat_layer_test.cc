// The heat layer is the heat maps, patch by patch; only what changed is made anew, and nothing for nobody.
#include "app/control/layers/heat_layer.h"

#include <gtest/gtest.h>

#include <array>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/layers/color_scale.h"
#include "app/control/layers/heat_watch.h"
#include "app/control/trial_runner.h"
#include "core/error.h"
#include "core/surface_patches.h"
#include "sessions/session_reader.h"
#include "tests/app/overlay/overlay_samples.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

core::SharedMesh Shared(core::TriangleMesh mesh) {
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

core::HeatMap MapWith(core::PartIndex part, const core::SharedMesh& mesh,
                      const std::map<std::size_t, float>& dwell_s) {
  const core::SurfacePatches patches(mesh, core::kHeatPatchMm);
  core::HeatMap map;
  map.part = part;
  map.dwell_s.assign(patches.size(), 0.0F);
  map.peak_depth_mm.assign(patches.size(), 0.0F);
  for (const auto& [patch, seconds] : dwell_s) map.dwell_s[patch] = seconds;
  return map;
}

using PlaceKey = std::array<double, 3>;

// The shade of each patch that the layer shows, by the patch's middle.
std::map<PlaceKey, int> ShadesOf(const PartHeat& heat) {
  std::map<PlaceKey, int> shades;
  for (const HeatPiece& piece : heat.pieces) {
    for (const auto& [a, b, c] : piece.mesh->triangles) {
      const auto at = [&](std::int32_t i) { return piece.mesh->vertices_mm[static_cast<std::size_t>(i)]; };
      const Vector3d middle = (at(a) + at(b) + at(c)) / 3.0;
      EXPECT_TRUE(shades.emplace(PlaceKey{middle.x(), middle.y(), middle.z()}, piece.shade).second)
          << "a patch is shown twice";
    }
  }
  return shades;
}

// The slow way: every patch of every triangle.
std::map<PlaceKey, int> ShadesOf(const core::SharedMesh& mesh, const core::HeatMap& map, double most_s) {
  const core::SurfacePatches patches(mesh, map.patch_mm);
  std::map<PlaceKey, int> shades;
  for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
    std::size_t patch = patches.FirstOf(t);
    for (const core::SurfacePatches::Corners& corners : patches.CornersOf(t)) {
      const double share = static_cast<double>(map.dwell_s[patch++]) / most_s;
      const Vector3d middle = corners.Centre();
      for (int shade = 1; shade <= kHeatShades; ++shade)
        if (share > (shade - 1.0) / kHeatShades && share <= static_cast<double>(shade) / kHeatShades + 1e-9)
          shades[{middle.x(), middle.y(), middle.z()}] = shade;
    }
  }
  return shades;
}

TEST(RoundedUp, EndsAScaleAtARoundNumber) {
  EXPECT_EQ(RoundedUp(0.0), 0.0);
  EXPECT_DOUBLE_EQ(RoundedUp(0.011), 0.02);
  EXPECT_DOUBLE_EQ(RoundedUp(2.0), 2.0);
  EXPECT_DOUBLE_EQ(RoundedUp(2.1), 5.0);
  EXPECT_DOUBLE_EQ(RoundedUp(51.0), 100.0);
  EXPECT_THROW((void)RoundedUp(-1.0), core::PreconditionError);
}

TEST(HeatLayer, ShowsEachTouchedPatchOnceInItsShade) {
  recon::Random random(2510);
  const std::vector<core::SharedMesh> meshes = {Shared(BoxMesh({100, 60, 40})), Shared(BallMesh(50.0, 24)),
                                                Shared(TubeMesh({40.0, 25.0, 120.0}, 60))};
  for (int trial = 0; trial < 6; ++trial) {
    HeatLayerMaker maker(meshes);
    std::vector<core::HeatMap> maps;
    for (core::PartIndex i = 0; i < meshes.size(); ++i) {
      const std::size_t count = core::SurfacePatches(meshes[i], core::kHeatPatchMm).size();
      std::map<std::size_t, float> dwell_s;
      for (std::size_t patch = 0; patch < count; ++patch)
        if (random.Chance(0.2)) dwell_s[patch] = static_cast<float>(random.LogUniform(1e-3, 8.0));
      maps.push_back(MapWith(i, meshes[i], dwell_s));
      maker.Take(maps.back());
    }
    const SharedHeatLayer layer = maker.Make();
    ASSERT_EQ(layer->parts.size(), meshes.size());
    for (core::PartIndex i = 0; i < meshes.size(); ++i) {
      const auto expected = ShadesOf(meshes[i], maps[i], layer->most_s);
      EXPECT_FALSE(expected.empty());
      EXPECT_EQ(ShadesOf(*layer->parts[i]), expected);
    }
  }
}

TEST(HeatLayer, KeepsWhatDidNotChange) {
  const std::vector<core::SharedMesh> meshes = {Shared(BoxMesh({100, 60, 40})),
                                                Shared(BoxMesh({50, 60, 40}))};
  HeatLayerMaker maker(meshes);
  EXPECT_TRUE(maker.Make()->parts.empty());
  EXPECT_EQ(maker.Make()->most_s, 0.0);
  maker.Take(MapWith(0, meshes[0], {{3, 5.0F}, {7, 1.0F}}));
  maker.Take(MapWith(1, meshes[1], {{2, 4.0F}}));
  const SharedHeatLayer first = maker.Make();
  EXPECT_EQ(first->most_s, 5.0);
  EXPECT_EQ(maker.pieces_made(), 3);
  EXPECT_EQ(maker.Make()->parts, first->parts);  // nothing new

  maker.Take(MapWith(0, meshes[0], {{3, 5.0F}, {7, 1.01F}}));  // in the same shade
  EXPECT_EQ(maker.Make()->parts, first->parts);
  maker.Take(MapWith(0, meshes[0], {{3, 5.0F}, {7, 2.0F}}));
  const SharedHeatLayer second = maker.Make();
  EXPECT_EQ(second->parts[1], first->parts[1]);
  EXPECT_NE(second->parts[0], first->parts[0]);
  EXPECT_EQ(second->parts[0]->pieces.back().mesh, first->parts[0]->pieces.back().mesh);  // that of patch 3
  EXPECT_EQ(maker.pieces_made(), 4);

  maker.Take(MapWith(0, meshes[0], {{3, 6.0F}, {7, 2.0F}}));  // another scale: 10 s
  EXPECT_EQ(maker.Make()->most_s, 10.0);
  EXPECT_NE(maker.Make()->parts[1]->pieces.front().shade, first->parts[1]->pieces.front().shade);
}

TEST(HeatLayer, RefusesTheMapOfAnotherMesh) {
  const core::SharedMesh mesh = Shared(BoxMesh({100, 60, 40}));
  HeatLayerMaker maker({mesh});
  EXPECT_THROW(maker.Take(MapWith(1, mesh, {})), core::PreconditionError);
  EXPECT_THROW(maker.Take(MapWith(0, Shared(BoxMesh({30, 60, 40})), {})), core::PreconditionError);
}

// What a watch hands on, for a test to wait for.
class Layers {
 public:
  void Add(const SharedHeatLayer& layer) {
    const std::lock_guard lock(mutex_);
    layers_.push_back(layer);
    changed_.notify_all();
  }
  SharedHeatLayer Await(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return layers_.size() >= count; });
    return layers_.back();
  }
  std::size_t count() {
    const std::lock_guard lock(mutex_);
    return layers_.size();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<SharedHeatLayer> layers_;
};

TEST(HeatWatch, TakesMapsForSomebodyAndNoMoreOftenThanItSays) {
  const core::SharedMesh mesh = Shared(BoxMesh({100, 60, 40}));
  Layers layers;
  HeatWatch::Clock::time_point now;
  HeatWatch watch(
      {mesh}, [&](const SharedHeatLayer& layer) { layers.Add(layer); }, [&] { return now; });
  EXPECT_FALSE(watch.TakesMaps());
  watch.Put({MapWith(0, mesh, {{3, 1.0F}})});  // out of turn: kept
  watch.Want(true);
  const SharedHeatLayer first = layers.Await(1);
  EXPECT_EQ(first->most_s, 1.0);
  EXPECT_TRUE(watch.TakesMaps());
  now += HeatWatch::kApart - std::chrono::milliseconds(1);
  EXPECT_FALSE(watch.TakesMaps());
  now += std::chrono::milliseconds(1);
  EXPECT_TRUE(watch.TakesMaps());
  watch.Put({MapWith(0, mesh, {{3, 2.0F}})});
  EXPECT_EQ(layers.Await(2)->most_s, 2.0);
  watch.Want(false);
  now += 2 * HeatWatch::kApart;
  EXPECT_FALSE(watch.TakesMaps());
  watch.Want(true);  // the same again, for who looks again
  EXPECT_EQ(layers.Await(3)->parts, layers.Await(2)->parts);
}

TEST(HeatWatch, OfATrialEndsWithTheSessionsHeatMaps) {
  const test_support::TemporaryFolder folder;
  const TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  std::vector<core::SharedMesh> meshes;
  for (const core::Part& part : setup.layout.parts) meshes.push_back(part.mesh);
  Layers layers, unseen;
  HeatWatch watch(meshes, [&](const SharedHeatLayer& layer) { layers.Add(layer); });
  HeatWatch nobody(meshes, [&](const SharedHeatLayer& layer) { unseen.Add(layer); });
  watch.Want(true);
  TrialOptions options;
  options.frames = {40, 110};
  for (HeatWatch* heat : {&watch, &nobody}) {
    options.session = folder / (heat == &watch ? "watched.db" : "unwatched.db");
    options.heat = heat;
    TrialControls controls;
    (void)RunTrial(setup, options, controls, {});
  }
  EXPECT_EQ(unseen.count(), 0U);
  const std::vector<core::HeatMap> maps = sessions::SessionReader(folder / "watched.db").heat_maps();
  ASSERT_FALSE(maps.empty());
  HeatLayerMaker maker(meshes);
  for (const core::HeatMap& map : maps) maker.Take(map);
  const SharedHeatLayer of_session = maker.Make();
  nobody.Want(true);  // after the end
  const SharedHeatLayer after_end = unseen.Await(1);
  // One may be in the making; the next one after that has all that the trial handed over.
  const auto ask_again = [&] {
    const std::size_t before = layers.count();
    watch.Want(true);
    return layers.Await(before + 1);
  };
  (void)ask_again();
  const SharedHeatLayer last = ask_again();
  for (const SharedHeatLayer& live : {last, after_end}) {
    EXPECT_EQ(live->most_s, of_session->most_s);
    ASSERT_EQ(live->parts.size(), of_session->parts.size());
    for (std::size_t i = 0; i < live->parts.size(); ++i) {
      EXPECT_EQ(live->parts[i]->part, of_session->parts[i]->part);
      EXPECT_EQ(ShadesOf(*live->parts[i]), ShadesOf(*of_session->parts[i]));
    }
  }
}

}  // namespace
}  // namespace elbowroom::control
