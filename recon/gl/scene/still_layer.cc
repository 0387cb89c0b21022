#include "recon/gl/scene/still_layer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>

#include "recon/gl/objects/gl_error.h"
#include "recon/gl/scene/picture_squares.h"

namespace elbowroom::recon::gl {
namespace {

constexpr int kLitUnit = 0;
constexpr int kUnlitUnit = 1;
constexpr int kPlaceUnit = 2;
constexpr double kBelowTableMm = 1.0;  // that a part may reach down: what is left of it there is a few pixels

// A layer of which more than this share has changed isn't worth renewing for a content that may not come
// again.
constexpr double kWorthRenewing = 0.5;
constexpr int kBandPx = 4 * kSquarePx;  // rows that are read back at once: a megabyte or two
constexpr float kEdgePx = 2.0F;         // that a part's edges may be drawn beside its box
constexpr float kReachTexels = 2.0F * kShadowFilterTexels;  // of the parts' shadow, rounded generously

constexpr const char* kEmptySource = R"(
void main() {}
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

}  // namespace

// Where what a pixel shows is in the lamp's picture, as kLightingSource has it.
class StillLayer::LampPlace {
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

namespace {

bool MeetsAny(const Eigen::AlignedBox2f& box, const std::vector<Eigen::AlignedBox2f>& others) {
  return !box.isEmpty() &&
         std::ranges::any_of(others, [&](const auto& other) { return other.intersects(box); });
}

// Each a little larger, for what a shader does around it.
std::vector<Eigen::AlignedBox2f> Widened(std::vector<Eigen::AlignedBox2f> boxes, const Eigen::Vector2f& by) {
  for (Eigen::AlignedBox2f& box : boxes) box = {box.min() - by, box.max() + by};
  return boxes;
}

}  // namespace

StillLayer::Buffers::Buffers(const Eigen::Vector2i& room) : room_px(room) {
  const int width = room.x(), height = room.y();
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
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);  // takes the memory now
}

StillLayer::StillLayer()
    : shadow_program_("hull's shadow", kSquareVertexSource,
                      std::string(kLightingSource).append(kShadowSource)),
      empty_program_("emptied squares", kSquareVertexSource, kEmptySource) {}

bool StillLayer::Suits(const Scene& scene, const PartPainter& parts) {
  return scene.smoothness == Smoothness::kOneSample && scene.view.EyeInWorld().z() >= 0.0 &&
         std::ranges::all_of(scene.parts, [&](const ScenePart& part) {
           return part.opacity < 1.0F || parts.LowestMm(part) >= -kBelowTableMm;
         });
}

StillLayer::Need StillLayer::NeedFor(const StillContent& content) {
  const bool comes_again = asked_for_ && *asked_for_ == content;
  asked_for_ = content;
  const std::optional<StillChange> change = content_ ? content_->ChangeTo(content) : std::nullopt;
  if (!change) return comes_again ? Need::kAll : Need::kNoLayer;
  stale_ = StaleTiles(*change);
  if (stale_.empty()) return Need::kNothing;
  const bool is_worth_it =
      static_cast<double>(stale_.size()) <= kWorthRenewing * static_cast<double>(tiles_.size());
  return comes_again || is_worth_it ? Need::kSquares : Need::kNoLayer;
}

// A pixel differs only where a part is or was drawn, or where it looks up a shadow that differs.
std::vector<std::size_t> StillLayer::StaleTiles(const StillChange& change) const {
  const Eigen::Vector2f size_px(static_cast<float>(width_px_), static_cast<float>(height_px_));
  const std::vector<Eigen::AlignedBox2f> in_picture =
      Widened(change.in_picture, Eigen::Vector2f::Constant(kEdgePx).cwiseQuotient(size_px));
  const std::vector<Eigen::AlignedBox2f> in_lamp =
      Widened(change.in_lamp, Eigen::Vector2f::Constant(kReachTexels / static_cast<float>(part_shadow_px_)));
  std::vector<std::size_t> stale;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const Eigen::Vector2f corner(static_cast<float>(tiles_[i].x_px), static_cast<float>(tiles_[i].y_px));
    const Eigen::AlignedBox2f square(corner.cwiseQuotient(size_px),
                                     (corner.array() + float{kSquarePx}).matrix().cwiseQuotient(size_px));
    if (MeetsAny(square, in_picture) || MeetsAny(tiles_[i].in_lamp, in_lamp)) stale.push_back(i);
  }
  return stale;
}

void StillLayer::BeginDrawing(Need need, const SceneView& view, const Eigen::Vector2i& room_px) {
  content_.reset();  // what is drawn from here on may fail
  if (need == Need::kSquares) {
    EmptyStaleTiles();
    square_count_.drawn += static_cast<std::int64_t>(stale_.size());
    square_count_.left += static_cast<std::int64_t>(tiles_.size() - stale_.size());
    return;
  }
  if (!buffers_ || buffers_->room_px != room_px) {
    buffers_.reset();
    buffers_.emplace(room_px);
  }
  width_px_ = view.width_px;
  height_px_ = view.height_px;
  tiles_.clear();
  stale_.clear();
  for (int y = 0; y < view.height_px; y += kSquarePx)
    for (int x = 0; x < view.width_px; x += kSquarePx) {
      stale_.push_back(tiles_.size());
      tiles_.push_back({x, y, {}});
    }
  glBindFramebuffer(GL_FRAMEBUFFER, buffers_->framebuffer.get());
  glViewport(0, 0, width_px_, height_px_);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

// The stencil then lets drawing through in these squares alone.
void StillLayer::EmptyStaleTiles() {
  std::vector<float> corners;
  for (const std::size_t i : stale_)
    AppendSquare(tiles_[i].x_px, tiles_[i].y_px, width_px_, height_px_, corners);
  corners_.Upload(corners, Refill::kEachFrame);
  glBindFramebuffer(GL_FRAMEBUFFER, buffers_->framebuffer.get());
  glViewport(0, 0, width_px_, height_px_);
  glClear(GL_STENCIL_BUFFER_BIT);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 1, 1U);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glDepthFunc(GL_ALWAYS);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  empty_program_.Use();
  corners_.Draw(GL_TRIANGLES);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glStencilFunc(GL_EQUAL, 1, 1U);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

void StillLayer::EndDrawing(StillContent content, const ViewMatrices& matrices, const SceneLamp& lamp) {
  glDisable(GL_STENCIL_TEST);
  glClear(GL_STENCIL_BUFFER_BIT);
  const LampPlace in_lamp(matrices.view, lamp);
  glReadBuffer(GL_COLOR_ATTACHMENT2);
  std::vector<Eigen::Vector4f> places;
  // They are in the order of rows.
  for (auto begin = stale_.cbegin(); begin != stale_.cend();) {
    const int bottom_px = tiles_[*begin].y_px + kBandPx;
    const auto end =
        std::find_if(begin, stale_.cend(), [&](std::size_t i) { return tiles_[i].y_px >= bottom_px; });
    PlaceInLamp({begin, end}, in_lamp, places);
    begin = end;
  }
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  part_shadow_px_ = lamp.part_shadow_px;
  content_ = std::move(content);
}

void StillLayer::PlaceInLamp(std::span<const std::size_t> band, const LampPlace& in_lamp,
                             std::vector<Eigen::Vector4f>& places) {
  TexelBox box{width_px_, height_px_, 0, 0};
  for (const std::size_t i : band) {
    box = {std::min(box.x, tiles_[i].x_px), std::min(box.y, tiles_[i].y_px),
           std::max(box.right, std::min(tiles_[i].x_px + kSquarePx, width_px_)),
           std::max(box.bottom, std::min(tiles_[i].y_px + kSquarePx, height_px_))};
  }
  const int across = box.right - box.x;
  places.resize(static_cast<std::size_t>(across) * static_cast<std::size_t>(box.bottom - box.y));
  glReadPixels(box.x, box.y, across, box.bottom - box.y, GL_RGBA, GL_FLOAT, places.data());
  tbb::parallel_for(std::size_t{0}, band.size(), [&](std::size_t i) {
    Tile& tile = tiles_[band[i]];
    tile.in_lamp.setEmpty();
    for (int y = tile.y_px; y < std::min(tile.y_px + kSquarePx, height_px_); ++y)
      for (int x = tile.x_px; x < std::min(tile.x_px + kSquarePx, width_px_); ++x) {
        const float depth_mm =
            places[static_cast<std::size_t>((y - box.y) * across + x - box.x)].head<3>().norm();
        if (const auto share = depth_mm > 0.0F ? in_lamp.Of(x, y, depth_mm) : std::nullopt)
          tile.in_lamp.extend(*share);
      }
  });
}

void StillLayer::ShowIn(const Framebuffer& target, const ViewMatrices& matrices, const Lighting& light) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, buffers_->framebuffer.get());
  target.BindForDrawing();
  glBlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, width_px_, height_px_,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT, GL_NEAREST);
  target.Bind(width_px_, height_px_);
  std::vector<float> corners;
  for (const Tile& tile : tiles_)
    if (light.hull_reach().Meets(tile.in_lamp))
      AppendSquare(tile.x_px, tile.y_px, width_px_, height_px_, corners);
  if (corners.empty()) return;
  corners_.Upload(corners, Refill::kEachFrame);
  shadow_program_.Use();
  light.Apply(shadow_program_, matrices);
  shadow_program_.Set("kept_lit", kLitUnit);
  shadow_program_.Set("kept_unlit", kUnlitUnit);
  shadow_program_.Set("kept_place", kPlaceUnit);
  shadow_program_.Set("view_size",
                      Eigen::Vector2f(static_cast<float>(width_px_), static_cast<float>(height_px_)));
  shadow_program_.Set("focal_px", static_cast<float>(matrices.view.focal_px));
  BindTexture(kLitUnit, buffers_->lit.get());
  BindTexture(kUnlitUnit, buffers_->unlit.get());
  BindTexture(kPlaceUnit, buffers_->place.get());
  glDisable(GL_DEPTH_TEST);
  corners_.Draw(GL_TRIANGLES);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace elbowroom::recon::gl
