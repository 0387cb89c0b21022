#include "recon/gl/scene/contact_painter.h"

#include <algorithm>
#include <array>
#include <vector>

namespace elbowroom::recon::gl {
namespace {

constexpr float kReliefMm = 12.0F;
constexpr float kHiddenOpacity = 0.5F;
constexpr float kMinRadiusPx = 4.0F;
constexpr float kRadiusOfHeight = 1.0F / 110.0F;

// A square of pixels around the point, two triangles; corner is +-1 from its middle.
constexpr const char* kMarkVertexSource = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 corner;
uniform mat4 cam_from_world;
uniform mat4 clip_from_cam;
uniform vec2 view_size;
uniform float reach_px;
uniform float relief_mm;
out vec2 from_center_px;
void main() {
  vec3 x_in_cam = (cam_from_world * vec4(position, 1.0)).xyz;
  float distance_mm = length(x_in_cam);
  vec3 nearer = x_in_cam * max(1.0 - relief_mm / distance_mm, 0.5);
  from_center_px = reach_px * corner;
  gl_Position = clip_from_cam * vec4(nearer, 1.0);
  gl_Position.xy += 2.0 * from_center_px / view_size * gl_Position.w;
}
)";

// A red ball, brighter towards the upper left, with a dark rim.
constexpr const char* kFragmentSource = R"(
in vec2 from_center_px;
uniform float radius_px;
uniform float opacity;
out vec4 pixel;
void main() {
  float off_px = length(from_center_px);
  float cover = clamp(radius_px + 0.5 - off_px, 0.0, 1.0);
  if (cover <= 0.0) discard;
  float rim = smoothstep(radius_px - 2.0, radius_px - 1.0, off_px);
  float shine = 1.0 - smoothstep(0.0, 0.5, length(from_center_px / radius_px + vec2(0.28, 0.28)));
  vec3 red = mix(vec3(0.88, 0.03, 0.08), vec3(1.0, 0.52, 0.48), 0.7 * shine);
  pixel = vec4(mix(red, vec3(0.22, 0.0, 0.02), rim), opacity * cover);
}
)";

void AppendMark(std::vector<float>& floats, const Eigen::Vector3d& point_in_world) {
  constexpr std::array<std::array<float, 2>, 6> kCorners{
      {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}};
  for (const auto& corner : kCorners) {
    for (int axis = 0; axis < 3; ++axis) floats.push_back(static_cast<float>(point_in_world[axis]));
    floats.insert(floats.end(), corner.begin(), corner.end());
  }
}

}  // namespace

ContactPainter::ContactPainter() : program_("contact", kMarkVertexSource, kFragmentSource) {}

void ContactPainter::Draw(std::span<const Eigen::Vector3d> points_in_world, const ViewMatrices& matrices) {
  if (points_in_world.empty()) return;
  const auto width_px = static_cast<float>(matrices.view.width_px);
  const auto height_px = static_cast<float>(matrices.view.height_px);
  const float radius_px = std::max(kMinRadiusPx, kRadiusOfHeight * height_px);
  std::vector<float> floats;
  for (const Eigen::Vector3d& point : points_in_world) AppendMark(floats, point);
  marks_.Upload(floats, Refill::kEachFrame);
  program_.Use();
  program_.Set("cam_from_world", matrices.cam_from_world);
  program_.Set("clip_from_cam", matrices.clip_from_cam);
  program_.Set("view_size", Eigen::Vector2f(width_px, height_px));
  program_.Set("radius_px", radius_px);
  program_.Set("reach_px", radius_px + 1.0F);
  program_.Set("relief_mm", kReliefMm);
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  program_.Set("opacity", kHiddenOpacity);
  glDepthFunc(GL_GREATER);
  marks_.Draw(GL_TRIANGLES);
  program_.Set("opacity", 1.0F);
  glDepthFunc(GL_LEQUAL);
  marks_.Draw(GL_TRIANGLES);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace elbowroom::recon::gl
