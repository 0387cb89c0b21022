// What a picture of the trial shows: values only, no OpenGL.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/camera_model.h"
#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"
#include "recon/appearance/hull_appearance.h"
#include "recon/appearance/scene_view.h"
#include "recon/exact_view/hull_view.h"
#include "recon/gl/scene/scene_lamp.h"

namespace elbowroom::recon::gl {

// Colours are red, green, blue in [0, 1] as a screen shows them (sRGB).
struct ScenePart {
  core::SharedMesh mesh;
  core::RigidTransform world_from_part;
  Eigen::Vector3f color = {0.62F, 0.67F, 0.73F};
  bool in_contact = false;   // tinted orange-red
  float opacity = 1.0F;      // below 1: what stands behind shows through; 0: not drawn
  bool is_cut_face = false;  // hatched, without edges
  // Colours a place of another part's surface: drawn just before it, without edges, hardly shaded; it throws
  // no shadow and has no depth of its own.
  bool is_decal = false;
};

// A real camera, shown as a pyramid from its centre.
struct CameraFrustum {
  Eigen::Vector3d center_in_world = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 4> corners_in_world;  // around the picture, at one depth

  [[nodiscard]] bool operator==(const CameraFrustum&) const = default;
};

// Nothing where the lens's domain doesn't reach the corners of the picture.
[[nodiscard]] std::optional<CameraFrustum> FrustumOf(const core::CameraModel& camera, double depth_mm);

// Samples a pixel. One is drawn sooner, with jagged edges: software OpenGL takes about half of the time.
enum class Smoothness { kOneSample, kFourSamples };

struct Scene {
  SceneView view;
  // Width and height of the largest picture to come in place of this one. Buffers are made for it at once and
  // kept, so that pictures that become finer or coarser take no new memory. Less than the view's: the view's.
  Eigen::Vector2i largest_px = Eigen::Vector2i::Zero();
  Smoothness smoothness = Smoothness::kFourSamples;
  std::vector<ScenePart> parts;
  // The hull from the scene's view; null: none. Texel (i, j) of one with the view's own size is pixel (i, j);
  // a smaller one covers the same picture and is scaled up. Normals that are zero, or not there, are taken
  // from the depths.
  std::shared_ptr<const HullView> hull;
  // For an appearance that HasPixelColors: as ColorHull gives them, or those of another quantity. Where they
  // aren't trusted fully, the shaded colour shows through. Empty: none.
  std::vector<CameraColor> hull_camera_color;
  HullAppearance hull_appearance = HullAppearance::kByNormal;
  Eigen::Vector3f hull_color = {0.87F, 0.67F, 0.55F};
  SceneLamp lamp;
  // The hull as lamp.ShadowView(its side) sees it, square; null: the hull throws no shadow.
  std::shared_ptr<const HullView> hull_from_lamp;
  std::vector<Eigen::Vector3d> contact_points_in_world;
  std::optional<Eigen::AlignedBox2d> table_in_world;  // its extent on z = 0, drawn with a grid
  double table_grid_mm = 50.0;
  std::optional<Eigen::AlignedBox3d> workspace_in_world;  // drawn as lines
  std::vector<CameraFrustum> cameras;
  Eigen::Vector3f background_top = {0.93F, 0.945F, 0.96F};
  Eigen::Vector3f background_bottom = {0.69F, 0.73F, 0.78F};

  // Throws: PreconditionError: a view that isn't valid, a part without a mesh, an opacity outside [0, 1],
  // a hull whose vectors don't match its size, one from the lamp that isn't square, a lamp that isn't
  // valid, a grid step not positive.
  void Validate() const;

  // Width and height of what holds a picture, or a layer of it, of this size and the largest one to come.
  [[nodiscard]] Eigen::Vector2i RoomPx(int width_px, int height_px) const {
    return largest_px.cwiseMax(Eigen::Vector2i(width_px, height_px));
  }
};

}  // namespace elbowroom::recon::gl
