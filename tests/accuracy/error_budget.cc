#include "tests/accuracy/error_budget.h"

#include <fmt/format.h>

#include "core/units.h"
#include "recon/hull/visual_hull.h"
#include "tests/accuracy/disturbed_rig.h"
#include "tests/accuracy/synthetic_segmentation.h"
#include "tests/accuracy/view_methods.h"
#include "tests/oracles/coverage_mask.h"
#include "tests/oracles/mask_hull_oracle.h"

namespace elbowroom::accuracy {
namespace {

using oracles::BoundaryConvention;
using recon::DepthMap;
using recon::Ray;

// "The head tracker's noise, sub-millimeter in position and 0.1 degrees in rotation": half a millimetre is
// our reading of the first.
constexpr double kHeadNoiseMm = 0.5;
constexpr double kHeadNoiseDeg = 0.1;
// The whole hand is nearer to the view than this. A head that is turned by an angle shows a point of the hull
// in the place of one that is distance times angle away; a head that is moved, by no more than its own way.
constexpr double kFarthestFromHeadMm = 1000.0;
// The reference is a mesh with a point a pixel, which is 3.3 mm wide in the smallest view that terms are
// measured in: at rims, points of another view lie beside it.
constexpr double kReferenceSlackMm = 1.0;

DepthMap PictureOfHull(const BudgetScene& scene, const oracles::AnalyticHull& hull, int stride) {
  return PictureOf(
      scene.view, [&](const Ray& ray) { return hull.FirstSurface(ray); }, stride);
}

DepthMap DisturbedView(const BudgetScene& scene, const Disturbance& disturbance, std::uint64_t seed,
                       int stride) {
  const oracles::AnalyticHull hull(scene.rig.workspace_mm, scene.rig.unseen,
                                   DisturbedSights(scene.rig, scene.solids, disturbance, seed));
  return PictureOfHull(scene, hull, stride);
}

// `footprint_px` as oracles::CoverageMask has it.
DepthMap MaskView(const BudgetScene& scene, BoundaryConvention convention, double footprint_px, int stride) {
  std::vector<core::SoftMask> masks;
  for (const core::CameraModel& camera : scene.rig.cameras) {
    masks.push_back(convention == BoundaryConvention::kPixelSquares
                        ? core::SoftMask{oracles::CenterMask(camera, scene.solids), {}}
                        : oracles::CoverageMask(camera, scene.solids, footprint_px));
  }
  const oracles::MaskHullOracle oracle(scene.rig, masks, convention);
  return PictureOf(
      scene.view, [&](const Ray& ray) { return oracle.FirstSurface(ray); }, stride);
}

DepthMap SegmentedView(const BudgetScene& scene, const Disturbance& disturbance, double noise_levels,
                       double spacing_mm, std::uint64_t seed, int stride) {
  const std::vector<oracles::Sight> sights = DisturbedSights(scene.rig, scene.solids, disturbance, seed);
  const std::shared_ptr<const core::Rig> believed = BelievedRig(scene.rig, sights);
  const std::vector<core::SoftMask> masks = SightSegmenter(scene.rig, noise_levels, seed).Segment(sights);
  if (spacing_mm == 0.0) return ExactView({believed, masks, scene.view});
  const recon::VisualHull hull = recon::MakeVisualHull(believed, masks);
  const auto contains = [&](const Eigen::Vector3d& x) { return hull.Contains(x); };
  return PictureOnPlanes(scene.view, scene.rig.workspace_mm, spacing_mm, contains, stride);
}

BudgetTerm PlaneTerm(double spacing_mm, double ceiling_mm, const std::string& paper) {
  return {.name = fmt::format("planes {:.0f} mm apart", spacing_mm),
          .paper = paper,
          .ceiling_mm = ceiling_mm,
          .view = [=](const BudgetScene& scene, std::uint64_t, int stride) {
            const auto contains = [&](const Eigen::Vector3d& x) { return scene.hull.Contains(x); };
            return PictureOnPlanes(scene.view, scene.rig.workspace_mm, spacing_mm, contains, stride);
          }};
}

BudgetTerm DisturbedTerm(const std::string& name, const std::string& paper, const Disturbance& disturbance,
                         double ceiling_mm) {
  return {.name = name,
          .paper = paper,
          .is_random = true,
          .ceiling_mm = ceiling_mm,
          .view = [=](const BudgetScene& scene, std::uint64_t seed, int stride) {
            return DisturbedView(scene, disturbance, seed, stride);
          }};
}

// Drawn as the noisy head sees the hull, and shown to the true one.
BudgetTerm HeadTerm(const std::string& name, const std::string& paper, const Disturbance& noise) {
  const double ceiling_mm = kFarthestFromHeadMm * core::RadiansFromDegrees(noise.rotation_deg) +
                            noise.position_mm + kReferenceSlackMm;
  return {.name = name,
          .paper = paper,
          .is_random = true,
          .ceiling_mm = ceiling_mm,
          .view = [=](const BudgetScene& scene, std::uint64_t seed, int stride) {
            return PictureOf(
                DisturbedCamera(scene.view, noise, seed),
                [&](const Ray& ray) { return scene.hull.FirstSurface(ray); }, stride);
          }};
}

std::vector<BudgetTerm> HeadTerms() {
  return {HeadTerm("head tracker off by 0.1 degrees", "0.1 degrees in rotation (Accuracy)",
                   {.rotation_deg = kHeadNoiseDeg}),
          HeadTerm("head tracker off by 0.5 mm", "\"sub-millimeter\" (Accuracy); the 0.5 is ours",
                   {.position_mm = kHeadNoiseMm}),
          HeadTerm("head tracker off by both", "\"not a significant component\" (Accuracy)",
                   {.rotation_deg = kHeadNoiseDeg, .position_mm = kHeadNoiseMm})};
}

BudgetTerm SegmentedTerm(const std::string& name, const std::string& paper, const Disturbance& disturbance,
                         double noise_levels, double spacing_mm, double ceiling_mm) {
  return {.name = name,
          .paper = paper,
          .convention = Convention::kMarching,
          .is_random = true,
          .ceiling_mm = ceiling_mm,
          .view = [=](const BudgetScene& scene, std::uint64_t seed, int stride) {
            return SegmentedView(scene, disturbance, noise_levels, spacing_mm, seed, stride);
          }};
}

std::vector<BudgetTerm> ShapeTerms() {
  return {{"hull against object", "\"a lower bound of overall error\", no figure (Accuracy)",
           Convention::kNone, false, true, 16.0,
           [](const BudgetScene& scene, std::uint64_t, int stride) {
             return PictureOfHull(scene, scene.hull, stride);
           }},
          {"pixel footprint", "5.8 x 2.5 mm at 3.3 m (Accuracy)", Convention::kSquares, false, false, 2.2,
           [](const BudgetScene& scene, std::uint64_t, int stride) {
             return MaskView(scene, BoundaryConvention::kPixelSquares, 1.0, stride);
           }},
          {"sub-pixel boundary", "", Convention::kMarching, false, false, 0.8,
           [](const BudgetScene& scene, std::uint64_t, int stride) {
             return MaskView(scene, BoundaryConvention::kMarchingSquares, 1.0, stride);
           }},
          {"sub-pixel boundary, lens blurs by a pixel", "", Convention::kMarching, false, false, 0.6,
           [](const BudgetScene& scene, std::uint64_t, int stride) {
             return MaskView(scene, BoundaryConvention::kMarchingSquares, 2.0, stride);
           }}};
}

}  // namespace

BudgetScene MakeBudgetScene(int view_width_px, int view_height_px) {
  recon::ViewScene scene = recon::MakeViewScene(recon::ViewSceneRig::kPaper, view_width_px, view_height_px);
  std::vector<recon::Solid> solids = recon::AllSolids(scene.objects);
  oracles::AnalyticHull hull(scene.rig, solids);
  SurfacePicture hull_surface(scene.view,
                              PictureOf(scene.view, [&](const Ray& ray) { return hull.FirstSurface(ray); }));
  SurfacePicture object_surface(
      scene.view, PictureOf(scene.view, [&](const Ray& ray) { return NearestHitMm(solids, ray); }));
  return {std::move(scene.rig), std::move(solids),       std::move(scene.view),
          std::move(hull),      std::move(hull_surface), std::move(object_surface)};
}

std::vector<BudgetTerm> BudgetTerms() {
  std::vector<BudgetTerm> terms = ShapeTerms();
  terms.push_back(
      PlaneTerm(kPaperSpacingMm, 8.0, "15 mm: \"the primary factor\" of the rendering (Accuracy)"));
  terms.push_back(PlaneTerm(5.0, 3.0, ""));
  terms.push_back(PlaneTerm(1.0, 0.8, ""));
  for (const double angle_deg : {kOnePixelDeg, 0.25, 0.5, 1.0}) {
    const bool is_paper = angle_deg == 1.0, is_pixel = angle_deg == kOnePixelDeg;
    terms.push_back(DisturbedTerm(fmt::format("rotation off by {} degrees", angle_deg),
                                  is_paper   ? "57.5 mm; names no distance (Accuracy)"
                                  : is_pixel ? "the estimated 1 px (Our Experience)"
                                             : "",
                                  {.rotation_deg = angle_deg}, 1.0 + 40.0 * angle_deg));
  }
  for (const double offset_mm : {kSubMillimetreMm, 5.0}) {
    terms.push_back(DisturbedTerm(fmt::format("position off by {:.0f} mm", offset_mm),
                                  offset_mm == kSubMillimetreMm ? "\"sub-millimeter\" (Our Experience)" : "",
                                  {.position_mm = offset_mm}, 0.5 + offset_mm));
  }
  for (const double apart_s : {0.5 * kVideoFrameS, kVideoFrameS}) {
    terms.push_back(DisturbedTerm(fmt::format("cameras {:.0f} ms apart, hand at 500 mm/s", 1e3 * apart_s),
                                  "\"the lack of camera synchronization\", no figure (Our Experience)",
                                  {.skew_s = apart_s, .velocity_mm_s = {500.0, 0.0, 0.0}},
                                  0.5 * 500.0 * apart_s));
  }
  for (BudgetTerm& term : HeadTerms()) terms.push_back(std::move(term));
  terms.push_back(SegmentedTerm("segmented without noise", "", {}, 0.0, 0.0, 1.5));
  terms.push_back(SegmentedTerm("segmented with 2 % noise",
                                "\"do not contribute to errors in the visual hull location\" (Accuracy)", {},
                                kPaperNoiseLevels, 0.0, 1.5));
  terms.push_back(SegmentedTerm("all together, exact view", "5 mm: hull shape (Accuracy Summary)",
                                kPaperDisturbance, kPaperNoiseLevels, 0.0, 10.0));
  terms.push_back(SegmentedTerm("all together, planes 15 mm apart", "15 mm: rendered hull (Accuracy Summary)",
                                kPaperDisturbance, kPaperNoiseLevels, kPaperSpacingMm, 12.0));
  return terms;
}

DepthError MeasureTerm(const BudgetTerm& term, const BudgetScene& scene, const BudgetEffort& effort) {
  ErrorTally tally;
  const SurfacePicture& reference = term.is_against_object ? scene.object_surface : scene.hull_surface;
  for (int draw = 0; draw < (term.is_random ? effort.draws : 1); ++draw) {
    tally.Add(reference, term.view(scene, static_cast<std::uint64_t>(draw) + 1, effort.stride),
              effort.stride);
  }
  return tally.Summary();
}

}  // namespace elbowroom::accuracy
