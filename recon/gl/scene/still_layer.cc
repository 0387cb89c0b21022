#include "recon/gl/scene/still_layer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

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

constexpr int kTilePx = 16;

constexpr const char* kCornerSource = R"(
layout(location = 0) in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }
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

// Where what a pixel shows is in the lamp's picture, as kLightingSource has it.
class LampPlace {
 public:
  LampPlace(const SceneView& view, const SceneLamp& lamp)
      : middle_px_(0.5F * static_cast<float>(view.width_px), 0.5F * static_cast<float>(view.height_px)),
        focal_px_(static_cast<float>(view.focal_px)) {
    const SceneView lamp_view = lamp.ShadowView(1);
    const core::RigidTransform lamp_from_cam = lamp_view.cam_from_world * view.cam_from_world.Inverse();
    rotation_ = lamp_from_cam.rotation.cast<float>();
    translation_mm_ = lamp_from_cam.translation_mm.cast<float>();
    focal_share_ = static_cast<float>(lamp_view.focal_px);
  }

  // In shares of its sides; nothing for what is behind the lamp.
  [[nodiscard]] std::optional<Eigen::Vector2f> Of(int x_px, int y_px, float depth_mm) const {
    const Eigen::Vector2f window(static_cast<float>(x_px) + 0.5F, static_cast<float>(y_px) + 0.5F);
    Eigen::Vector3f x_in_cam;
    x_in_cam << (window - middle_px_) / focal_px_, 1.0F;
    const Eigen::Vector3f x_in_lamp = rotation_ * (depth_mm * x_in_cam) + translation_mm_;
    if (x_in_lamp.z() <= 0.0F) return std::nullopt;
    return Eigen::Vector2f((focal_share_ * x_in_lamp.head<2>() / x_in_lamp.z()).array() + 0.5F);
  }

 private:
  Eigen::Vector2f middle_px_;
  float focal_px_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_mm_;
  float focal_share_ = 1.0F;
};

// Two triangles in clip space.
void AppendSquare(int x_px, int y_px, int width_px, int height_px, std::vector<float>& floats) {
  const auto clip = [](int px, int size_px) {
    return 2.0F * static_cast<float>(std::min(px, size_px)) / static_cast<float>(size_px) - 1.0F;
  };
  const float left = clip(x_px, width_px), right = clip(x_px + kTilePx, width_px),
              low = clip(y_px, height_px), high = clip(y_px + kTilePx, height_px);
  floats.insert(floats.end(), {left, low, right, low, right, high, left, low, right, high, left, high});
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

bool StillLayer::ComesAgain(const Scene& scene, const PartPainter& parts, const Lighting& light) {
  Content content = ContentOf(scene, parts, light);
  const bool comes_again = asked_for_ && AreSame(*asked_for_, content);
  asked_for_ = std::move(content);
  return comes_again;
}

void StillLayer::EndDrawing(const ViewMatrices& matrices, const SceneLamp& lamp) {
  const int width_px = buffers_->width_px, height_px = buffers_->height_px;
  std::vector<Eigen::Vector4f> places(static_cast<std::size_t>(width_px) *
                                      static_cast<std::size_t>(height_px));
  glReadBuffer(GL_COLOR_ATTACHMENT2);
  glReadPixels(0, 0, width_px, height_px, GL_RGBA, GL_FLOAT, places.data());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  const LampPlace in_lamp(matrices.view, lamp);
  tiles_.clear();
  for (int y = 0; y < height_px; y += kTilePx)
    for (int x = 0; x < width_px; x += kTilePx) tiles_.push_back({x, y, {}});
  tbb::parallel_for(std::size_t{0}, tiles_.size(), [&](std::size_t i) {
    Tile& tile = tiles_[i];
    for (int y = tile.y_px; y < std::min(tile.y_px + kTilePx, height_px); ++y)
      for (int x = tile.x_px; x < std::min(tile.x_px + kTilePx, width_px); ++x) {
        const float depth_mm = places[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
                                      static_cast<std::size_t>(x)]
                                   .head<3>()
                                   .norm();
        if (const auto share = depth_mm > 0.0F ? in_lamp.Of(x, y, depth_mm) : std::nullopt)
          tile.in_lamp.extend(*share);
      }
  });
}

void StillLayer::ShowIn(const Framebuffer& target, const ViewMatrices& matrices, const Lighting& light) {
  const int width_px = buffers_->width_px, height_px = buffers_->height_px;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, buffers_->framebuffer.get());
  target.BindForDrawing();
  glBlitFramebuffer(0, 0, width_px, height_px, 0, 0, width_px, height_px,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, GL_NEAREST);
  target.Bind();
  std::vector<float> corners;
  for (const Tile& tile : tiles_)
    if (light.hull_reach().Meets(tile.in_lamp))
      AppendSquare(tile.x_px, tile.y_px, width_px, height_px, corners);
  if (corners.empty()) return;
  corners_.Upload(corners, Refill::kEachFrame);
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
  corners_.Draw(GL_TRIANGLES);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace elbowroom::recon::gl
