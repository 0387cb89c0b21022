#include "recon/gl/part_painter.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "core/units.h"
#include "recon/gl/lighting.h"
#include "recon/gl/surface_mesh.h"

namespace elbowroom::recon::gl {
namespace {

constexpr double kCreaseRad = core::RadiansFromDegrees(30.0);
constexpr float kContactTintShare = 0.72F;
constexpr float kContactGlow = 0.35F;
constexpr float kHiddenEdgeAlpha = 0.30F;  // of edges seen through their own transparent part
constexpr float kEdgeAlpha = 0.85F;

constexpr const char* kFaceVertexSource = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 cam_from_part;
uniform mat4 clip_from_cam;
out vec3 position_in_cam;
out vec3 normal_in_cam;
invariant gl_Position;  // depths drawn by another program are met exactly
void main() {
  vec4 x_in_cam = cam_from_part * vec4(position, 1.0);
  position_in_cam = x_in_cam.xyz;
  normal_in_cam = mat3(cam_from_part) * normal;
  gl_Position = clip_from_cam * x_in_cam;
}
)";

constexpr const char* kDepthFragmentSource = R"(
void main() {}
)";

constexpr const char* kFaceFragmentSource = R"(
in vec3 position_in_cam;
in vec3 normal_in_cam;
uniform vec3 color;
uniform float opacity;
uniform float glow;  // share of the color that needs no light
out vec4 pixel;
void main() {
  vec3 normal = normalize(normal_in_cam);
  float light = 0.0;
  bool is_turned_to_lamp = dot(normal, lamp_in_cam - position_in_cam) * dot(normal, -position_in_cam) > 0.0;
  for (int i = is_turned_to_lamp ? 0 : 1; i < 1; ++i) {
    light = PartLight(position_in_cam, normal) * HullLight(position_in_cam, normal, 0.3);
  }
  vec3 lit = Lit(color, position_in_cam, normal, 0.10, light);
  pixel = vec4(mix(lit, color, glow), opacity);
}
)";

// Edges stand a thousandth of their distance before the faces that they bound.
constexpr const char* kEdgeVertexSource = R"(
layout(location = 0) in vec3 position;
uniform mat4 cam_from_part;
uniform mat4 clip_from_cam;
void main() {
  vec4 x_in_cam = cam_from_part * vec4(position, 1.0);
  gl_Position = clip_from_cam * vec4(x_in_cam.xyz * 0.999, 1.0);
}
)";

constexpr const char* kEdgeFragmentSource = R"(
uniform vec4 color;
out vec4 pixel;
void main() { pixel = color; }
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

Eigen::Matrix4f CamFromPart(const ScenePart& part, const ViewMatrices& matrices) {
  return ToMatrix4f(matrices.view.cam_from_world * part.world_from_part);
}

}  // namespace

bool PartPainter::MeshKey::operator<(const MeshKey& other) const {
  if (owner.owner_before(other.owner)) return true;
  if (other.owner.owner_before(owner)) return false;
  return std::less<>()(address, other.address);
}

PartPainter::PartPainter()
    : face_program_("part", kFaceVertexSource, std::string(kLightingSource) + kFaceFragmentSource),
      edge_program_("part edge", kEdgeVertexSource, kEdgeFragmentSource),
      depth_program_("part depth", kFaceVertexSource, kDepthFragmentSource) {}

void PartPainter::Update(std::span<const ScenePart> parts) {
  std::erase_if(meshes_, [](const auto& entry) { return entry.first.owner.expired(); });
  for (const ScenePart& part : parts) {
    const MeshKey key{part.mesh, part.mesh.get()};
    if (meshes_.contains(key)) continue;
    core::ValidateMesh(*part.mesh, "a part of the scene");
    const SurfaceMesh surface = PrepareSurface(*part.mesh, kCreaseRad);
    UploadedMesh& uploaded = meshes_[key];
    uploaded.faces.Upload(surface.corners, Refill::kOnce);
    uploaded.edges.Upload(surface.feature_edges, Refill::kOnce);
    uploaded.bounds_in_part = core::BoundsOf(*part.mesh);
    ++mesh_uploads_;
  }
}

const PartPainter::UploadedMesh& PartPainter::Uploaded(const core::SharedMesh& mesh) const {
  return meshes_.at({mesh, mesh.get()});
}

void PartPainter::DrawFaces(const ScenePart& part, const ViewMatrices& matrices) {
  face_program_.Use();
  face_program_.Set("clip_from_cam", matrices.clip_from_cam);
  face_program_.Set("cam_from_part", CamFromPart(part, matrices));
  face_program_.Set("color", ShownColour(part));
  face_program_.Set("opacity", part.opacity);
  face_program_.Set("glow", part.in_contact ? kContactGlow : 0.0F);
  Uploaded(part.mesh).faces.Draw(GL_TRIANGLES);
}

void PartPainter::DrawFaceDepth(const ScenePart& part, const ViewMatrices& matrices) {
  depth_program_.Use();
  depth_program_.Set("clip_from_cam", matrices.clip_from_cam);
  depth_program_.Set("cam_from_part", CamFromPart(part, matrices));
  Uploaded(part.mesh).faces.Draw(GL_TRIANGLES);
}

void PartPainter::DrawEdges(const ScenePart& part, const ViewMatrices& matrices, float alpha) {
  const Eigen::Vector3f dark = 0.22F * ShownColour(part);
  edge_program_.Use();
  edge_program_.Set("clip_from_cam", matrices.clip_from_cam);
  edge_program_.Set("cam_from_part", CamFromPart(part, matrices));
  edge_program_.Set("color", Eigen::Vector4f(dark.x(), dark.y(), dark.z(), alpha));
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  Uploaded(part.mesh).edges.Draw(GL_LINES);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void PartPainter::DrawOpaque(std::span<const ScenePart> parts, const ViewMatrices& matrices,
                             const Lighting& light) {
  face_program_.Use();
  light.Apply(face_program_, matrices);
  glEnable(GL_POLYGON_OFFSET_FILL);
  for (const ScenePart& part : parts) {
    if (part.opacity >= 1.0F) DrawFaces(part, matrices);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  for (const ScenePart& part : parts) {
    if (part.opacity >= 1.0F) DrawEdges(part, matrices, kEdgeAlpha);
  }
}

void PartPainter::DrawTransparent(std::span<const ScenePart> parts, const ViewMatrices& matrices,
                                  const Lighting& light) {
  face_program_.Use();
  light.Apply(face_program_, matrices);
  std::vector<std::pair<double, const ScenePart*>> by_depth;
  for (const ScenePart& part : parts) {
    if (part.opacity <= 0.0F || part.opacity >= 1.0F) continue;
    const Eigen::Vector3d center = Uploaded(part.mesh).bounds_in_part.center();
    by_depth.emplace_back((matrices.view.cam_from_world * part.world_from_part * center).z(), &part);
  }
  std::stable_sort(by_depth.begin(), by_depth.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [depth_mm, part] : by_depth) {
    DrawEdges(*part, matrices, kHiddenEdgeAlpha);
    // Depth first, so that only the nearest surface of a part is blended, whatever its triangles' order.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    DrawFaceDepth(*part, matrices);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_BLEND);
    DrawFaces(*part, matrices);
    glDisable(GL_BLEND);
    glDisable(GL_POLYGON_OFFSET_FILL);
    DrawEdges(*part, matrices, kEdgeAlpha);
  }
}

CasterPass PartPainter::DrawCasters(std::span<const ScenePart> parts, const ViewMatrices& lamp) {
  CasterPass pass;
  glEnable(GL_DEPTH_CLAMP);
  for (const ScenePart& part : parts) {
    if (part.opacity <= 0.0F) continue;
    const Eigen::AlignedBox2f bounds = PictureBounds(
        Uploaded(part.mesh).bounds_in_part, lamp.view.cam_from_world * part.world_from_part, lamp.view);
    if (bounds.isEmpty()) {
      ++pass.parts_outside;
      continue;
    }
    DrawFaceDepth(part, lamp);
    pass.bounds.extend(bounds);
  }
  glDisable(GL_DEPTH_CLAMP);
  return pass;
}

void PartPainter::DrawDepth(std::span<const ScenePart> parts, const ViewMatrices& matrices) {
  for (const ScenePart& part : parts) {
    if (part.opacity > 0.0F) DrawFaceDepth(part, matrices);
  }
}

}  // namespace elbowroom::recon::gl
