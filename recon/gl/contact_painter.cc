#include "recon/gl/contact_painter.h"

#include <algorithm>
#include <vector>

namespace elbowroom::recon::gl {
namespace {

constexpr float kReliefMm = 12.0F;
constexpr float kHiddenOpacity = 0.35F;
constexpr float kMinDiameterPx = 8.0F;
constexpr float kDiameterOfHeight = 1.0F / 58.0F;

constexpr const char* kVertexSource = R"(
layout(location = 0) in vec3 position;
uniform mat4 cam_from_world;
uniform mat4 clip_from_cam;
uniform float diameter_px;
uniform float relief_mm;
void main() {
  vec3 x_in_cam = (cam_from_world * vec4(position, 1.0)).xyz;
  float distance_mm = length(x_in_cam);
  vec3 nearer = x_in_cam * max(1.0 - relief_mm / distance_mm, 0.5);
  gl_Position = clip_from_cam * vec4(nearer, 1.0);
  gl_PointSize = diameter_px + 2.0;
}
)";

// A red ball, brighter towards the upper left, with a dark rim.
constexpr const char* kFragmentSource = R"(
uniform float diameter_px;
uniform float opacity;
out vec4 pixel;
void main() {
  vec2 from_center = gl_PointCoord - 0.5;
  float radius_px = length(from_center) * (diameter_px + 2.0);
  float cover = clamp(0.5 * diameter_px + 0.5 - radius_px, 0.0, 1.0);
  if (cover <= 0.0) discard;
  float rim = smoothstep(0.5 * diameter_px - 2.2, 0.5 * diameter_px - 1.0, radius_px);
  float shine = 1.0 - smoothstep(0.0, 0.34, length(from_center - vec2(-0.13, 0.13)));
  vec3 red = mix(vec3(0.90, 0.06, 0.10), vec3(1.0, 0.45, 0.42), 0.8 * shine);
  pixel = vec4(mix(red, vec3(0.26, 0.0, 0.03), rim), opacity * cover);
}
)";

}  // namespace

ContactPainter::ContactPainter() : program_("contact", kVertexSource, kFragmentSource) {}

void ContactPainter::Draw(std::span<const Eigen::Vector3d> points_in_world, const ViewMatrices& matrices) {
  if (points_in_world.empty()) return;
  std::vector<float> floats;
  floats.reserve(3 * points_in_world.size());
  for (const Eigen::Vector3d& point : points_in_world) {
    for (int axis = 0; axis < 3; ++axis) floats.push_back(static_cast<float>(point[axis]));
  }
  points_.Upload(floats, Refill::kEachFrame);
  program_.Use();
  program_.Set("cam_from_world", matrices.cam_from_world);
  program_.Set("clip_from_cam", matrices.clip_from_cam);
  program_.Set("diameter_px",
               std::max(kMinDiameterPx, kDiameterOfHeight * static_cast<float>(matrices.view.height_px)));
  program_.Set("relief_mm", kReliefMm);
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  program_.Set("opacity", kHiddenOpacity);
  glDepthFunc(GL_GREATER);
  points_.Draw(GL_POINTS);
  program_.Set("opacity", 1.0F);
  glDepthFunc(GL_LEQUAL);
  points_.Draw(GL_POINTS);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace elbowroom::recon::gl
