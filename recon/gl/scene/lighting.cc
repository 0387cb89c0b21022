#include "recon/gl/scene/lighting.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace elbowroom::recon::gl {
namespace {

// Beside those of the painters, which count from 0.
constexpr int kPartShadowUnit = 6;
constexpr int kHullShadowUnit = 7;

// Depth-buffer values of the layer, as ViewMatrices' clip space has them.
std::vector<float> BufferDepths(const HullView& layer, const SceneView& view) {
  std::vector<float> values(layer.depth_mm.size(), 1.0F);
  const double scale = view.far_mm / (view.far_mm - view.near_mm);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double depth_mm = layer.depth_mm[i];
    if (depth_mm <= 0.0) continue;
    values[i] = static_cast<float>(std::clamp(scale * (1.0 - view.near_mm / depth_mm), 0.0, 1.0));
  }
  return values;
}

// Around the texels with hits, in shares of the layer's sides.
Eigen::AlignedBox2f BoundsOfHits(const HullView& layer) {
  Eigen::AlignedBox2f bounds;
  const auto side = static_cast<float>(layer.width_px);
  for (int y = 0; y < layer.height_px; ++y) {
    const auto row = layer.depth_mm.begin() + std::ptrdiff_t{y} * layer.width_px;
    const auto is_hit = [](float depth_mm) { return depth_mm > 0.0F; };
    const auto first = std::find_if(row, row + layer.width_px, is_hit);
    if (first == row + layer.width_px) continue;
    const auto end = std::find_if(std::make_reverse_iterator(row + layer.width_px),
                                  std::make_reverse_iterator(row), is_hit)
                         .base();
    bounds.extend(Eigen::Vector2f(static_cast<float>(first - row), static_cast<float>(y)) / side);
    bounds.extend(Eigen::Vector2f(static_cast<float>(end - row), static_cast<float>(y + 1)) / side);
  }
  return bounds;
}

// For a shader's inside test; an empty box has nothing inside.
Eigen::Vector4f CornersOf(const Eigen::AlignedBox2f& box) {
  if (box.isEmpty()) return {2.0F, 2.0F, -2.0F, -2.0F};
  return {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
}

}  // namespace

// Reaching() averages comparisons over a square of 3 texels, interpolated between its places: weights 1 - f,
// 1, 1, f an axis over 4 texels, f the place's fraction, in two look-ups of two texels each. Every look-up
// compares with the depth that the receiving plane has there; its texels are at most one texel away from it,
// so that the plane's own slope a texel, in both axes, is the bias that it needs (docs/appearance.md).
const char* const kLightingSource = R"(
uniform vec3 up_in_cam;
uniform vec3 lamp_in_cam;
uniform mat4 lamp_from_cam;
uniform vec3 lamp_optics;  // focal length as a share of the shadow's side; near, far in mm
uniform sampler2DShadow part_shadow;
uniform sampler2DShadow hull_shadow;
uniform vec4 part_bounds;  // of what throws shadows: left, upper, right, lower, in shares of the map
uniform vec4 hull_bounds;

// What is left of a surface's light in the lamp's shadow, where nothing is known of its direction.
const float kUnlit = 0.65;
const float kSteepest = 16.0;  // slopes beyond are cut off: the lamp grazes the surface and hardly lights it

float LampBufferDepth(float depth) {
  return lamp_optics.z / (lamp_optics.z - lamp_optics.y) * (1.0 - lamp_optics.y / max(depth, lamp_optics.y));
}

struct Plane {
  vec2 place;   // texels; centres at integers
  float depth;  // there, less the bias
  vec2 slope;   // a texel
  float side;   // of the map
};
float Look(sampler2DShadow shadow, Plane plane, vec2 offset) {
  float reference = min(LampBufferDepth(plane.depth + dot(plane.slope, offset)), 1.0);
  return textureLod(shadow, vec3((plane.place + offset + 0.5) / plane.side, reference), 0.0);
}

float Reaching(sampler2DShadow shadow, vec4 bounds, vec3 x, vec3 normal, float slack_mm) {
  vec3 x_in_lamp = (lamp_from_cam * vec4(x, 1.0)).xyz;
  vec3 n_in_lamp = mat3(lamp_from_cam) * normal;
  float side = float(textureSize(shadow, 0).x);
  float mm_per_texel = x_in_lamp.z / (lamp_optics.x * side);
  vec2 slope = -x_in_lamp.z * n_in_lamp.xy / dot(n_in_lamp, x_in_lamp);
  slope = mm_per_texel * clamp(slope, -kSteepest, kSteepest);
  float depth = x_in_lamp.z - abs(slope.x) - abs(slope.y) - slack_mm;
  vec2 share = lamp_optics.x * x_in_lamp.xy / x_in_lamp.z + 0.5;
  vec4 margins = vec4(share - bounds.xy, bounds.zw - share);
  bool may_be_shaded = x_in_lamp.z > 0.0 && all(greaterThan(margins, vec4(-2.0 / side)));
  vec2 place = side * share - 0.5;
  vec2 f = fract(place);
  vec2 weight0 = 2.0 - f, weight1 = 1.0 + f;
  vec2 offset0 = 1.0 / weight0 - 1.0 - f, offset1 = f / weight1 + 1.0 - f;
  float light = 1.0;
  for (int i = may_be_shaded ? 0 : 1; i < 1; ++i) {
    Plane plane = Plane(place, depth, slope, side);
    vec2 left = vec2(Look(shadow, plane, offset0), Look(shadow, plane, vec2(offset0.x, offset1.y)));
    vec2 right = vec2(Look(shadow, plane, vec2(offset1.x, offset0.y)), Look(shadow, plane, offset1));
    light = dot(weight0.x * left + weight1.x * right, vec2(weight0.y, weight1.y)) / 9.0;
  }
  return light;
}

float PartLight(vec3 x, vec3 normal) { return Reaching(part_shadow, part_bounds, x, normal, 0.3); }
float HullLight(vec3 x, vec3 normal, float slack_mm) {
  return Reaching(hull_shadow, hull_bounds, x, normal, slack_mm);
}

vec3 Lit(vec3 color, vec3 x, vec3 normal, float gloss, float light) {
  vec3 to_eye = -normalize(x);
  vec3 to_lamp = normalize(lamp_in_cam - x);
  vec3 n = dot(normal, to_eye) < 0.0 ? -normal : normal;
  vec3 ambient = mix(vec3(0.38, 0.365, 0.36), vec3(0.52, 0.54, 0.56), 0.5 + 0.5 * dot(n, up_in_cam));
  float key = light * max(dot(n, to_lamp), 0.0);
  float shine = light * smoothstep(0.0, 0.3, dot(n, to_lamp));  // none where the lamp grazes
  float head = max(dot(n, to_eye), 0.0);
  float highlight = shine * pow(max(dot(n, normalize(to_lamp + to_eye)), 0.0), 40.0);
  return color * (ambient + 0.42 * key + 0.14 * head) + gloss * highlight;
}
)";

Lighting::Lighting() = default;

void Lighting::Update(const Scene& scene, PartPainter& parts) {
  if (!(scene.lamp == lamp_)) {
    lamp_ = scene.lamp;
    has_part_shadow_ = has_hull_shadow_ = false;
  }
  UpdatePartShadow(scene, parts);
  UpdateHullShadow(scene);
}

bool Lighting::CastersAre(const std::vector<Caster>& now) const {
  return std::equal(
      now.begin(), now.end(), casters_.begin(), casters_.end(), [](const Caster& a, const Caster& b) {
        return a.mesh.lock() == b.mesh.lock() && a.world_from_part == b.world_from_part && a.level == b.level;
      });
}

void Lighting::UpdatePartShadow(const Scene& scene, PartPainter& parts) {
  std::vector<Caster> casters;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart& part = scene.parts[i];
    if (part.opacity > 0.0F && !part.is_decal)
      casters.push_back({part.mesh, part.world_from_part, parts.levels().at(i)});
  }
  if (has_part_shadow_ && CastersAre(casters)) {
    ++count_.kept_part_passes;
    return;
  }
  part_shadow_.BeginDrawing(scene.lamp.part_shadow_px);
  const CasterPass pass =
      parts.DrawCasters(scene.parts, MatricesOf(scene.lamp.ShadowView(scene.lamp.part_shadow_px)));
  part_bounds_ = pass.bounds;
  count_.parts_outside_lamp += pass.parts_outside;
  casters_ = std::move(casters);
  has_part_shadow_ = true;
  ++count_.part_passes;
}

void Lighting::UpdateHullShadow(const Scene& scene) {
  if (has_hull_shadow_ && hull_from_lamp_.lock() == scene.hull_from_lamp) {
    ++count_.kept_hull_uploads;
    return;
  }
  if (scene.hull_from_lamp == nullptr) {
    hull_shadow_.Upload(1, std::vector<float>{1.0F});
    hull_bounds_.setEmpty();
    hull_reach_ = {};
  } else {
    const HullView& layer = *scene.hull_from_lamp;
    hull_bounds_ = BoundsOfHits(layer);
    hull_reach_ = ShadowReach(layer);
    hull_shadow_.Upload(layer.width_px, BufferDepths(layer, scene.lamp.ShadowView(layer.width_px)));
  }
  hull_from_lamp_ = scene.hull_from_lamp;
  has_hull_shadow_ = true;
  ++count_.hull_uploads;
}

void Lighting::Apply(const ShaderProgram& program, const ViewMatrices& matrices,
                     HullShadow hull_shadow) const {
  const SceneView shadow_view = lamp_.ShadowView(1);
  const core::RigidTransform lamp_from_cam =
      shadow_view.cam_from_world * matrices.view.cam_from_world.Inverse();
  const Eigen::Vector3d lamp_in_cam = matrices.view.cam_from_world * lamp_.position_in_world;
  program.Set("up_in_cam", matrices.up_in_cam);
  program.Set("lamp_in_cam", Eigen::Vector3f(lamp_in_cam.cast<float>()));
  program.Set("lamp_from_cam", ToMatrix4f(lamp_from_cam));
  program.Set(
      "lamp_optics",
      Eigen::Vector3f(
          Eigen::Vector3d(shadow_view.focal_px, shadow_view.near_mm, shadow_view.far_mm).cast<float>()));
  part_shadow_.BindTo(kPartShadowUnit);
  hull_shadow_.BindTo(kHullShadowUnit);
  program.Set("part_bounds", CornersOf(part_bounds_));
  program.Set("hull_bounds",
              CornersOf(hull_shadow == HullShadow::kThrown ? hull_bounds_ : Eigen::AlignedBox2f()));
  program.Set("part_shadow", kPartShadowUnit);
  program.Set("hull_shadow", kHullShadowUnit);
}

}  // namespace elbowroom::recon::gl
