#include "recon/gl/scene/part_painter.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/units.h"
#include "recon/gl/scene/layer_outputs.h"
#include "recon/gl/scene/lighting.h"
#include "recon/gl/scene/surface_mesh.h"

namespace elbowroom::recon::gl {
namespace {

constexpr double kCreaseRad = core::RadiansFromDegrees(30.0);
constexpr float kContactTintShare = 0.72F;
constexpr float kContactGlow = 0.35F;
constexpr float kHiddenEdgeAlpha = 0.30F;  // of edges seen through their own transparent part
constexpr float kEdgeAlpha = 0.85F;
constexpr float kHatchPx = 9.0F;
constexpr float kDecalGlow = 0.65F;  // its colour is read off, more than its shape

constexpr double kMostErrorPx = 0.25;  // how far a coarser level may be from the whole mesh, in the picture

constexpr const char* kFaceVertexSource = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 cam_from_part;
uniform mat4 clip_from_cam;
uniform float nearer;
out vec3 position_in_cam;
out vec3 normal_in_cam;
invariant gl_Position;  // depths drawn by another program are met exactly
void main() {
  vec4 x_in_cam = cam_from_part * vec4(position, 1.0);
  position_in_cam = x_in_cam.xyz;
  normal_in_cam = mat3(cam_from_part) * normal;
  gl_Position = clip_from_cam * vec4(x_in_cam.xyz * nearer, 1.0);
}
)";

constexpr const char* kPartDepthSource = R"(
void main() {}
)";

constexpr const char* kFaceFragmentSource = R"(
in vec3 position_in_cam;
in vec3 normal_in_cam;
uniform vec3 color;
uniform float opacity;
uniform float glow;  // share of the color that needs no light
uniform float hatch_px;  // between the lines of a cut's face, along both sides of the picture; 0: none
void main() {
  vec3 normal = normalize(normal_in_cam);
  float along = hatch_px > 0.0 ? mod(gl_FragCoord.x + gl_FragCoord.y, hatch_px) : hatch_px + 2.0;
  vec3 base = color * (along < 1.5 ? 0.55 : 1.0);
  float light = 0.0;
  bool is_turned_to_lamp = dot(normal, lamp_in_cam - position_in_cam) * dot(normal, -position_in_cam) > 0.0;
  for (int i = is_turned_to_lamp ? 0 : 1; i < 1; ++i) {
    light = PartLight(position_in_cam, normal) * HullLight(position_in_cam, normal, 0.3);
  }
  vec3 lit = Lit(base, position_in_cam, normal, 0.10, light);
  pixel = vec4(mix(lit, base, glow), opacity);
  unlit = vec4(mix(Lit(base, position_in_cam, normal, 0.10, 0.0), base, glow), opacity);
  place = vec4(position_in_cam.z * normal, 1.0);
}
)";

// Edges stand a thousandth of their distance before the faces that they bound, with a long lens less: more
// than a coarser level's faces are from the whole mesh, at any focal length above 250 pixels. Decals stand
// half as far before.
constexpr const char* kEdgeVertexSource = R"(
layout(location = 0) in vec3 position;
uniform mat4 cam_from_part;
uniform mat4 clip_from_cam;
uniform float nearer;
void main() {
  vec4 x_in_cam = cam_from_part * vec4(position, 1.0);
  gl_Position = clip_from_cam * vec4(x_in_cam.xyz * nearer, 1.0);
}
)";

constexpr const char* kEdgeFragmentSource = R"(
uniform vec4 color;
void main() {
  pixel = unlit = color;
  place = vec4(0.0);
}
)";

Eigen::Vector3f ShownColour(const ScenePart& part) {
  const Eigen::Vector3f touched(0.96F, 0.36F, 0.13F);
  return part.in_contact ? Eigen::Vector3f(part.color + kContactTintShare * (touched - part.color))
                         : part.color;
}

// A box around the box's picture, in shares of the view's sides from its upper left; where some of the box is
// behind the camera, all of the picture.
Eigen::AlignedBox2f PictureBounds(const Eigen::AlignedBox3d& box_in_part,
                                  const core::RigidTransform& cam_from_part, const SceneView& view) {
  const Eigen::AlignedBox2f picture(Eigen::Vector2f::Zero(), Eigen::Vector2f::Ones());
  const Eigen::Array2d focal_shares(view.focal_px / view.width_px, view.focal_px / view.height_px);
  Eigen::AlignedBox2f bounds;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner =
        cam_from_part * box_in_part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    if (corner.z() <= 0.0) return picture;
    const Eigen::Array2d place = 0.5 + focal_shares * corner.head<2>().array() / corner.z();
    bounds.extend(Eigen::Vector2f(place.cast<float>().matrix()));
  }
  return bounds.intersection(picture);
}

// Pixels that a millimetre may become anywhere in the box's picture; infinite where some of the box is before
// the near plane.
double MostPxPerMm(const Eigen::AlignedBox3d& box_in_part, const core::RigidTransform& cam_from_part,
                   const SceneView& view) {
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i)
    nearest_mm =
        std::min(nearest_mm,
                 (cam_from_part * box_in_part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))).z());
  if (nearest_mm <= view.near_mm) return std::numeric_limits<double>::infinity();
  // Along the ray through the picture's corner a millimetre sideways or in depth is that much longer there.
  const double slant = view.RayInCam({-0.5, -0.5}).norm();
  return slant * view.focal_px / nearest_mm;
}

float EdgesNearer(const ViewMatrices& matrices) {
  return static_cast<float>(1.0 - std::min(0.001, 0.6 / matrices.view.focal_px));
}

float FacesNearer(const ScenePart& part, const ViewMatrices& matrices) {
  return part.is_decal ? 0.5F * (1.0F + EdgesNearer(matrices)) : 1.0F;
}

float GlowOf(const ScenePart& part) {
  if (part.is_decal) return kDecalGlow;
  return part.in_contact ? kContactGlow : 0.0F;
}

Eigen::Matrix4f CamFromPart(const ScenePart& part, const ViewMatrices& matrices) {
  return ToMatrix4f(matrices.view.cam_from_world * part.world_from_part);
}

}  // namespace

bool PartPainter::MeshKey::operator<(const MeshKey& other) const {
  if (owner.owner_before(other.owner)) return true;
  if (other.owner.owner_before(owner)) return false;
  return std::less<>()(address, other.address);
}

PartPainter::PartPainter(PartDetail detail)
    : face_program_("part", kFaceVertexSource,
                    std::string(kLightingSource).append(kLayerOutputs).append(kFaceFragmentSource)),
      edge_program_("part edge", kEdgeVertexSource, std::string(kLayerOutputs).append(kEdgeFragmentSource)),
      depth_program_("part depth", kFaceVertexSource, kPartDepthSource) {
  if (detail == PartDetail::kOnDemand) level_maker_.emplace(kCreaseRad);
}

void PartPainter::Update(std::span<const ScenePart> parts, const SceneView& view) {
  std::erase_if(meshes_, [](const auto& entry) { return entry.first.owner.expired(); });
  if (level_maker_)
    while (const auto made = level_maker_->Take()) UploadLevels(*made);
  for (const ScenePart& part : parts) {
    const MeshKey key{part.mesh, part.mesh.get()};
    if (meshes_.contains(key)) continue;
    core::ValidateMesh(*part.mesh, "a part of the scene");
    const SurfaceMesh surface = PrepareSurface(*part.mesh, kCreaseRad);
    UploadedMesh& uploaded = meshes_[key];
    AddLevel(uploaded.levels,
             {surface.corners, static_cast<std::int64_t>(part.mesh->triangles.size()), /*error_mm=*/0.0});
    uploaded.edges.Upload(surface.feature_edges, Refill::kOnce);
    uploaded.bounds_in_part = core::BoundsOf(*part.mesh);
    ++mesh_uploads_;
    if (level_maker_ && !part.is_decal && part.mesh->triangles.size() >= kTrianglesWorthLevels)
      level_maker_->Ask(part.mesh);
  }
  levels_.clear();
  for (const ScenePart& part : parts) levels_.push_back(LevelFor(part, view));
}

void PartPainter::AddLevel(std::vector<UploadedSurface>& levels, const DetailLevel& level) {
  UploadedSurface& uploaded = levels.emplace_back();
  uploaded.faces.Upload(level.corners, Refill::kOnce);
  uploaded.triangles = level.triangles;
  uploaded.error_mm = level.error_mm;
}

void PartPainter::UploadLevels(const MadeLevels& made) {
  const auto uploaded = meshes_.find({made.mesh, made.mesh.get()});
  if (uploaded == meshes_.end()) return;
  for (const DetailLevel& level : made.levels) AddLevel(uploaded->second.levels, level);
}

void PartPainter::AwaitLevels() {
  if (!level_maker_) return;
  while (const auto made = level_maker_->Await()) UploadLevels(*made);
}

const PartPainter::UploadedMesh& PartPainter::Uploaded(const core::SharedMesh& mesh) const {
  return meshes_.at({mesh, mesh.get()});
}

double PartPainter::LowestMm(const ScenePart& part) const {
  const Eigen::AlignedBox3d& box = Uploaded(part.mesh).bounds_in_part;
  double lowest_mm = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i)
    lowest_mm = std::min(
        lowest_mm, (part.world_from_part * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i))).z());
  return lowest_mm;
}

Eigen::AlignedBox2f PartPainter::BoundsIn(const ScenePart& part, const SceneView& view) const {
  return PictureBounds(Uploaded(part.mesh).bounds_in_part, view.cam_from_world * part.world_from_part, view);
}

std::size_t PartPainter::LevelFor(const ScenePart& part, const SceneView& view) const {
  const UploadedMesh& mesh = Uploaded(part.mesh);
  const double most_mm =
      kMostErrorPx / MostPxPerMm(mesh.bounds_in_part, view.cam_from_world * part.world_from_part, view);
  std::size_t chosen = 0;
  for (std::size_t i = 1; i < mesh.levels.size(); ++i)
    if (mesh.levels[i].error_mm <= most_mm) chosen = i;
  return chosen;
}

PartPainter::DrawnPart PartPainter::Drawn(std::span<const ScenePart> parts, std::size_t i) const {
  const UploadedMesh& mesh = Uploaded(parts[i].mesh);
  const std::vector<UploadedSurface>& levels = mesh.levels;
  const UploadedSurface& surface = levels[levels_.at(i)];
  return {parts[i], surface, mesh.edges, levels.front().triangles - surface.triangles};
}

void PartPainter::DrawTriangles(const DrawnPart& drawn) {
  triangle_count_.drawn += drawn.surface.triangles;
  triangle_count_.left_out += drawn.left_out;
  drawn.surface.faces.Draw(GL_TRIANGLES);
}

void PartPainter::DrawFaces(const DrawnPart& drawn, const ViewMatrices& matrices) {
  face_program_.Use();
  face_program_.Set("clip_from_cam", matrices.clip_from_cam);
  face_program_.Set("cam_from_part", CamFromPart(drawn.part, matrices));
  face_program_.Set("color", ShownColour(drawn.part));
  face_program_.Set("opacity", drawn.part.opacity);
  face_program_.Set("glow", GlowOf(drawn.part));
  face_program_.Set("nearer", FacesNearer(drawn.part, matrices));
  face_program_.Set("hatch_px", drawn.part.is_cut_face ? kHatchPx : 0.0F);
  DrawTriangles(drawn);
}

void PartPainter::DrawFaceDepth(const DrawnPart& drawn, const ViewMatrices& matrices) {
  depth_program_.Use();
  depth_program_.Set("clip_from_cam", matrices.clip_from_cam);
  depth_program_.Set("cam_from_part", CamFromPart(drawn.part, matrices));
  depth_program_.Set("nearer", FacesNearer(drawn.part, matrices));
  DrawTriangles(drawn);
}

void PartPainter::DrawEdges(const DrawnPart& drawn, const ViewMatrices& matrices, float alpha) {
  if (drawn.part.is_cut_face || drawn.part.is_decal) return;
  const Eigen::Vector3f dark = 0.22F * ShownColour(drawn.part);
  edge_program_.Use();
  edge_program_.Set("clip_from_cam", matrices.clip_from_cam);
  edge_program_.Set("cam_from_part", CamFromPart(drawn.part, matrices));
  edge_program_.Set("nearer", EdgesNearer(matrices));
  edge_program_.Set("color", Eigen::Vector4f(dark.x(), dark.y(), dark.z(), alpha));
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  drawn.edges.Draw(GL_LINES);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void PartPainter::DrawOpaqueDepth(std::span<const ScenePart> parts, const ViewMatrices& matrices) {
  glEnable(GL_POLYGON_OFFSET_FILL);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].opacity >= 1.0F) DrawFaceDepth(Drawn(parts, i), matrices);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void PartPainter::DrawOpaque(std::span<const ScenePart> parts, const ViewMatrices& matrices,
                             const Lighting& light, HullShadow hull_shadow) {
  face_program_.Use();
  light.Apply(face_program_, matrices, hull_shadow);
  const auto draw_opaque = [&](auto draw) {
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].opacity >= 1.0F) draw(Drawn(parts, i));
  };
  glEnable(GL_POLYGON_OFFSET_FILL);
  draw_opaque([&](const DrawnPart& drawn) { DrawFaces(drawn, matrices); });
  glDisable(GL_POLYGON_OFFSET_FILL);
  draw_opaque([&](const DrawnPart& drawn) { DrawEdges(drawn, matrices, kEdgeAlpha); });
}

void PartPainter::DrawTransparent(std::span<const ScenePart> parts, const ViewMatrices& matrices,
                                  const Lighting& light) {
  face_program_.Use();
  light.Apply(face_program_, matrices);
  std::vector<std::pair<double, std::size_t>> by_depth;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].opacity <= 0.0F || parts[i].opacity >= 1.0F) continue;
    const Eigen::Vector3d center = Uploaded(parts[i].mesh).bounds_in_part.center();
    by_depth.emplace_back((matrices.view.cam_from_world * parts[i].world_from_part * center).z(), i);
  }
  std::stable_sort(by_depth.begin(), by_depth.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [depth_mm, i] : by_depth) {
    const DrawnPart drawn = Drawn(parts, i);
    DrawEdges(drawn, matrices, kHiddenEdgeAlpha);
    // Depth first, so that only the nearest surface of a part is blended, whatever its triangles' order.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    DrawFaceDepth(drawn, matrices);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_BLEND);
    DrawFaces(drawn, matrices);
    glDisable(GL_BLEND);
    glDisable(GL_POLYGON_OFFSET_FILL);
    DrawEdges(drawn, matrices, kEdgeAlpha);
  }
}

CasterPass PartPainter::DrawCasters(std::span<const ScenePart> parts, const ViewMatrices& lamp) {
  CasterPass pass;
  glEnable(GL_DEPTH_CLAMP);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const ScenePart& part = parts[i];
    if (part.opacity <= 0.0F || part.is_decal) continue;
    const Eigen::AlignedBox2f bounds = BoundsIn(part, lamp.view);
    if (bounds.isEmpty()) {
      ++pass.parts_outside;
      continue;
    }
    DrawFaceDepth(Drawn(parts, i), lamp);
    pass.bounds.extend(bounds);
  }
  glDisable(GL_DEPTH_CLAMP);
  return pass;
}

void PartPainter::DrawDepth(std::span<const ScenePart> parts, const ViewMatrices& matrices) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].opacity > 0.0F && !parts[i].is_decal) DrawFaceDepth(Drawn(parts, i), matrices);
  }
}

}  // namespace elbowroom::recon::gl
