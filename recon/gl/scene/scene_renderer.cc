#include "recon/gl/scene/scene_renderer.h"

#include <epoxy/gl.h>

#include <optional>
#include <thread>
#include <utility>

#include "core/error.h"
#include "recon/gl/objects/egl_context.h"
#include "recon/gl/objects/framebuffer.h"
#include "recon/gl/objects/gl_error.h"
#include "recon/gl/scene/contact_painter.h"
#include "recon/gl/scene/hull_painter.h"
#include "recon/gl/scene/lighting.h"
#include "recon/gl/scene/part_painter.h"
#include "recon/gl/scene/still_layer.h"
#include "recon/gl/scene/surroundings_painter.h"
#include "recon/gl/scene/view_matrices.h"

namespace elbowroom::recon::gl {
namespace {

constexpr int kSamples = 4;  // OpenGL 3.3 promises as many

struct Targets {
  Framebuffer single;
  std::optional<Framebuffer> sampled;  // made for the first picture with several samples a pixel
};

}  // namespace

// The context is the first member, so that it is destroyed last.
class SceneRenderer::Impl {
 public:
  Impl(PartDetail detail, StillThings still_things) : parts_(detail), still_things_(still_things) {}

  [[nodiscard]] Image Render(const Scene& scene);
  [[nodiscard]] DepthImage RenderDepth(const Scene& scene);
  void MakeCurrent() const { context_.MakeCurrent(); }
  [[nodiscard]] bool MakeCurrentOrReplace() noexcept { return context_.MakeCurrentOrReplace(); }

  [[nodiscard]] const EglContext& context() const { return context_; }
  [[nodiscard]] const PartPainter& parts() const { return parts_; }
  void AwaitLevels() { parts_.AwaitLevels(); }
  [[nodiscard]] const Lighting& lighting() const { return lighting_; }
  [[nodiscard]] const StillCount& still_count() const { return still_count_; }
  [[nodiscard]] const SquareCount& square_count() const { return still_.square_count(); }
  [[nodiscard]] std::thread::id thread() const { return thread_; }

 private:
  void DrawAll(const Scene& scene, const ViewMatrices& matrices, const Framebuffer& target);
  void DrawOnStillLayer(const Scene& scene, const ViewMatrices& matrices, const Framebuffer& target,
                        StillLayer::Need need, StillContent content);
  [[nodiscard]] const Targets& TargetsFor(const Scene& scene);

  EglContext context_;
  std::thread::id thread_ = std::this_thread::get_id();
  PartPainter parts_;
  Lighting lighting_;
  HullPainter hull_;
  SurroundingsPainter surroundings_;
  ContactPainter contacts_;
  StillThings still_things_;
  StillLayer still_;
  StillCount still_count_;
  std::optional<Targets> targets_;
};

const Targets& SceneRenderer::Impl::TargetsFor(const Scene& scene) {
  const Eigen::Vector2i room_px = scene.RoomPx(scene.view.width_px, scene.view.height_px);
  if (!targets_ || targets_->single.width_px() != room_px.x() ||
      targets_->single.height_px() != room_px.y()) {
    targets_.reset();
    targets_.emplace(Framebuffer(room_px.x(), room_px.y(), 1), std::nullopt);
  }
  if (scene.smoothness == Smoothness::kFourSamples && !targets_->sampled)
    targets_->sampled.emplace(room_px.x(), room_px.y(), kSamples);
  return *targets_;
}

void SceneRenderer::Impl::DrawAll(const Scene& scene, const ViewMatrices& matrices,
                                  const Framebuffer& target) {
  target.Bind(scene.view.width_px, scene.view.height_px);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  surroundings_.DrawBackground(scene);
  // With one sample a pixel that is hidden is found out before it is shaded.
  if (scene.smoothness == Smoothness::kOneSample) parts_.DrawOpaqueDepth(scene.parts, matrices);
  parts_.DrawOpaque(scene.parts, matrices, lighting_, HullShadow::kThrown);
  if (scene.hull != nullptr) hull_.Draw(scene, matrices, lighting_);
  surroundings_.DrawTable(scene, matrices, lighting_, HullShadow::kThrown);
  surroundings_.DrawLines(scene, matrices);
}

// Table and lines are on the layer already; where the hull has covered them they are drawn over it once more.
void SceneRenderer::Impl::DrawOnStillLayer(const Scene& scene, const ViewMatrices& matrices,
                                           const Framebuffer& target, StillLayer::Need need,
                                           StillContent content) {
  if (need == StillLayer::Need::kNothing) {
    ++still_count_.kept;
  } else {
    still_.BeginDrawing(need, scene.view, scene.RoomPx(scene.view.width_px, scene.view.height_px));
    surroundings_.DrawBackground(scene);
    parts_.DrawOpaqueDepth(scene.parts, matrices);
    parts_.DrawOpaque(scene.parts, matrices, lighting_, HullShadow::kLeftOut);
    surroundings_.DrawTable(scene, matrices, lighting_, HullShadow::kLeftOut);
    surroundings_.DrawLines(scene, matrices);
    still_.EndDrawing(std::move(content), matrices, scene.lamp);
    ++(need == StillLayer::Need::kAll ? still_count_.drawn : still_count_.renewed);
  }
  still_.ShowIn(target, matrices, lighting_);
  if (scene.hull == nullptr) return;
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 1, 1U);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  hull_.Draw(scene, matrices, lighting_);
  glStencilFunc(GL_EQUAL, 1, 1U);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  surroundings_.DrawTable(scene, matrices, lighting_, HullShadow::kThrown);
  surroundings_.DrawLines(scene, matrices);
  glDisable(GL_STENCIL_TEST);
}

Image SceneRenderer::Impl::Render(const Scene& scene) {
  const ViewMatrices matrices = MatricesOf(scene.view);
  const Targets& targets = TargetsFor(scene);
  const bool has_samples = scene.smoothness == Smoothness::kFourSamples;
  parts_.Update(scene.parts, scene.view);
  lighting_.Update(scene, parts_);
  auto need = StillLayer::Need::kNoLayer;
  std::optional<StillContent> content;
  if (still_things_ == StillThings::kKept && StillLayer::Suits(scene, parts_))
    need = still_.NeedFor(content.emplace(scene, parts_));
  if (need != StillLayer::Need::kNoLayer) {
    DrawOnStillLayer(scene, matrices, targets.single, need, std::move(*content));
  } else {
    DrawAll(scene, matrices, has_samples ? *targets.sampled : targets.single);
  }
  parts_.DrawTransparent(scene.parts, matrices, lighting_);
  contacts_.Draw(scene.contact_points_in_world, matrices);
  if (has_samples)
    targets.single.ResolveColourFrom(*targets.sampled, scene.view.width_px, scene.view.height_px);
  targets.single.BindForReading();
  Image image{scene.view.width_px, scene.view.height_px, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px));
  glReadPixels(0, 0, image.width_px, image.height_px, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
  ThrowOnGlError(context_.renderer());
  return image;
}

DepthImage SceneRenderer::Impl::RenderDepth(const Scene& scene) {
  const ViewMatrices matrices = MatricesOf(scene.view);
  const Targets& targets = TargetsFor(scene);
  parts_.Update(scene.parts, scene.view);
  targets.single.Bind(scene.view.width_px, scene.view.height_px);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  parts_.DrawDepth(scene.parts, matrices);
  if (scene.hull != nullptr) hull_.DrawDepth(*scene.hull, matrices);
  targets.single.BindForReading();
  DepthImage image{scene.view.width_px, scene.view.height_px, {}};
  image.depth_mm.resize(static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px));
  glReadPixels(0, 0, image.width_px, image.height_px, GL_DEPTH_COMPONENT, GL_FLOAT, image.depth_mm.data());
  ThrowOnGlError(context_.renderer());
  for (float& value : image.depth_mm) value = value < 1.0F ? DepthMmOf(value, scene.view) : 0.0F;
  return image;
}

SceneRenderer::SceneRenderer(PartDetail detail, StillThings still_things)
    : impl_(std::make_unique<Impl>(detail, still_things)) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_MULTISAMPLE);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glPolygonOffset(1.0F, 1.0F);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

SceneRenderer::~SceneRenderer() {
  // What the destructors delete is in its context; without any context nothing can be deleted.
  if (impl_ != nullptr && !impl_->MakeCurrentOrReplace()) (void)impl_.release();
}

SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

SceneRenderer::Impl& SceneRenderer::OnOwnThread() const {
  core::Require(impl_ != nullptr, "a renderer that was moved from isn't used");
  core::Require(impl_->thread() == std::this_thread::get_id(),
                "a renderer is used on the thread that made it");
  impl_->MakeCurrent();
  return *impl_;
}

Image SceneRenderer::Render(const Scene& scene) {
  scene.Validate();
  return OnOwnThread().Render(scene);
}

DepthImage SceneRenderer::RenderDepth(const Scene& scene) {
  scene.Validate();
  return OnOwnThread().RenderDepth(scene);
}

const std::string& SceneRenderer::driver() const { return OnOwnThread().context().driver(); }
bool SceneRenderer::is_software() const { return OnOwnThread().context().is_software(); }
std::size_t SceneRenderer::cached_meshes() const { return OnOwnThread().parts().cached_meshes(); }
std::int64_t SceneRenderer::mesh_uploads() const { return OnOwnThread().parts().mesh_uploads(); }
ShadowCount SceneRenderer::shadow_count() const { return OnOwnThread().lighting().count(); }
StillCount SceneRenderer::still_count() const { return OnOwnThread().still_count(); }
SquareCount SceneRenderer::square_count() const { return OnOwnThread().square_count(); }
TriangleCount SceneRenderer::triangle_count() const { return OnOwnThread().parts().triangle_count(); }
void SceneRenderer::AwaitLevels() { OnOwnThread().AwaitLevels(); }

}  // namespace elbowroom::recon::gl
