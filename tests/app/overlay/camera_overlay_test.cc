// The overlay in the synthetic rig's pictures: edges against analytic projections, occlusion against truth.
#include "app/control/overlay/camera_overlay.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "app/control/demo_parts.h"
#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "core/error.h"
#include "recon/hull/ray_crossings.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/app/overlay/overlay_samples.h"
#include "tests/oracles/camera_projection.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Points in pixels, found by their cell.
class PointGrid {
 public:
  PointGrid(int width_px, int height_px) : across_(width_px + 2 * kMargin), down_(height_px + 2 * kMargin) {
    cells_.resize(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_));
  }
  void Add(const Vector2d& x) {
    const int i = Cell(x.x()), j = Cell(x.y());
    if (i >= 0 && j >= 0 && i < across_ && j < down_) cells_[At(i, j)].push_back(x);
  }
  // Infinite if none is within two pixels or so.
  [[nodiscard]] double Nearest(const Vector2d& x) const {
    double least = std::numeric_limits<double>::infinity();
    for (int j = std::max(0, Cell(x.y()) - 2); j <= std::min(down_ - 1, Cell(x.y()) + 2); ++j)
      for (int i = std::max(0, Cell(x.x()) - 2); i <= std::min(across_ - 1, Cell(x.x()) + 2); ++i)
        for (const Vector2d& other : cells_[At(i, j)]) least = std::min(least, (other - x).norm());
    return least;
  }

 private:
  static constexpr int kMargin = 4;
  [[nodiscard]] static int Cell(double x) { return static_cast<int>(std::floor(x)) + kMargin; }
  [[nodiscard]] std::size_t At(int i, int j) const { return static_cast<std::size_t>(j * across_ + i); }
  int across_, down_;
  std::vector<std::vector<Vector2d>> cells_;
};

bool IsInPicture(const core::CameraModel& camera, const Vector2d& x, double margin_px) {
  return x.x() >= margin_px && x.y() >= margin_px && x.x() <= camera.width_px() - 1 - margin_px &&
         x.y() <= camera.height_px() - 1 - margin_px;
}

struct EdgeErrors {
  double drawn_px = 0.0;    // the farthest that a drawn point is from the analytic edges
  double missing_px = 0.0;  // the farthest that a visible analytic edge is from what is drawn
  int drawn = 0, visible = 0;
};

// Edges finer than a tenth of a pixel apart.
double ApartMm(const core::CameraModel& camera, const recon::Solid& solid) {
  const double far_mm = (solid.world_from_solid.translation_mm - camera.center_in_world()).norm();
  return std::max(0.05, 0.1 * far_mm / camera.calibration().camera_matrix(0, 0));
}

OutlinedMeshes& Meshes() {
  static OutlinedMeshes meshes;
  return meshes;
}

EdgeErrors EdgeErrorsOf(const core::CameraModel& camera, const SolidPart& part) {
  CameraOverlay overlay(camera, camera.width_px(), camera.height_px());
  const std::array parts{OverlayPart{Meshes().Of(part.mesh), part.solid.world_from_solid}};
  overlay.Place(parts);
  PointGrid analytic(camera.width_px(), camera.height_px()), drawn(camera.width_px(), camera.height_px());
  for (const OverlayLine& line : overlay.layer().lines) {
    for (const double s : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0})
      drawn.Add(line.piece.from_px + s * (line.piece.to_px - line.piece.from_px));
  }
  const Vector3d& eye = camera.center_in_world();
  EdgeErrors errors;
  std::vector<Vector2d> sure;  // surely seen: not within a few samples of where visibility changes
  for (const SolidEdge& edge : EdgesOf(part.solid, eye, ApartMm(camera, part.solid))) {
    std::vector<Vector2d> run;
    const auto end_run = [&] {
      constexpr std::size_t kEnds = 25;
      if (run.size() > 2 * kEnds) sure.insert(sure.end(), run.begin() + kEnds, run.end() - kEnds);
      run.clear();
    };
    for (const Vector3d& x : edge.points_in_world) {
      const auto pixel = oracles::Project(camera, x.cast<long double>());
      if (!pixel) {
        end_run();
        continue;
      }
      analytic.Add(pixel->cast<double>());
      const double far_mm = (x - eye).norm();
      const auto hit = recon::FirstHit(part.solid, {eye, (x - eye) / far_mm});
      // Grazing rays may or may not meet the solid at the point itself.
      const bool is_seen = !hit || hit->distance_mm > far_mm * (1.0 - 1e-7) - 1e-6;
      if (is_seen && IsInPicture(camera, pixel->cast<double>(), 3.0)) {
        run.push_back(pixel->cast<double>());
      } else {
        end_run();
      }
    }
    end_run();
  }
  for (const OverlayLine& line : overlay.layer().lines) {
    if (!IsInPicture(camera, line.piece.from_px, 0.0)) continue;
    ++errors.drawn;
    errors.drawn_px = std::max(errors.drawn_px, analytic.Nearest(line.piece.from_px));
  }
  for (const Vector2d& x : sure) {
    ++errors.visible;
    errors.missing_px = std::max(errors.missing_px, drawn.Nearest(x));
  }
  return errors;
}

TEST(CameraOverlay, DrawsEveryKindOfPartWithinHalfAPixelOfItsAnalyticProjection) {
  for (const NamedRig& named : RigsOfEveryLens()) {
    for (const core::CameraModel& camera : named.rig.cameras) {
      for (const SolidPart& part : PartsOfEveryKind(camera)) {
        const EdgeErrors errors = EdgeErrorsOf(camera, part);
        std::printf("%-13s %-9s %-7s drawn %6d off %.4f px; analytic %6d missing %.4f px\n",
                    named.name.c_str(), camera.name().c_str(), part.name.c_str(), errors.drawn,
                    errors.drawn_px, errors.visible, errors.missing_px);
        EXPECT_LE(errors.drawn_px, 0.5) << named.name << ' ' << camera.name() << ' ' << part.name;
        EXPECT_LE(errors.missing_px, 0.5) << named.name << ' ' << camera.name() << ' ' << part.name;
      }
    }
  }
}

// A part that stands where a real thing of the same shape stands covers the same pixels of its picture.
TEST(CameraOverlay, CoversThePixelsThatARealThingOfTheSameShapeHasInTheSyntheticPicture) {
  for (const NamedRig& named : RigsOfEveryLens()) {
    if (named.name == "lenses") continue;  // the synthetic rig wants a ray for each pixel
    for (const core::CameraModel& camera : named.rig.cameras) {
      const std::vector<SolidPart> parts = PartsOfEveryKind(camera);
      core::Rig alone = named.rig;
      alone.cameras = {camera};
      const recon::SyntheticRig rig(alone, [](double) { return std::vector<recon::SyntheticObject>(); });
      for (const std::size_t i : {0U, 1U, 2U, 4U}) {
        const std::array objects{recon::SyntheticObject{"it", {parts[i].solid}}};
        const core::BitMask truth = rig.TrueMasks(objects).front();
        CameraOverlay overlay(camera, camera.width_px(), camera.height_px());
        const std::array placed{OverlayPart{Meshes().Of(parts[i].mesh), parts[i].solid.world_from_solid}};
        overlay.Place(placed);
        int differ = 0;
        for (int y = 0; y < camera.height_px(); ++y)
          for (int x = 0; x < camera.width_px(); ++x)
            differ += (overlay.layer().face_depth_mm[overlay.layer().At(x, y)] > 0.0F) != truth.At(x, y);
        // Where a centre is nearer to the outline than rays in single precision, or than facets of a round
        // part, it may go either way.
        EXPECT_LE(differ, 3) << named.name << ' ' << camera.name() << ' ' << parts[i].name;
      }
    }
  }
}

struct Tally {
  long long pixels = 0, right = 0;
  void Add(bool is_right) { ++pixels, right += is_right ? 1 : 0; }
  [[nodiscard]] double Share() const {
    return pixels == 0 ? 1.0 : static_cast<double>(right) / static_cast<double>(pixels);
  }
};

struct OcclusionTally {
  Tally of_part;    // pixels that a part covers
  Tally contested;  // of these, where something real is in the pixel, too
  Tally of_hull;    // contested, against the hull itself instead of the real surfaces
};

// 2 px away from where the truth changes.
bool IsAwayFromBorders(const std::vector<int>& truth, int width_px, int height_px, int x, int y) {
  constexpr int kAwayPx = 2;
  if (x < kAwayPx || y < kAwayPx || x >= width_px - kAwayPx || y >= height_px - kAwayPx) return false;
  const int here = truth[static_cast<std::size_t>(y * width_px + x)];
  for (int j = -kAwayPx; j <= kAwayPx; ++j)
    for (int i = -kAwayPx; i <= kAwayPx; ++i)
      if (truth[static_cast<std::size_t>((y + j) * width_px + x + i)] != here) return false;
  return true;
}

enum Truth { kNeither = 0, kPartAlone = 1, kRealBehind = 2, kRealBefore = 3, kRealAlone = 4 };

void CompareOcclusion(const core::CameraModel& camera, const std::vector<recon::Solid>& solids,
                      std::span<const OverlayPart> parts,
                      const std::shared_ptr<const recon::VisualHull>& hull, const core::BitMask& real,
                      OcclusionTally* tally) {
  CameraOverlay overlay(camera, camera.width_px(), camera.height_px(), {1.5, 1.0});
  overlay.Place(parts);
  const int width = camera.width_px(), height = camera.height_px();
  recon::Image picture{width, height, {}};
  picture.rgb.assign(static_cast<std::size_t>(3 * width * height), 0);
  overlay.PaintOn(&picture, hull);
  const OverlayLayer& layer = overlay.layer();
  std::vector<int> truth(static_cast<std::size_t>(width * height));
  std::vector<char> by_hull(truth.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t at = layer.At(x, y);
      const Vector3d d = overlay.view().rays().At(x, y).homogeneous();
      const recon::Ray ray{camera.center_in_world(),
                           (camera.cam_from_world().rotation.transpose() * d).normalized()};
      double real_mm = std::numeric_limits<double>::infinity();
      for (const recon::Solid& solid : real.At(x, y) ? solids : std::vector<recon::Solid>())
        if (const auto hit = recon::FirstHit(solid, ray))
          real_mm = std::min(real_mm, hit->distance_mm / d.norm());
      const float part_mm = layer.face_depth_mm[at];
      if (part_mm <= 0.0F) {
        truth[at] = std::isinf(real_mm) ? kNeither : kRealAlone;
      } else if (std::isinf(real_mm)) {
        truth[at] = kPartAlone;
      } else {
        truth[at] = real_mm < part_mm ? kRealBefore : kRealBehind;
        const auto first = recon::FirstInside(*hull, ray);
        by_hull[at] = first && *first / d.norm() < part_mm * (1.0 - 1e-5);
      }
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t at = layer.At(x, y);
      if (layer.face_depth_mm[at] <= 0.0F || !IsAwayFromBorders(truth, width, height, x, y)) continue;
      const bool is_painted = picture.rgb[3 * at] + picture.rgb[3 * at + 1] + picture.rgb[3 * at + 2] > 0;
      tally->of_part.Add(is_painted == (truth[at] != kRealBefore));
      if (truth[at] == kPartAlone) continue;
      tally->contested.Add(is_painted == (truth[at] != kRealBefore));
      tally->of_hull.Add(is_painted == (by_hull[at] == 0));
    }
  }
}

TEST(CameraOverlay, IsHiddenByWhatIsRealBeforeItAtNinetyNinePixelsOfAHundred) {
  const core::Layout layout = DemoLayout();
  for (NamedRig& named : RigsOfEveryLens()) {
    if (named.name == "lenses") continue;
    const auto rig = std::make_shared<const core::Rig>(named.rig);
    recon::SyntheticRig synthetic(named.rig, [](double) { return std::vector<recon::SyntheticObject>(); });
    OcclusionTally tally;
    // Those of 1280 x 720 have as many pixels in one frame as the others in nine.
    const std::vector<double> times_s =
        named.name == "eight_modern" ? std::vector{4.4} : std::vector{1.5, 3.0, 4.4, 7.5, 9.0, 11.0, 12.5};
    for (const double time_s : times_s) {
      const std::vector<recon::SyntheticObject> objects = recon::DemoSceneAt(time_s).objects;
      const std::vector<core::BitMask> masks = synthetic.TrueMasks(objects);
      const auto hull = std::make_shared<const recon::VisualHull>(recon::MakeVisualHull(rig, masks));
      const std::vector<recon::Solid> solids = recon::AllSolids(objects);
      for (const double gap_mm : {140.0, 240.0}) {
        const std::array spacing{gap_mm};
        const std::vector<core::RigidTransform> places = core::PosesAt(layout, spacing);
        std::vector<OverlayPart> parts;
        for (std::size_t i = 0; i < layout.parts.size(); ++i)
          parts.push_back({Meshes().Of(layout.parts[i].mesh), places[i]});
        for (std::size_t i = 0; i < masks.size(); ++i)
          CompareOcclusion(named.rig.cameras[i], solids, parts, hull, masks[i], &tally);
      }
    }
    std::printf(
        "%-13s part pixels %8lld right %.3f %%; contested %7lld right %.3f %%; against the hull %.3f %%\n",
        named.name.c_str(), tally.of_part.pixels, 100.0 * tally.of_part.Share(), tally.contested.pixels,
        100.0 * tally.contested.Share(), 100.0 * tally.of_hull.Share());
    EXPECT_GE(tally.of_part.Share(), 0.99) << named.name;
    EXPECT_GE(tally.of_hull.Share(), 0.999) << named.name;
    EXPECT_GT(tally.contested.pixels, 10'000) << named.name;
  }
}

// The same with silhouettes that are segmented from the simulated pictures, with their noise and flicker.
TEST(CameraOverlay, IsHiddenAsWellByWhatIsSegmentedFromThePictures) {
  TrialSetup setup = MakeDemoTrial(DemoPlay::kOnce);
  const core::Rig& rig = setup.source->rig();
  FramePipeline pipeline(rig, setup.layout, setup.source->ReadBackgrounds({}, {}), setup.segmentation);
  const recon::SyntheticRig synthetic(rig, [](double) { return std::vector<recon::SyntheticObject>(); });
  OcclusionTally tally;
  for (const core::FrameIndex frame : {45, 66, 165}) {
    const SharedFrameResult result = pipeline.Process(setup.source->Read(frame), std::vector<double>{140.0});
    const std::vector<recon::SyntheticObject> objects =
        recon::DemoSceneAt(static_cast<double>(frame) / 15.0).objects;
    const std::vector<core::BitMask> masks = synthetic.TrueMasks(objects);
    const std::vector<recon::Solid> solids = recon::AllSolids(objects);
    std::vector<OverlayPart> parts;
    for (std::size_t i = 0; i < setup.layout.parts.size(); ++i)
      parts.push_back({Meshes().Of(setup.layout.parts[i].mesh), result->world_from_parts[i]});
    for (std::size_t i = 0; i < masks.size(); ++i)
      CompareOcclusion(rig.cameras[i], solids, parts, result->hull, masks[i], &tally);
  }
  std::printf("segmented: part pixels %lld right %.3f %%; contested %lld right %.3f %%\n",
              tally.of_part.pixels, 100.0 * tally.of_part.Share(), tally.contested.pixels,
              100.0 * tally.contested.Share());
  EXPECT_GE(tally.of_part.Share(), 0.99);
  EXPECT_GT(tally.contested.pixels, 3'000);
}

TEST(CameraOverlay, DrawsAgainOnlyWhatHasChanged) {
  const auto rig = std::make_shared<const core::Rig>(recon::FourCameraRig());
  recon::SyntheticRig synthetic(*rig, [](double) { return std::vector<recon::SyntheticObject>(); });
  const auto hull = std::make_shared<const recon::VisualHull>(
      recon::MakeVisualHull(rig, synthetic.TrueMasks(recon::DemoSceneAt(4.4).objects)));
  OutlinedMeshes meshes;
  const core::Layout layout = DemoLayout();
  const auto parts_at = [&](double gap_mm) {
    const std::array spacing{gap_mm};
    const std::vector<core::RigidTransform> places = core::PosesAt(layout, spacing);
    std::vector<OverlayPart> parts;
    for (std::size_t i = 0; i < layout.parts.size(); ++i)
      parts.push_back({meshes.Of(layout.parts[i].mesh), places[i]});
    return parts;
  };
  CameraOverlay overlay(rig->cameras[0], 160, 120), fresh(rig->cameras[0], 160, 120);
  recon::Image picture{160, 120, std::vector<std::uint8_t>(3 * 160 * 120, 90)};
  const recon::Image empty = picture;
  overlay.PaintOn(&picture, hull);
  EXPECT_EQ(picture, empty);
  EXPECT_EQ(overlay.count().hulls_unasked, 1);
  overlay.Place(parts_at(140.0));
  overlay.PaintOn(&picture, hull);
  EXPECT_NE(picture, empty);
  overlay.Place(parts_at(140.0));
  picture = empty;
  overlay.PaintOn(&picture, hull);
  EXPECT_EQ(overlay.count().parts_drawn, 3);
  EXPECT_EQ(overlay.count().parts_kept, 3);
  EXPECT_EQ(overlay.count().layers_kept, 1);
  EXPECT_EQ(overlay.count().hulls_viewed, 1);
  EXPECT_EQ(overlay.count().hulls_kept, 1);
  overlay.Place(parts_at(150.0));  // one of the three moves
  EXPECT_EQ(overlay.count().parts_drawn, 4);
  EXPECT_EQ(overlay.count().layers_composed, 2);
  // What is kept looks as if it were drawn anew.
  fresh.Place(parts_at(150.0));
  recon::Image kept = empty, anew = empty;
  overlay.PaintOn(&kept, hull);
  fresh.PaintOn(&anew, hull);
  EXPECT_EQ(kept, anew);
  EXPECT_THROW(overlay.PaintOn(&(picture = {}), hull), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::control
