#include "recon/gl/scene/still_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "recon/gl/objects/gl_error.h"

namespace elbowroom::recon::gl {
namespace {

constexpr int kLitUnit = 0;
constexpr int kUnlitUnit = 1;
constexpr int kPlaceUnit = 2;
constexpr double kBelowTableMm = 1.0;  // that a part may reach down: what is left of it there is a few pixels

constexpr const char* kCornerSource = R"(
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

// Pixels that the hull leaves all light are as they were copied.
constexpr const char* kShadowSource = R"(
uniform sampler2D kept_lit;
uniform sampler2D kept_unlit;
uniform sampler2D kept_place;
uniform vec2 view_size;
uniform float focal_px;
out vec4 pixel;
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec3 place = texelFetch(kept_place, texel, 0).xyz;
  float depth = length(place);
  float light = 1.0;
  for (int i = depth > 0.0 ? 0 : 1; i < 1; ++i) {
    vec3 x = depth * vec3((gl_FragCoord.xy - 0.5 * view_size) / focal_px, 1.0);
    light = HullLight(x, place / depth, 0.3);
  }
  if (light >= 1.0) discard;
  pixel = mix(texelFetch(kept_unlit, texel, 0), texelFetch(kept_lit, texel, 0), light);
}
)";

void MakeTexture(GLuint texture, GLenum format, GLenum type, int width_px, int height_px, GLenum attachment) {
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width_px, height_px, 0, GL_RGBA, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void BindTexture(int unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture);
  glActiveTexture(GL_TEXTURE0);
}

template <typename Box>
bool AreSameBoxes(const std::optional<Box>& a, const std::optional<Box>& b) {
  return a.has_value() == b.has_value() && (!a || (a->min() == b->min() && a->max() == b->max()));
}

bool AreSameSurroundings(const Scene& a, const Scene& b) {
  return a.view == b.view && a.lamp == b.lamp && a.table_grid_mm == b.table_grid_mm &&
         AreSameBoxes(a.table_in_world, b.table_in_world) &&
         AreSameBoxes(a.workspace_in_world, b.workspace_in_world) && a.cameras == b.cameras &&
         a.background_top == b.background_top && a.background_bottom == b.background_bottom;
}

}  // namespace

StillLayer::Buffers::Buffers(int width, int height) : width_px(width), height_px(height) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  MakeTexture(lit.get(), GL_RGBA8, GL_UNSIGNED_BYTE, width, height, GL_COLOR_ATTACHMENT0);
  MakeTexture(unlit.get(), GL_RGBA8, GL_UNSIGNED_BYTE, width, height, GL_COLOR_ATTACHMENT1);
  MakeTexture(place.get(), GL_RGBA32F, GL_FLOAT, width, height, GL_COLOR_ATTACHMENT2);
  glBindRenderbuffer(GL_RENDERBUFFER, depth.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth.get());
  constexpr std::array<GLenum, 3> kAll{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glDrawBuffers(static_cast<GLsizei>(kAll.size()), kAll.data());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  ThrowUnlessDrawable(fmt::format("a picture's still parts of {} x {} pixels", width, height));
}

StillLayer::StillLayer()
    : shadow_program_("hull's shadow", kCornerSource, std::string(kLightingSource).append(kShadowSource)) {}

bool StillLayer::Suits(const Scene& scene, const PartPainter& parts) {
  return scene.smoothness == Smoothness::kOneSample && scene.view.EyeInWorld().z() >= 0.0 &&
         std::ranges::all_of(scene.parts, [&](const ScenePart& part) {
           return part.opacity < 1.0F || parts.LowestMm(part) >= -kBelowTableMm;
         });
}

StillLayer::Content StillLayer::ContentOf(const Scene& scene, const PartPainter& parts,
                                          const Lighting& light) {
  Content content;
  content.surroundings.view = scene.view;
  content.surroundings.lamp = scene.lamp;
  content.surroundings.table_in_world = scene.table_in_world;
  content.surroundings.table_grid_mm = scene.table_grid_mm;
  content.surroundings.workspace_in_world = scene.workspace_in_world;
  content.surroundings.cameras = scene.cameras;
  content.surroundings.background_top = scene.background_top;
  content.surroundings.background_bottom = scene.background_bottom;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart& part = scene.parts[i];
    if (part.opacity >= 1.0F)
      content.parts.push_back(
          {part.mesh, part.world_from_part, part.color, part.in_contact, parts.levels().at(i)});
  }
  content.part_passes = light.count().part_passes;
  return content;
}

bool StillLayer::AreSame(const Content& a, const Content& b) {
  const auto are_same_parts = [](const KeptPart& one, const KeptPart& other) {
    return one.mesh.lock() == other.mesh.lock() && one.world_from_part == other.world_from_part &&
           one.color == other.color && one.in_contact == other.in_contact && one.level == other.level;
  };
  return a.part_passes == b.part_passes && AreSameSurroundings(a.surroundings, b.surroundings) &&
         std::ranges::equal(a.parts, b.parts, are_same_parts);
}

bool StillLayer::Holds(const Scene& scene, const PartPainter& parts, const Lighting& light) const {
  return content_ && AreSame(*content_, ContentOf(scene, parts, light));
}

void StillLayer::BeginDrawing(const Scene& scene, const PartPainter& parts, const Lighting& light) {
  content_.reset();  // what is drawn from here on may fail
  if (!buffers_ || buffers_->width_px != scene.view.width_px || buffers_->height_px != scene.view.height_px) {
    buffers_.reset();
    buffers_.emplace(scene.view.width_px, scene.view.height_px);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, buffers_->framebuffer.get());
  glViewport(0, 0, buffers_->width_px, buffers_->height_px);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  content_ = ContentOf(scene, parts, light);
}

void StillLayer::ShowIn(const Framebuffer& target, const ViewMatrices& matrices,
                        const Lighting& light) const {
  const int width_px = buffers_->width_px, height_px = buffers_->height_px;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, buffers_->framebuffer.get());
  target.BindForDrawing();
  glBlitFramebuffer(0, 0, width_px, height_px, 0, 0, width_px, height_px,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, GL_NEAREST);
  target.Bind();
  if (!light.HullThrowsShadow()) return;
  shadow_program_.Use();
  light.Apply(shadow_program_, matrices);
  shadow_program_.Set("kept_lit", kLitUnit);
  shadow_program_.Set("kept_unlit", kUnlitUnit);
  shadow_program_.Set("kept_place", kPlaceUnit);
  shadow_program_.Set("view_size",
                      Eigen::Vector2f(static_cast<float>(width_px), static_cast<float>(height_px)));
  shadow_program_.Set("focal_px", static_cast<float>(matrices.view.focal_px));
  BindTexture(kLitUnit, buffers_->lit.get());
  BindTexture(kUnlitUnit, buffers_->unlit.get());
  BindTexture(kPlaceUnit, buffers_->place.get());
  glDisable(GL_DEPTH_TEST);
  corners_.Draw(GL_TRIANGLES, 3);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace elbowroom::recon::gl
