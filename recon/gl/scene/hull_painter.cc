#include "recon/gl/scene/hull_painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "recon/gl/scene/lighting.h"

namespace elbowroom::recon::gl {
namespace {

constexpr int kDepthUnit = 0;
constexpr int kNormalUnit = 1;
constexpr int kCameraColorUnit = 2;

// Access to the layer's depth, for both ways of drawing.
constexpr const char* kLayerSource = R"(
uniform sampler2D layer_depth;
uniform vec2 view_size;
uniform vec2 near_far;
uniform ivec2 layer_size;
float DepthAt(ivec2 texel) {
  bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, layer_size));
  float depth = texelFetch(layer_depth, clamp(texel, ivec2(0), layer_size - 1), 0).r;
  return inside ? depth : 0.0;
}
vec2 PlaceInLayer() { return gl_FragCoord.xy * vec2(layer_size) / view_size; }
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

// The colour of a place of the hull's surface, for both pictures. Where there is nothing to do, a loop has no
// turn: it stands in for an if, of which software drivers step through both sides.
constexpr const char* kLookSource = R"(
uniform sampler2D layer_normal;
uniform sampler2D layer_camera_color;
uniform bool has_normals;
uniform bool has_camera_color;
uniform bool is_flat;
uniform float focal_px;
uniform mat4 cam_from_world;
uniform vec3 color;
out vec4 pixel;

// The hull in the shadow's map stands this near to the same hull in the picture, whatever their sizes.
const float kHullSlackMm = 3.0;

vec3 Ray(vec2 window) { return vec3((window - 0.5 * view_size) / focal_px, 1.0); }
vec3 PointAt(ivec2 texel, float depth) {
  return depth * Ray((vec2(texel) + 0.5) * view_size / vec2(layer_size));
}
vec3 NormalInWorld(ivec2 texel) {
  return has_normals ? texelFetch(layer_normal, min(texel, layer_size - 1), 0).xyz : vec3(0.0);
}
// Of the cameras; the colour times its trust.
vec4 CameraColor(ivec2 texel) {
  vec4 there = texelFetch(layer_camera_color, min(texel, textureSize(layer_camera_color, 0) - 1), 0);
  return vec4(there.rgb * there.a, there.a);
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

// normal: as the layer has it, in camera axes; `is_unknown`: it is taken from the depths around the texel.
// seen: by cameras, as CameraColor.
vec3 Shown(float depth, vec3 normal, bool is_unknown, ivec2 texel, float texel_depth, vec4 seen) {
  for (int i = is_unknown ? 0 : 1; i < 1; ++i) {
    normal = cross(Slope(texel, texel_depth, ivec2(0, 1)), Slope(texel, texel_depth, ivec2(1, 0)));
  }
  normal = normalize(normal);
  vec3 x = depth * Ray(gl_FragCoord.xy);
  vec3 to_eye = -normalize(x);
  // A shaded surface that is turned away from the lamp has no use for its light.
  float turned = dot(normal, lamp_in_cam - x) * dot(normal, to_eye);
  bool wants_light = turned > 0.0 || is_flat || has_camera_color;
  float part_light = 0.0, light = 0.0;
  for (int i = wants_light ? 0 : 1; i < 1; ++i) {
    part_light = PartLight(x, normal);
    light = part_light * HullLight(x, normal, kHullSlackMm);
  }
  float facing = abs(dot(normal, to_eye));
  vec3 base = color * mix(vec3(0.72, 0.60, 0.56), vec3(1.0), smoothstep(0.0, 0.55, facing));
  vec3 shown = is_flat ? color * mix(kUnlit, 1.0, light) : Lit(base, x, normal, 0.05, light);
  // A camera's picture has the room's light in it; what virtual parts keep away is missing from that.
  return mix(shown, vec3(0.0), seen.a) + seen.rgb * mix(kUnlit, 1.0, part_light);
}
)";

// Of a layer as fine as the picture, in a picture without smooth edges: each pixel takes its texel.
constexpr const char* kTexelSource = R"(
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(layer_depth, texel, 0).r;
  if (depth <= 0.0) discard;
  vec3 normal = mat3(cam_from_world) * NormalInWorld(texel);
  vec4 seen = has_camera_color ? CameraColor(texel) : vec4(0.0);
  pixel = vec4(Shown(depth, normal, dot(normal, normal) < 0.25, texel, depth, seen), 1.0);
  gl_FragDepth = BufferDepth(depth);
}
)";

constexpr const char* kSplineSource = R"(
uniform float samples_in_pixel;
uniform float same_surface;  // surfaces whose depths differ by more than this share are not one surface

// Weights of the texels at -1, 0, 1 for a place `offset` in [-0.5, 0.5] from the middle one.
vec3 Spline(float offset) {
  return vec3(0.5 * (0.5 - offset) * (0.5 - offset), 0.75 - offset * offset,
              0.5 * (0.5 + offset) * (0.5 + offset));
}

void main() {
  vec2 place = PlaceInLayer();
  ivec2 middle = ivec2(place);
  ivec2 surface_texel = middle;
  float surface = DepthAt(middle);
  for (int i = surface > 0.0 ? 9 : 0; i < 9; ++i) {
    ivec2 texel = middle + ivec2(i % 3 - 1, i / 3 - 1);
    float depth = DepthAt(texel);
    bool nearer = depth > 0.0 && (surface <= 0.0 || depth < surface);
    surface = nearer ? depth : surface;
    surface_texel = nearer ? texel : surface_texel;
  }
  vec2 offset = place - vec2(middle) - 0.5;
  vec3 weight_x = Spline(offset.x), weight_y = Spline(offset.y);
  float coverage = 0.0, kept = 0.0, inverse_depth = 0.0;
  vec3 normal_in_world = vec3(0.0);
  vec4 seen = vec4(0.0);
  for (int i = surface > 0.0 ? 0 : 9; i < 9; ++i) {
    ivec2 texel = middle + ivec2(i % 3 - 1, i / 3 - 1);
    float depth = DepthAt(texel);
    float weight = depth > 0.0 ? weight_x[i % 3] * weight_y[i / 3] : 0.0;
    coverage += weight;
    weight = abs(depth - surface) <= same_surface * surface ? weight : 0.0;
    kept += weight;
    inverse_depth += weight / max(depth, near_far.x);
    normal_in_world += weight * NormalInWorld(texel);
    seen += has_camera_color ? weight * CameraColor(texel) : vec4(0.0);
  }
  // Whole samples, a little less than k / n each: drivers round up, to the nearest, or dither.
  float samples = floor(samples_in_pixel * coverage + 0.51);
  if (samples < 1.0) discard;
  vec3 normal = mat3(cam_from_world) * normal_in_world;
  bool is_unknown = dot(normal, normal) < 0.25 * kept * kept;
  float depth = kept / inverse_depth;
  vec3 shown = Shown(depth, normal, is_unknown, surface_texel, surface, seen / kept);
  pixel = vec4(shown, samples / samples_in_pixel - 0.01);
  gl_FragDepth = BufferDepth(depth);
}
)";

bool ShowsCameraColor(const Scene& scene) {
  return HasPixelColors(scene.hull_appearance) && !scene.hull_camera_color.empty();
}

}  // namespace

HullPainter::HullPainter()
    : texel_program_("hull", kSquareVertexSource,
                     fmt::format("{}{}{}{}", kLightingSource, kLayerSource, kLookSource, kTexelSource)),
      spline_program_("hull with a soft rim", kSquareVertexSource,
                      fmt::format("{}{}{}{}", kLightingSource, kLayerSource, kLookSource, kSplineSource)),
      depth_program_("hull depth", kSquareVertexSource, fmt::format("{}{}", kLayerSource, kHullDepthSource)) {
}

void HullPainter::UploadSurface(const Scene& scene, const TexelBox& texels) {
  const HullView& layer = *scene.hull;
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "normals upload as packed floats");
  if (!layer.normal_in_world.empty()) {
    normal_.MakeRoom(scene.RoomPx(layer.width_px, layer.height_px));
    normal_.UploadWithin(layer.width_px, layer.height_px,
                         {layer.normal_in_world.front().data(), 3 * layer.normal_in_world.size()}, texels);
  }
  if (ShowsCameraColor(scene)) {
    camera_color_.Upload(layer.width_px, layer.height_px, scene.hull_camera_color);
  } else {
    camera_color_.Upload(1, 1, std::vector<CameraColor>(1));
  }
}

void HullPainter::Draw(const Scene& scene, const ViewMatrices& matrices, const Lighting& light) {
  const HullView& layer = *scene.hull;
  const HitSquares squares = SquaresOfHits(layer, matrices.view);
  if (squares.count == 0) return;
  UploadSurface(scene, squares.texels);
  const bool is_by_texel = scene.smoothness == Smoothness::kOneSample &&
                           layer.width_px == matrices.view.width_px &&
                           layer.height_px == matrices.view.height_px;
  const ShaderProgram& program = is_by_texel ? texel_program_ : spline_program_;
  program.Use();
  if (!is_by_texel) {
    // With a long lens the eye is far away, and the same thickness is a smaller share of its distance.
    program.Set("same_surface", static_cast<float>(std::min(0.02, 50.0 / matrices.view.focal_px)));
    program.Set("samples_in_pixel", scene.smoothness == Smoothness::kFourSamples ? 4.0F : 1.0F);
  }
  program.Set("layer_normal", kNormalUnit);
  program.Set("focal_px", static_cast<float>(matrices.view.focal_px));
  program.Set("cam_from_world", matrices.cam_from_world);
  program.Set("color", scene.hull_color);
  program.Set("is_flat", scene.hull_appearance == HullAppearance::kFlat ? 1 : 0);
  program.Set("has_normals", layer.normal_in_world.empty() ? 0 : 1);
  program.Set("has_camera_color", ShowsCameraColor(scene) ? 1 : 0);
  program.Set("layer_camera_color", kCameraColorUnit);
  light.Apply(program, matrices);
  depth_.MakeRoom(scene.RoomPx(layer.width_px, layer.height_px));
  if (!is_by_texel) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  DrawWith(program, layer, matrices.view, squares);
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void HullPainter::DrawDepth(const HullView& layer, const ViewMatrices& matrices) {
  const HitSquares squares = SquaresOfHits(layer, matrices.view);
  if (squares.count == 0) return;
  depth_program_.Use();
  DrawWith(depth_program_, layer, matrices.view, squares);
}

void HullPainter::DrawWith(const ShaderProgram& program, const HullView& layer, const SceneView& view,
                           const HitSquares& squares) {
  depth_.UploadWithin(layer.width_px, layer.height_px, layer.depth_mm, squares.texels);
  depth_.BindTo(kDepthUnit);
  normal_.BindTo(kNormalUnit);
  camera_color_.BindTo(kCameraColorUnit);
  program.Set("layer_depth", kDepthUnit);
  program.Set("layer_size", Eigen::Vector2i(layer.width_px, layer.height_px));
  program.Set("view_size",
              Eigen::Vector2f(static_cast<float>(view.width_px), static_cast<float>(view.height_px)));
  program.Set("near_far", Eigen::Vector2f(static_cast<float>(view.near_mm), static_cast<float>(view.far_mm)));
  corners_.Upload(squares.corners, Refill::kEachFrame);
  corners_.Draw(GL_TRIANGLES);
}

}  // namespace elbowroom::recon::gl
