#include "recon/gl/scene/surroundings_painter.h"

#include <array>
#include <string>
#include <vector>

#include "recon/gl/scene/layer_outputs.h"

namespace elbowroom::recon::gl {
namespace {

constexpr const char* kBackgroundVertexSource = R"(
out float height;  // 0 at the bottom of the picture, 1 at its top
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  height = 0.5 - 0.5 * corner.y;
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

constexpr const char* kBackgroundFragmentSource = R"(
in float height;
uniform vec3 bottom;
uniform vec3 top;
void main() {
  pixel = unlit = vec4(mix(bottom, top, height), 1.0);
  place = vec4(0.0);
}
)";

constexpr const char* kTableVertexSource = R"(
uniform vec4 extent;  // x0 y0 x1 y1 on z = 0
uniform mat4 cam_from_world;
uniform mat4 clip_from_cam;
out vec2 place_on_table;
out vec3 place_in_cam;
void main() {
  place_on_table = vec2((gl_VertexID & 1) == 0 ? extent.x : extent.z, (gl_VertexID & 2) == 0 ? extent.y : extent.w);
  place_in_cam = (cam_from_world * vec4(place_on_table, 0.0, 1.0)).xyz;
  gl_Position = clip_from_cam * vec4(place_in_cam, 1.0);
}
)";

// Each fifth line is stronger; lines closer together than two pixels fade out.
constexpr const char* kTableFragmentSource = R"(
in vec2 place_on_table;
in vec3 place_in_cam;
uniform vec4 extent;
uniform float grid;
uniform float opacity;
float Line(float coordinate, float width_px) {
  float cells_per_px = fwidth(coordinate);
  float distance_px = abs(fract(coordinate + 0.5) - 0.5) / cells_per_px;
  return clamp(0.5 * width_px + 0.5 - distance_px, 0.0, 1.0) * (1.0 - smoothstep(0.15, 0.5, cells_per_px));
}
float Rim(float distance_mm, float mm_per_px) { return clamp(2.0 - distance_mm / mm_per_px, 0.0, 1.0); }
void main() {
  vec2 cell = place_on_table / grid;
  float minor = max(Line(cell.x, 1.0), Line(cell.y, 1.0));
  float major = max(Line(cell.x / 5.0, 1.5), Line(cell.y / 5.0, 1.5));
  vec2 mm_per_px = fwidth(place_on_table);
  vec2 from_low = place_on_table - extent.xy, from_high = extent.zw - place_on_table;
  float rim = max(max(Rim(from_low.x, mm_per_px.x), Rim(from_high.x, mm_per_px.x)),
                  max(Rim(from_low.y, mm_per_px.y), Rim(from_high.y, mm_per_px.y)));
  vec3 color = mix(vec3(0.845, 0.850, 0.855), vec3(0.745, 0.755, 0.770), minor);
  color = mix(color, vec3(0.60, 0.62, 0.65), major);
  color = mix(color, vec3(0.45, 0.47, 0.50), rim);
  float light = PartLight(place_in_cam, up_in_cam) * HullLight(place_in_cam, up_in_cam, 0.3);
  pixel = vec4(color * mix(kUnlit, 1.0, light), opacity);
  unlit = vec4(color * kUnlit, opacity);
  place = vec4(place_in_cam.z * up_in_cam, 1.0);
}
)";

constexpr const char* kLineVertexSource = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 vertex_color;
uniform mat4 cam_from_world;
uniform mat4 clip_from_cam;
out vec4 color;
void main() {
  color = vertex_color;
  gl_Position = clip_from_cam * (cam_from_world * vec4(position, 1.0));
}
)";

constexpr const char* kLineFragmentSource = R"(
in vec4 color;
void main() {
  pixel = unlit = color;
  place = vec4(0.0);
}
)";

void AppendLine(std::vector<float>& floats, const Eigen::Vector3d& from_in_world,
                const Eigen::Vector3d& to_in_world, const Eigen::Vector4f& color) {
  for (const Eigen::Vector3d& end : {from_in_world, to_in_world}) {
    for (int axis = 0; axis < 3; ++axis) floats.push_back(static_cast<float>(end[axis]));
    floats.insert(floats.end(), color.data(), color.data() + 4);
  }
}

// Corners of a box that differ in one axis share an edge.
void AppendBox(std::vector<float>& floats, const Eigen::AlignedBox3d& box, const Eigen::Vector4f& color) {
  const auto corner = [&](int i) { return box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)); };
  for (int i = 0; i < 8; ++i) {
    for (const int bit : {1, 2, 4}) {
      if ((i & bit) == 0) AppendLine(floats, corner(i), corner(i | bit), color);
    }
  }
}

void AppendFrustum(std::vector<float>& floats, const CameraFrustum& frustum, const Eigen::Vector4f& color) {
  for (std::size_t i = 0; i < 4; ++i) {
    AppendLine(floats, frustum.center_in_world, frustum.corners_in_world[i], color);
    AppendLine(floats, frustum.corners_in_world[i], frustum.corners_in_world[(i + 1) % 4], color);
  }
}

}  // namespace

SurroundingsPainter::SurroundingsPainter()
    : background_program_("background", kBackgroundVertexSource,
                          std::string(kLayerOutputs).append(kBackgroundFragmentSource)),
      table_program_("table", kTableVertexSource,
                     std::string(kLightingSource).append(kLayerOutputs).append(kTableFragmentSource)),
      line_program_("line", kLineVertexSource, std::string(kLayerOutputs).append(kLineFragmentSource)) {}

void SurroundingsPainter::DrawBackground(const Scene& scene) const {
  background_program_.Use();
  background_program_.Set("bottom", scene.background_bottom);
  background_program_.Set("top", scene.background_top);
  glDisable(GL_DEPTH_TEST);
  no_vertices_.Draw(GL_TRIANGLES, 3);
  glEnable(GL_DEPTH_TEST);
}

void SurroundingsPainter::DrawTable(const Scene& scene, const ViewMatrices& matrices, const Lighting& light,
                                    HullShadow hull_shadow) const {
  if (!scene.table_in_world || scene.table_in_world->isEmpty()) return;
  const Eigen::Vector2f low = scene.table_in_world->min().cast<float>();
  const Eigen::Vector2f high = scene.table_in_world->max().cast<float>();
  table_program_.Use();
  table_program_.Set("extent", Eigen::Vector4f(low.x(), low.y(), high.x(), high.y()));
  table_program_.Set("cam_from_world", matrices.cam_from_world);
  table_program_.Set("clip_from_cam", matrices.clip_from_cam);
  light.Apply(table_program_, matrices, hull_shadow);
  table_program_.Set("grid", static_cast<float>(scene.table_grid_mm));
  table_program_.Set("opacity", scene.view.EyeInWorld().z() >= 0.0 ? 0.9F : 0.25F);
  glEnable(GL_BLEND);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glDepthMask(GL_FALSE);
  no_vertices_.Draw(GL_TRIANGLE_STRIP, 4);
  glDepthMask(GL_TRUE);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_BLEND);
}

void SurroundingsPainter::DrawLines(const Scene& scene, const ViewMatrices& matrices) {
  const Eigen::Vector4f workspace_color(0.24F, 0.40F, 0.58F, 0.55F);
  const Eigen::Vector4f camera_color(0.20F, 0.22F, 0.26F, 0.70F);
  std::vector<float> floats;
  if (scene.workspace_in_world && !scene.workspace_in_world->isEmpty()) {
    AppendBox(floats, *scene.workspace_in_world, workspace_color);
  }
  for (const CameraFrustum& camera : scene.cameras) AppendFrustum(floats, camera, camera_color);
  if (floats.empty()) return;
  lines_.Upload(floats, Refill::kEachFrame);
  line_program_.Use();
  line_program_.Set("cam_from_world", matrices.cam_from_world);
  line_program_.Set("clip_from_cam", matrices.clip_from_cam);
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  lines_.Draw(GL_LINES);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace elbowroom::recon::gl
