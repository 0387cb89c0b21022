// A frame's result as a scene to draw.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/layers/heat_pieces.h"
#include "app/control/layers/hull_colors.h"
#include "app/control/section/part_sections.h"
#include "app/control/section/section_cut.h"
#include "app/control/view_method.h"
#include "recon/appearance/hull_appearance.h"
#include "recon/appearance/orbit_camera.h"
#include "recon/gl/scene/scene.h"

namespace elbowroom::control {

// How a picture is meant to look.
struct SceneLook {
  // Camera colours need the frame's pictures: without them the hull is shaded by its normals. kOneCamera
  // takes the colours of the viewer camera, or, without one, those of the rig's camera whose direction is
  // closest to the operator's.
  recon::HullAppearance hull = recon::HullAppearance::kByNormal;
  SectionCut cut = {};
  // Shown on the parts, in place of contact points; null: not shown.
  SharedHeatLayer heat = nullptr;
  // For kCoverage and kUncertainty; null: the hull is shaded by its normals then. While they or heat are
  // shown, parts are grey, and none is tinted for a contact.
  SharedRigKnowledge knowledge = nullptr;

  [[nodiscard]] bool operator==(const SceneLook&) const = default;
};

// Keeps what the next picture can use again: the views of the hull from operator and lamp, until the hull
// changes (the operator's also until the view changes), and the hull as the rig's cameras see it, until the
// frame changes. Keeping never changes a picture (scene_composer_test). Thread: one.
class SceneComposer {
 public:
  // make_view: makes the operator's view of the hull; its result may differ from the processor's in
  // recon::ViewBand.
  explicit SceneComposer(MakeView make_view = ProcessorsViews()) : make_view_(std::move(make_view)) {}

  // Parts at their poses (those in contact tinted, those of a broken pair rule yellow), the exact view of the
  // hull, contact points, the table, a lamp over the workspace. A part that hides much of the hull is drawn
  // see-through. What the look's cut takes away isn't shown; parts and hull have faces there, that of the
  // hull without a camera's colours, as no camera sees it. hull_scale: of the picture's side, (0, 1]; a hull
  // of fewer pixels is drawn sooner and scaled up.
  [[nodiscard]] recon::gl::Scene Compose(const FrameResult& result, const recon::SceneView& view,
                                         const SceneLook& look = {}, double hull_scale = 1.0);

  // Computes the view of the hull of a frame that isn't judged yet, as the next Compose() of that frame needs
  // it.
  void Foresee(const SharedHull& hull, const recon::SceneView& view, double hull_scale = 1.0);

  // Views of the hull that were computed since the start: the operator's, and those from lamp and cameras.
  [[nodiscard]] std::int64_t hull_views() const { return hull_views_; }
  [[nodiscard]] std::int64_t extra_hull_views() const { return extra_hull_views_; }
  // Looks of all the rig's cameras at a hull, for its coverage.
  [[nodiscard]] std::int64_t coverage_looks() const { return hull_colors_.looks(); }

 private:
  using SharedPhoto = std::shared_ptr<const recon::CameraTexture>;
  using SharedView = std::shared_ptr<const recon::HullView>;
  void Forget(const SharedHull& hull, const SectionCut& cut);
  void AddPart(recon::gl::ScenePart part, core::PartIndex index, const SectionCut& cut,
               recon::gl::Scene* scene);
  void SpareView();
  [[nodiscard]] SharedView HullFrom(const recon::SceneView& view);
  [[nodiscard]] std::vector<recon::CameraColor> PixelColors(const SceneLook& look,
                                                            const recon::SceneView& view,
                                                            const recon::SceneView& hull_view);
  [[nodiscard]] SharedView HullFromLamp(const recon::gl::SceneLamp& lamp);
  [[nodiscard]] std::vector<SharedPhoto> PhotosFor(const SceneLook& look, const recon::SceneView& view);
  [[nodiscard]] const SharedPhoto& PhotoOf(std::size_t place, const core::CameraModel& camera,
                                           const cv::Mat& image_bgr);

  MakeView make_view_;
  // What was made for the last frame drawn. Null: nobody has asked for it since.
  SharedHull hull_;
  SectionCut cut_;
  PartSections sections_;
  HeatPieces heat_;
  HullColors hull_colors_;
  std::shared_ptr<const recon::FrameSet> camera_frames_;
  std::shared_ptr<recon::HullView> hull_from_view_;
  bool needs_surfaces_ = false;  // whether the last look does
  recon::HullView spare_;
  recon::SceneView view_;  // of hull_from_view_
  SharedView hull_from_lamp_;
  std::vector<SharedPhoto> photos_;  // one a camera, and the viewer camera's
  std::int64_t hull_views_ = 0;
  std::int64_t extra_hull_views_ = 0;
};

// A first view that has all parts and the hull in the picture, from the front, above.
[[nodiscard]] recon::OrbitCamera OverviewCamera(const FrameResult& result, int width_px, int height_px);

// Closer to one part's contact.
[[nodiscard]] recon::OrbitCamera ContactCamera(const FrameResult& result, core::PartIndex part, int width_px,
                                               int height_px);

}  // namespace elbowroom::control
