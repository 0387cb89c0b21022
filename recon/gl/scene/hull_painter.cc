#include "recon/gl/scene/hull_painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "recon/gl/scene/lighting.h"

namespace elbowroom::recon::gl {
namespace {

constexpr int kDepthUnit = 0;
constexpr int kNormalUnit = 1;
constexpr int kCameraColorUnit = 2;

// One triangle over the whole picture.
constexpr const char* kHullVertexSource = R"(
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

// Access to the layer's depth, for both ways of drawing.
constexpr const char* kLayerSource = R"(
uniform sampler2D layer_depth;
uniform vec2 view_size;
uniform vec2 near_far;
float DepthAt(ivec2 texel) {
  ivec2 size = textureSize(layer_depth, 0);
  bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
  float depth = texelFetch(layer_depth, clamp(texel, ivec2(0), size - 1), 0).r;
  return inside ? depth : 0.0;
}
vec2 PlaceInLayer() { return gl_FragCoord.xy * vec2(textureSize(layer_depth, 0)) / view_size; }
float BufferDepth(float depth) {
  return near_far.y / (near_far.y - near_far.x) * (1.0 - near_far.x / depth);
}
)";

constexpr const char* kHullDepthSource = R"(
void main() {
  float depth = DepthAt(ivec2(PlaceInLayer()));
  if (depth <= 0.0) discard;
  gl_FragDepth = BufferDepth(depth);
}
)";

// Where there is nothing to do, a loop has no turn: it stands in for an if, of which software drivers step
// through both sides.
constexpr const char* kPictureFragmentSource = R"(
uniform sampler2D layer_normal;
uniform sampler2D layer_camera_color;
uniform bool has_camera_color;
uniform bool is_flat;
uniform float focal_px;
uniform float samples_in_pixel;
uniform ivec2 texels;  // [first, end) of the nine around a place that make its surface; only the middle one: (4, 5)
uniform mat4 cam_from_world;
uniform vec3 color;
out vec4 pixel;

// The hull in the shadow's map stands this near to the same hull in the picture, whatever their sizes.
const float kHullSlackMm = 3.0;

uniform float same_surface;  // surfaces whose depths differ by more than this share are not one surface

vec3 Ray(vec2 window) { return vec3((window - 0.5 * view_size) / focal_px, 1.0); }
vec3 PointAt(ivec2 texel, float depth) {
  return depth * Ray((vec2(texel) + 0.5) * view_size / vec2(textureSize(layer_depth, 0)));
}

// Weights of the texels at -1, 0, 1 for a place `offset` in [-0.5, 0.5] from the middle one.
vec3 Spline(float offset) {
  return vec3(0.5 * (0.5 - offset) * (0.5 - offset), 0.75 - offset * offset,
              0.5 * (0.5 + offset) * (0.5 + offset));
}

// Difference to the neighbour, of the two along `axis`, that is nearer in depth.
vec3 Slope(ivec2 texel, float depth, ivec2 axis) {
  float before = DepthAt(texel - axis), after = DepthAt(texel + axis);
  vec3 here = PointAt(texel, depth);
  bool use_after = after > 0.0 && (before <= 0.0 || abs(after - depth) <= abs(before - depth));
  if (use_after) return PointAt(texel + axis, after) - here;
  if (before > 0.0) return here - PointAt(texel - axis, before);
  return vec3(axis, 0.0);
}

void main() {
  vec2 place = PlaceInLayer();
  ivec2 middle = ivec2(place);
  ivec2 surface_texel = middle;
  float surface = DepthAt(middle);
  for (int i = surface > 0.0 ? texels.y : texels.x; i < texels.y; ++i) {
    ivec2 texel = middle + ivec2(i % 3 - 1, i / 3 - 1);
    float depth = DepthAt(texel);
    bool nearer = depth > 0.0 && (surface <= 0.0 || depth < surface);
    surface = nearer ? depth : surface;
    surface_texel = nearer ? texel : surface_texel;
  }
  vec2 offset = place - vec2(middle) - 0.5;
  bool is_one = texels.y - texels.x == 1;
  vec3 weight_x = is_one ? vec3(1.0) : Spline(offset.x), weight_y = is_one ? vec3(1.0) : Spline(offset.y);
  float coverage = 0.0, kept = 0.0, inverse_depth = 0.0;
  vec3 normal_in_world = vec3(0.0);
  for (int i = surface > 0.0 ? texels.x : texels.y; i < texels.y; ++i) {
    ivec2 texel = middle + ivec2(i % 3 - 1, i / 3 - 1);
    float depth = DepthAt(texel);
    float weight = depth > 0.0 ? weight_x[i % 3] * weight_y[i / 3] : 0.0;
    coverage += weight;
    weight = abs(depth - surface) <= same_surface * surface ? weight : 0.0;
    kept += weight;
    inverse_depth += weight / max(depth, near_far.x);
    normal_in_world += weight * texelFetch(layer_normal, min(texel, textureSize(layer_normal, 0) - 1), 0).xyz;
  }
  // Whole samples, a little less than k / n each: drivers round up, to the nearest, or dither.
  float samples = floor(samples_in_pixel * coverage + 0.51);
  if (samples < 1.0) discard;
  vec3 normal = mat3(cam_from_world) * normal_in_world;
  bool unknown = dot(normal, normal) < 0.25 * kept * kept;
  for (int i = unknown ? 0 : 1; i < 1; ++i) {
    normal = cross(Slope(surface_texel, surface, ivec2(0, 1)), Slope(surface_texel, surface, ivec2(1, 0)));
  }
  normal = normalize(normal);
  vec4 seen = vec4(0.0);  // by cameras; the colour times its trust
  for (int i = has_camera_color ? texels.x : texels.y; i < texels.y; ++i) {
    ivec2 texel = middle + ivec2(i % 3 - 1, i / 3 - 1);
    float depth = DepthAt(texel);
    bool is_kept = depth > 0.0 && abs(depth - surface) <= same_surface * surface;
    vec4 there = texelFetch(layer_camera_color, min(texel, textureSize(layer_camera_color, 0) - 1), 0);
    seen += (is_kept ? weight_x[i % 3] * weight_y[i / 3] / kept : 0.0) * vec4(there.rgb * there.a, there.a);
  }
  float depth = kept / inverse_depth;
  vec3 x = depth * Ray(gl_FragCoord.xy);
  vec3 to_eye = -normalize(x);
  float part_light = PartLight(x, normal);
  float light = part_light * HullLight(x, normal, kHullSlackMm);
  float facing = abs(dot(normal, to_eye));
  vec3 base = color * mix(vec3(0.72, 0.60, 0.56), vec3(1.0), smoothstep(0.0, 0.55, facing));
  vec3 shown = Lit(base, x, normal, 0.05, light);
  if (is_flat) shown = color * mix(kUnlit, 1.0, light);
  // A camera's picture has the room's light in it; what virtual parts keep away is missing from that.
  shown = mix(shown, vec3(0.0), seen.a) + seen.rgb * mix(kUnlit, 1.0, part_light);
  pixel = vec4(shown, samples / samples_in_pixel - 0.01);
  gl_FragDepth = BufferDepth(depth);
}
)";

bool ShowsCameraColor(const Scene& scene) {
  return HasPixelColors(scene.hull_appearance) && !scene.hull_camera_color.empty();
}

// The picture's rows and columns that the layer's hits can reach, as glScissor takes them.
struct Window {
  GLint x = 0;
  GLint y = 0;
  GLsizei width = 0;
  GLsizei height = 0;
};

Window ReachOf(const HullView& layer, const SceneView& view) {
  int x0 = layer.width_px, x1 = -1, y0 = layer.height_px, y1 = -1;
  const float* depth_mm = layer.depth_mm.data();
  for (int y = 0; y < layer.height_px; ++y, depth_mm += layer.width_px) {
    const float* end = depth_mm + layer.width_px;
    const auto is_hit = [](float value) { return value > 0.0F; };
    const float* first = std::find_if(depth_mm, end, is_hit);
    if (first == end) continue;
    while (!is_hit(end[-1])) --end;
    x0 = std::min(x0, static_cast<int>(first - depth_mm));
    x1 = std::max(x1, static_cast<int>(end - 1 - depth_mm));
    y0 = std::min(y0, y);
    y1 = y;
  }
  if (x1 < 0) return {};
  // One texel more on each side, for the soft rim; the scissor may reach over the picture's edge.
  const auto begin = [](int texel, int view_px, int layer_px) {
    return static_cast<GLint>(std::floor((texel - 1.0) * view_px / layer_px));
  };
  const auto end = [](int texel, int view_px, int layer_px) {
    return static_cast<GLint>(std::ceil((texel + 2.0) * view_px / layer_px));
  };
  const GLint left = begin(x0, view.width_px, layer.width_px);
  const GLint top = begin(y0, view.height_px, layer.height_px);
  return {left, top, end(x1, view.width_px, layer.width_px) - left,
          end(y1, view.height_px, layer.height_px) - top};
}

}  // namespace

HullPainter::HullPainter()
    : picture_program_("hull", kHullVertexSource,
                       fmt::format("{}{}{}", kLightingSource, kLayerSource, kPictureFragmentSource)),
      depth_program_("hull depth", kHullVertexSource, fmt::format("{}{}", kLayerSource, kHullDepthSource)) {}

void HullPainter::UploadSurface(const Scene& scene) {
  const HullView& layer = *scene.hull;
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "normals upload as packed floats");
  const Eigen::Vector3f unknown = Eigen::Vector3f::Zero();
  if (layer.normal_in_world.empty()) {
    normal_.Upload(1, 1, {unknown.data(), 3});
  } else {
    normal_.Upload(layer.width_px, layer.height_px,
                   {layer.normal_in_world.front().data(), 3 * layer.normal_in_world.size()});
  }
  if (ShowsCameraColor(scene)) {
    camera_color_.Upload(layer.width_px, layer.height_px, scene.hull_camera_color);
  } else {
    camera_color_.Upload(1, 1, std::vector<CameraColor>(1));
  }
}

void HullPainter::Draw(const Scene& scene, const ViewMatrices& matrices, const Lighting& light) {
  UploadSurface(scene);
  picture_program_.Use();
  picture_program_.Set("layer_normal", kNormalUnit);
  picture_program_.Set("focal_px", static_cast<float>(matrices.view.focal_px));
  // With a long lens the eye is far away, and the same thickness is a smaller share of its distance.
  picture_program_.Set("same_surface", static_cast<float>(std::min(0.02, 50.0 / matrices.view.focal_px)));
  // A layer as fine as a picture without smooth edges needs no mixing of texels.
  const bool is_one = scene.smoothness == Smoothness::kOneSample &&
                      scene.hull->width_px == matrices.view.width_px &&
                      scene.hull->height_px == matrices.view.height_px;
  picture_program_.Set("texels", is_one ? Eigen::Vector2i(4, 5) : Eigen::Vector2i(0, 9));
  picture_program_.Set("samples_in_pixel", scene.smoothness == Smoothness::kFourSamples ? 4.0F : 1.0F);
  picture_program_.Set("cam_from_world", matrices.cam_from_world);
  picture_program_.Set("color", scene.hull_color);
  picture_program_.Set("is_flat", scene.hull_appearance == HullAppearance::kFlat ? 1 : 0);
  picture_program_.Set("has_camera_color", ShowsCameraColor(scene) ? 1 : 0);
  picture_program_.Set("layer_camera_color", kCameraColorUnit);
  light.Apply(picture_program_, matrices);
  glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  DrawWith(picture_program_, *scene.hull, matrices.view);
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void HullPainter::DrawDepth(const HullView& layer, const ViewMatrices& matrices) {
  depth_program_.Use();
  DrawWith(depth_program_, layer, matrices.view);
}

void HullPainter::DrawWith(const ShaderProgram& program, const HullView& layer, const SceneView& view) {
  const Window reach = ReachOf(layer, view);
  if (reach.width == 0) return;
  depth_.Upload(layer.width_px, layer.height_px, layer.depth_mm);
  depth_.BindTo(kDepthUnit);
  normal_.BindTo(kNormalUnit);
  camera_color_.BindTo(kCameraColorUnit);
  program.Set("layer_depth", kDepthUnit);
  program.Set("view_size",
              Eigen::Vector2f(static_cast<float>(view.width_px), static_cast<float>(view.height_px)));
  program.Set("near_far", Eigen::Vector2f(static_cast<float>(view.near_mm), static_cast<float>(view.far_mm)));
  glEnable(GL_SCISSOR_TEST);
  glScissor(reach.x, reach.y, reach.width, reach.height);
  corners_.Draw(GL_TRIANGLES, 3);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace elbowroom::recon::gl
