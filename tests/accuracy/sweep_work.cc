#include "tests/accuracy/sweep_work.h"

#include <functional>
#include <memory>
#include <utility>

#include "recon/exact_view/hull_view.h"
#include "recon/gl/exact_view/exact_view_gl.h"
#include "recon/gl/paper_methods/plane_sweep_gl.h"
#include "recon/hull/visual_hull.h"
#include "recon/paper_methods/plane_sweep.h"
#include "recon/segmentation/frame_segmenter.h"
#include "recon/synthetic/synthetic_rig.h"
#include "recon/synthetic/view_scene.h"
#include "tests/accuracy/synthetic_segmentation.h"
#include "tests/accuracy/view_methods.h"
#include "tests/oracles/analytic_hull.h"
#include "tests/oracles/mask_hull_oracle.h"

namespace elbowroom::accuracy {
namespace {

// Depths, with the work that they took.
struct Seen {
  recon::DepthMap picture;
  std::int64_t planes = 0, triangles = 0, filled_pixels = 0;
};

struct Method {
  std::string name;
  std::function<Seen(const ViewTask&, const std::vector<core::SoftMask>&)> see;
};

recon::SyntheticRigOptions MixedPixels() {
  recon::SyntheticRigOptions options;
  options.samples_per_pixel_side = kRaysPerPixelSide;
  return options;
}

// Pictures and their masks.
struct Footage {
  explicit Footage(const recon::ViewScene& scene)
      : source(
            scene.rig, [objects = scene.objects](double) { return objects; }, MixedPixels()),
        segmenter(source.ReadBackgrounds({}, {}), {}, scene.rig),
        frames(source.Read(0)) {}

  [[nodiscard]] std::vector<core::SoftMask> Masks(recon::SegmentationStats* stats = nullptr) const {
    return segmenter.SegmentSoft(frames, stats);
  }

  recon::SyntheticRig source;
  recon::FrameSegmenter segmenter;
  recon::FrameSet frames;
};

Seen SeenBy(recon::SweptView swept, bool is_gl) {
  const recon::PlaneSweepStats& stats = swept.stats;
  return {std::move(swept.picture), stats.planes, stats.drawn_triangles,
          is_gl ? stats.filled_pixels : stats.tested_points};
}

Seen SeenBy(recon::HullView view) {
  return {{view.width_px, view.height_px, std::move(view.depth_mm), view.hit_pixels}, 0, 0, view.cast_pixels};
}

void AddSweepsGl(std::vector<Method>* methods) {
  const auto sweep = std::make_shared<recon::gl::PlaneSweepGl>();
  const auto add = [&](const std::string& name, int cells, recon::gl::SweepPasses passes) {
    recon::PlaneSweepOptions options = recon::FiftyPlanes();
    options.undistortion_grid = cells;
    methods->push_back(
        {name, [=](const ViewTask& task, const std::vector<core::SoftMask>& masks) {
           return SeenBy(sweep->Sweep(*task.rig, masks, task.view, task.sweep_rays, options, passes), true);
         }});
  };
  add("the paper's sweep, 5 x 5 cells, GL", kPaperCells, recon::gl::SweepPasses::kOneAPlaneAndCamera);
  add("the paper's sweep, no grid, GL", 0, recon::gl::SweepPasses::kOneAPlaneAndCamera);
  add("a draw a plane, GL", 0, recon::gl::SweepPasses::kOneAPlane);
}

void AddSweepsCpu(std::vector<Method>* methods) {
  const auto add = [&](const std::string& name, int cells, bool settles_regions) {
    recon::PlaneSweepOptions options = recon::FiftyPlanes();
    options.undistortion_grid = cells;
    options.settles_regions = settles_regions;
    methods->push_back(
        {name, [=](const ViewTask& task, const std::vector<core::SoftMask>& masks) {
           return SeenBy(recon::SweepPlanes(*task.rig, masks, task.view, task.sweep_rays, options), false);
         }});
  };
  add("plane sweep, 5 x 5 cells, CPU", kPaperCells, true);
  add("plain plane sweep, no grid, CPU", 0, false);
  add("plane sweep, no grid, CPU", 0, true);
}

std::vector<Method> Methods() {
  constexpr recon::HullViewOptions kDepthsAlone{.surfaces = false, .normals = false};
  std::vector<Method> methods;
  AddSweepsGl(&methods);
  AddSweepsCpu(&methods);
  const auto hull_of = [](const ViewTask& task, const std::vector<core::SoftMask>& masks) {
    return recon::MakeVisualHull(task.rig, task.planes, masks);
  };
  methods.push_back({"exact view, CPU", [=](const ViewTask& task, const std::vector<core::SoftMask>& masks) {
                       return SeenBy(recon::ViewHull(hull_of(task, masks), task.rays, kDepthsAlone));
                     }});
  methods.push_back({"exact view, GL", [=, card = std::make_shared<recon::gl::ExactViewGl>()](
                                           const ViewTask& task, const std::vector<core::SoftMask>& masks) {
                       return SeenBy(card->ViewHull(hull_of(task, masks), task.rays, kDepthsAlone));
                     }});
  return methods;
}

// The two hulls that depths are held to, as the task's view sees them.
struct References {
  References(const ViewTask& task, const std::vector<recon::SyntheticObject>& objects)
      : masks(
            task.view,
            PictureOf(task.view, [oracle = oracles::MaskHullOracle(
                                      *task.rig, task.masks, oracles::BoundaryConvention::kMarchingSquares)](
                                     const recon::Ray& ray) { return oracle.FirstSurface(ray); })),
        analytic(task.view,
                 PictureOf(task.view, [hull = oracles::AnalyticHull(*task.rig, recon::AllSolids(objects))](
                                          const recon::Ray& ray) { return hull.FirstSurface(ray); })) {}

  SurfacePicture masks, analytic;
};

}  // namespace

SweepWorkResult TimeSweepWork(const TimingEffort& effort, int view_width_px) {
  const recon::ViewScene scene =
      recon::MakeViewScene(recon::ViewSceneRig::kPaper, view_width_px, view_width_px * 3 / 4);
  const Footage footage(scene);
  SweepWorkResult result;
  const ViewTask task(std::make_shared<const core::Rig>(scene.rig), footage.Masks(&result.segmented),
                      scene.view);
  const References references(task, scene.objects);
  std::vector<std::function<void()>> jobs{[&] { (void)footage.Masks(); }};
  for (const Method& method : Methods()) {
    const Seen seen = method.see(task, task.masks);
    result.methods.push_back({method.name,
                              seen.planes,
                              seen.triangles,
                              seen.filled_pixels,
                              {},
                              {},
                              ErrorAgainst(references.masks, seen.picture),
                              ErrorAgainst(references.analytic, seen.picture)});
    jobs.emplace_back([&, see = method.see] { (void)see(task, footage.Masks()); });
  }
  const std::vector<Timing> one = TimeInTurns(jobs, 1, effort), two = TimeInTurns(jobs, 2, effort);
  result.one_thread = one.front();
  result.two_threads = two.front();
  for (std::size_t i = 0; i < result.methods.size(); ++i) {
    result.methods[i].one_thread = one[i + 1];
    result.methods[i].two_threads = two[i + 1];
  }
  return result;
}

}  // namespace elbowroom::accuracy
