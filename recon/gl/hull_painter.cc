#include "recon/gl/hull_painter.h"

#include <string>

#include "recon/gl/lighting.h"

namespace elbowroom::recon::gl {
namespace {

constexpr int kDepthUnit = 0;
constexpr int kNormalUnit = 1;

// One triangle over the whole picture.
constexpr const char* kVertexSource = R"(
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

constexpr const char* kFragmentSource = R"(
uniform sampler2D layer_depth;
uniform sampler2D layer_normal;
uniform vec2 view_size;
uniform float focal_px;
uniform vec2 near_far;
uniform mat4 cam_from_world;
uniform vec3 up_in_cam;
uniform vec3 color;
uniform int smooth_rim;
uniform int has_normals;
out vec4 pixel;

// Surfaces whose depths differ by more than this share are not one surface.
const float kSameSurface = 0.02;

ivec2 size;

float DepthAt(ivec2 texel) {
  bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
  return inside ? texelFetch(layer_depth, texel, 0).r : 0.0;
}
vec3 Ray(vec2 window) { return vec3((window - 0.5 * view_size) / focal_px, 1.0); }
vec3 PointAt(ivec2 texel, float depth) { return depth * Ray((vec2(texel) + 0.5) * view_size / vec2(size)); }

// Weights of the texels at -1, 0, 1 for a place `offset` in [-0.5, 0.5] from the middle one.
vec3 Spline(float offset) {
  return vec3(0.5 * (0.5 - offset) * (0.5 - offset), 0.75 - offset * offset,
              0.5 * (0.5 + offset) * (0.5 + offset));
}

// Difference to the neighbour, of the two along `axis`, that is nearer in depth.
vec3 Slope(ivec2 texel, float depth, ivec2 axis, vec3 fallback) {
  float before = DepthAt(texel - axis), after = DepthAt(texel + axis);
  vec3 here = PointAt(texel, depth);
  bool use_after = after > 0.0 && (before <= 0.0 || abs(after - depth) <= abs(before - depth));
  if (use_after) return PointAt(texel + axis, after) - here;
  if (before > 0.0) return here - PointAt(texel - axis, before);
  return fallback;
}

vec3 NormalAt(ivec2 texel, float depth) {
  vec3 normal = has_normals != 0 ? texelFetch(layer_normal, texel, 0).xyz : vec3(0.0);
  if (dot(normal, normal) > 0.25) return mat3(cam_from_world) * normal;
  vec3 across = Slope(texel, depth, ivec2(1, 0), vec3(1.0, 0.0, 0.0));
  vec3 down = Slope(texel, depth, ivec2(0, 1), vec3(0.0, 1.0, 0.0));
  return normalize(cross(down, across));
}

float BufferDepth(float depth) {
  return near_far.y / (near_far.y - near_far.x) * (1.0 - near_far.x / depth);
}

void main() {
  size = textureSize(layer_depth, 0);
  vec2 place = gl_FragCoord.xy * vec2(size) / view_size;
  ivec2 middle = ivec2(place);
  float reference = DepthAt(middle);
  if (smooth_rim == 0) {
    if (reference <= 0.0) discard;
    gl_FragDepth = BufferDepth(reference);
    pixel = vec4(color, 1.0);
    return;
  }
  float taps[9];
  float nearest = 0.0;
  for (int i = 0; i < 9; ++i) {
    taps[i] = DepthAt(middle + ivec2(i % 3 - 1, i / 3 - 1));
    if (taps[i] > 0.0 && (nearest == 0.0 || taps[i] < nearest)) nearest = taps[i];
  }
  if (nearest == 0.0) discard;
  if (reference <= 0.0) reference = nearest;
  vec2 offset = place - vec2(middle) - 0.5;
  vec3 weight_x = Spline(offset.x), weight_y = Spline(offset.y);
  float coverage = 0.0, kept = 0.0, inverse_depth = 0.0;
  vec3 normal = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    if (taps[i] <= 0.0) continue;
    float weight = weight_x[i % 3] * weight_y[i / 3];
    coverage += weight;
    if (abs(taps[i] - reference) > kSameSurface * reference) continue;
    kept += weight;
    inverse_depth += weight / taps[i];
    normal += weight * NormalAt(middle + ivec2(i % 3 - 1, i / 3 - 1), taps[i]);
  }
  vec3 to_eye = -normalize(Ray(gl_FragCoord.xy));
  normal = dot(normal, normal) > 0.0 ? normalize(normal) : to_eye;
  float facing = abs(dot(normal, to_eye));
  vec3 base = color * mix(vec3(0.72, 0.60, 0.56), vec3(1.0), smoothstep(0.0, 0.55, facing));
  pixel = vec4(Lit(base, normal, to_eye, up_in_cam, 0.05), coverage);
  gl_FragDepth = BufferDepth(kept / inverse_depth);
}
)";

}  // namespace

HullPainter::HullPainter()
    : program_("hull", kVertexSource, std::string(kLightingSource) + kFragmentSource) {}

void HullPainter::Draw(const HullLayer& layer, const Eigen::Vector3f& color, const ViewMatrices& matrices) {
  glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  DrawLayer(layer, matrices, color, /*smooth=*/true);
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void HullPainter::DrawDepth(const HullLayer& layer, const ViewMatrices& matrices) {
  DrawLayer(layer, matrices, Eigen::Vector3f::Zero(), /*smooth=*/false);
}

void HullPainter::DrawLayer(const HullLayer& layer, const ViewMatrices& matrices,
                            const Eigen::Vector3f& color, bool smooth) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "normals upload as packed floats");
  const SceneView& view = matrices.view;
  const bool has_normals = smooth && !layer.normal_in_world.empty();
  glActiveTexture(GL_TEXTURE0 + kDepthUnit);
  depth_.Upload(layer.width_px, layer.height_px, layer.depth_mm);
  depth_.BindTo(kDepthUnit);
  if (has_normals) {
    glActiveTexture(GL_TEXTURE0 + kNormalUnit);
    normal_.Upload(layer.width_px, layer.height_px,
                   {layer.normal_in_world.front().data(), 3 * layer.normal_in_world.size()});
    normal_.BindTo(kNormalUnit);
  }
  program_.Use();
  program_.Set("layer_depth", kDepthUnit);
  program_.Set("layer_normal", kNormalUnit);
  program_.Set("view_size",
               Eigen::Vector2f(static_cast<float>(view.width_px), static_cast<float>(view.height_px)));
  program_.Set("focal_px", static_cast<float>(view.focal_px));
  program_.Set("near_far",
               Eigen::Vector2f(static_cast<float>(view.near_mm), static_cast<float>(view.far_mm)));
  program_.Set("cam_from_world", matrices.cam_from_world);
  program_.Set("up_in_cam", matrices.up_in_cam);
  program_.Set("color", color);
  program_.Set("smooth_rim", smooth ? 1 : 0);
  program_.Set("has_normals", has_normals ? 1 : 0);
  corners_.Draw(GL_TRIANGLES, 3);
}

}  // namespace elbowroom::recon::gl
