#include "recon/gl/paper_methods/plane_sweep_shader.h"

#include <algorithm>

namespace elbowroom::recon::gl {
namespace {

constexpr GLuint kCountBits = 0x7F;

constexpr const char* kVertexSource = R"(
uniform float plane_depth;
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0,
                     2.0 * plane_depth - 1.0, 1.0);
}
)";

constexpr const char* kGridVertexSource = R"(
layout(location = 0) in vec2 place;
layout(location = 1) in vec3 position;
uniform float plane_depth;
out vec3 picture_position;
void main() {
  picture_position = position;
  gl_Position = vec4(2.0 * place - 1.0, 2.0 * plane_depth - 1.0, 1.0);
}
)";

constexpr const char* kViewportVertexSource = R"(
layout(location = 0) in vec2 page_position;
layout(location = 1) in vec2 viewport_corner;
layout(location = 2) in vec3 origin;
layout(location = 3) in vec3 along_x;
layout(location = 4) in vec3 along_y;
uniform vec2 page_px;
uniform mat3 rotation;
uniform vec3 translation;
flat out vec2 corner;
flat out mat3 world_from_ray;
flat out mat3 from_ray_0;
void main() {
  corner = viewport_corner;
  world_from_ray = mat3(along_x, along_y, origin);
  from_ray_0 = mat3(rotation * along_x, rotation * along_y, rotation * origin + translation);
  gl_Position = vec4(2.0 * page_position / page_px - 1.0, 0.0, 1.0);
}
)";

// Camera `@` of the group; `$` is where its matrix comes from. Positions count from its coverage's first
// texel.
constexpr const char* kCameraSource = R"(
$ mat3 from_ray_@;         // ideal: to picture positions, homogeneous; else to cam
uniform sampler2D mask_@;
uniform vec2 texel_@;      // 1 / size of mask_@
uniform vec2 valid_min_@;
uniform vec2 valid_max_@;
uniform vec2 picture_min_@;
uniform vec2 picture_max_@;
)";

constexpr const char* kLensSource = R"(
uniform mat3 picture_from_normalised_@;
uniform float max_radius_squared_@;
uniform vec3 radial_a_@;
uniform vec3 radial_b_@;
uniform vec4 prism_@;
uniform vec2 tangential_@;
)";

constexpr const char* kIdealPositionSource = R"(
vec2 Position_@(vec3 ray, out bool in_domain) {
  vec3 h = from_ray_@ * ray;
  in_domain = h.z > 0.0;
  return h.xy / h.z;
}
)";

constexpr const char* kGridPositionSource = R"(
in vec3 picture_position;
vec2 Position_@(vec3 ray, out bool in_domain) {
  in_domain = picture_position.z > 0.0;
  return in_domain ? picture_position.xy / picture_position.z : vec2(0.0);
}
)";

constexpr const char* kPolynomialPositionSource = R"(
vec2 Position_@(vec3 ray, out bool in_domain) {
  vec3 h = from_ray_@ * ray;
  vec2 x = h.xy / h.z;
  float r2 = dot(x, x);
  in_domain = h.z > 0.0 && r2 <= max_radius_squared_@;
  vec3 powers = vec3(1.0, r2, r2 * r2) * r2;
  float scale = (1.0 + dot(radial_a_@, powers)) / (1.0 + dot(radial_b_@, powers));
  vec2 off = 2.0 * x.x * x.y * tangential_@ + tangential_@.yx * (r2 + 2.0 * x * x) +
             r2 * prism_@.xz + r2 * r2 * prism_@.yw;
  return (picture_from_normalised_@ * vec3(x * scale + off, 1.0)).xy;
}
)";

constexpr const char* kFisheyePositionSource = R"(
vec2 Position_@(vec3 ray, out bool in_domain) {
  vec3 h = from_ray_@ * ray;
  vec2 x = h.xy / h.z;
  float r2 = dot(x, x);
  in_domain = h.z > 0.0 && r2 <= max_radius_squared_@;
  float r = sqrt(r2), theta = atan(r), t2 = theta * theta;
  float series = 1.0 + t2 * (radial_a_@.x + t2 * (radial_a_@.y + t2 * (radial_a_@.z + t2 * radial_b_@.x)));
  float scale = r2 > 1e-12 ? theta * series / r : 1.0;
  return (picture_from_normalised_@ * vec3(x * scale, 1.0)).xy;
}
)";

constexpr const char* kAnswerSource = R"(
bool IsWithin(vec2 p, vec2 lower, vec2 upper) {
  return all(greaterThanEqual(p, lower)) && all(lessThan(p, upper));
}
)";

constexpr const char* kCameraAnswerSource = R"(
bool IsObject_@(vec3 ray, out bool is_seen) {
  bool in_domain;
  vec2 p = Position_@(ray, in_domain);
  is_seen = in_domain && IsWithin(p, picture_min_@, picture_max_@);
  return in_domain && IsWithin(p, valid_min_@, valid_max_@) &&
         textureLod(mask_@, (p + 0.5) * texel_@, 0.0).r >= 0.5;
}
)";

constexpr const char* kRaySource = R"(
uniform mat3 ray_from_pixel;
vec3 Ray() { return ray_from_pixel * vec3(gl_FragCoord.xy - 0.5, 1.0); }
)";

constexpr const char* kRayTextureSource = R"(
uniform sampler2D rays;  // z: 1, or 0 where the lens has no ray
vec3 Ray() { return texelFetch(rays, ivec2(gl_FragCoord.xy), 0).xyz; }
)";

constexpr const char* kViewportRaySource = R"(
flat in vec2 corner;
vec3 Ray() { return vec3(gl_FragCoord.xy - corner, 1.0); }
)";

constexpr const char* kWorkspaceSource = R"(
$ mat3 world_from_ray;
uniform vec3 workspace_min;
uniform vec3 workspace_max;
bool InWorkspace(vec3 ray) {
  vec3 x = world_from_ray * ray;
  return all(greaterThanEqual(x, workspace_min)) && all(lessThanEqual(x, workspace_max));
}
)";

std::string Replaced(std::string text, char place, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(place, at)) != std::string::npos;) text.replace(at, 1, by);
  return text;
}

std::string ForCamera(const std::string& text, std::size_t index) {
  return Replaced(text, '@', std::to_string(index));
}

const char* RaySourceText(SweepRaySource source) {
  switch (source) {
    case SweepRaySource::kIdealView:
      return kRaySource;
    case SweepRaySource::kRayTexture:
      return kRayTextureSource;
    case SweepRaySource::kViewport:
      break;
  }
  return kViewportRaySource;
}

std::string CameraSource(const core::CameraModel& camera, bool has_grid_positions, std::size_t index) {
  std::string source = kCameraSource;
  if (has_grid_positions) {
    source += kGridPositionSource;
  } else if (camera.is_ideal()) {
    source += kIdealPositionSource;
  } else {
    const bool is_fisheye = camera.calibration().distortion_model == core::DistortionModel::kFisheye;
    source += kLensSource;
    source += is_fisheye ? kFisheyePositionSource : kPolynomialPositionSource;
  }
  return ForCamera(source + kCameraAnswerSource, index);
}

}  // namespace

std::string SweepVertexSource() { return kVertexSource; }

std::string GridVertexSource() { return kGridVertexSource; }

std::string ViewportVertexSource() { return kViewportVertexSource; }

std::string SweepShader::FragmentSource() const {
  if (pass == SweepPass::kPlane) return "void main() {}\n";
  std::string source = RaySourceText(ray_source);
  source += kAnswerSource;
  for (std::size_t i = 0; i < group.size(); ++i)
    source += CameraSource(group[i].model, has_grid_positions, i);
  if (tests_workspace) source += kWorkspaceSource;
  source = Replaced(source, '$', ray_source == SweepRaySource::kViewport ? "flat in" : "uniform");
  source +=
      "void main() {\n  vec3 ray = Ray();\n  bool kept = ray.z > 0.0, any_seen = false, is_seen, "
      "is_object;\n";
  if (tests_workspace) source += "  kept = kept && InWorkspace(ray);\n";
  for (std::size_t i = 0; i < group.size(); ++i) {
    source += ForCamera("  is_object = IsObject_@(ray, is_seen);\n  any_seen = any_seen || is_seen;\n", i);
    if (pass == SweepPass::kSeen) continue;
    source +=
        exterior_is_object ? "  kept = kept && (is_object || !is_seen);\n" : "  kept = kept && is_object;\n";
  }
  const bool must_be_seen = pass == SweepPass::kSeen || (pass == SweepPass::kHull && exterior_is_object);
  source += must_be_seen ? "  if (!(kept && any_seen)) discard;\n}\n" : "  if (!kept) discard;\n}\n";
  return source;
}

Eigen::Matrix3d PictureFromNormalised(const SweepCamera& camera) {
  Eigen::Matrix3d matrix = camera.model.calibration().camera_matrix;
  matrix(0, 2) -= camera.coverage.left_px;
  matrix(1, 2) -= camera.coverage.top_px;
  return matrix;
}

void SetWorkspace(const ShaderProgram& program, const Eigen::AlignedBox3d& workspace_mm) {
  program.Set("workspace_min", Eigen::Vector3f(workspace_mm.min().cast<float>()));
  program.Set("workspace_max", Eigen::Vector3f(workspace_mm.max().cast<float>()));
}

void SetCamera(const ShaderProgram& program, const SweepCamera& camera, std::size_t index) {
  const core::CameraCalibration& c = camera.model.calibration();
  const CoverageTexture& coverage = camera.coverage;
  const auto set = [&](const std::string& name, const auto& value) {
    program.Set((name + "_" + std::to_string(index)).c_str(), value);
  };
  const Eigen::Vector2d first(coverage.left_px, coverage.top_px);
  const auto relative = [&](const Eigen::Vector2d& p) { return Eigen::Vector2f((p - first).cast<float>()); };
  set("mask", static_cast<int>(index));
  set("texel", Eigen::Vector2f(1.0F / static_cast<float>(std::max(coverage.width_texels, 1)),
                               1.0F / static_cast<float>(std::max(coverage.height_texels, 1))));
  set("valid_min", relative(coverage.valid_px.min()));
  set("valid_max", relative(coverage.valid_px.max()));
  set("picture_min", relative(Eigen::Vector2d::Constant(-0.5)));
  set("picture_max", relative({c.image_width_px - 0.5, c.image_height_px - 0.5}));
  if (camera.model.is_ideal()) return;
  const SweepLensCoefficients lens = LensCoefficientsOf(camera.model);
  set("picture_from_normalised", Eigen::Matrix3f(PictureFromNormalised(camera).cast<float>()));
  set("max_radius_squared", static_cast<float>(camera.model.max_radius() * camera.model.max_radius()));
  set("radial_a", Eigen::Vector3f(lens.radial[0], lens.radial[1], lens.radial[2]));
  set("radial_b", Eigen::Vector3f(lens.radial[3], lens.radial[4], lens.radial[5]));
  set("prism", Eigen::Vector4f(lens.prism[0], lens.prism[1], lens.prism[2], lens.prism[3]));
  set("tangential", Eigen::Vector2f(lens.tangential[0], lens.tangential[1]));
}

void SetStencil(SweepPass kind, GLuint wanted) {
  switch (kind) {
    case SweepPass::kHull:
      glDisable(GL_STENCIL_TEST);
      glDepthMask(GL_TRUE);
      return;
    case SweepPass::kObject:
      glStencilFunc(GL_ALWAYS, 0, ~0U);
      glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
      glStencilMask(kCountBits);
      glDepthMask(GL_FALSE);
      return;
    case SweepPass::kSeen:
      glStencilFunc(GL_ALWAYS, static_cast<GLint>(kSeenBit), ~0U);
      glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
      glStencilMask(kSeenBit);
      glDepthMask(GL_FALSE);
      return;
    case SweepPass::kPlane:
      glStencilFunc(GL_EQUAL, static_cast<GLint>(wanted), ~0U);
      glStencilOp(GL_ZERO, GL_KEEP, GL_KEEP);
      glStencilMask(~0U);
      glDepthMask(GL_TRUE);
      return;
  }
}

}  // namespace elbowroom::recon::gl
