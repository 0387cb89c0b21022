#include "recon/gl/exact_view/exact_view_gl.h"

#include <epoxy/gl.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/exact_view/hull_normals.h"
#include "recon/gl/exact_view/exact_view_shader.h"
#include "recon/gl/exact_view/hull_target.h"
#include "recon/gl/exact_view/pencil_tables.h"
#include "recon/gl/objects/buffer_texture.h"
#include "recon/gl/objects/egl_context.h"
#include "recon/gl/objects/gl_error.h"
#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/texture.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon::gl {
namespace {

// Texture units.
enum Unit { kRays, kLabels, kForms, kRuns, kAngles, kKeys };

constexpr float kLargest = 3.0e38F;  // stands for infinity, as in the shader

// The picture that is on the card. Silhouettes don't change, so hulls with the same ones are the same hull.
struct Drawn {
  VisualHull hull;
  ViewRays rays;
  bool with_surfaces = false;
  PixelBox bounds;  // of what was drawn
  std::int64_t cast_pixels = 0;
  std::int64_t edges = 0;
};

bool IsSameHull(const VisualHull& a, const VisualHull& b) {
  return a.shared_rig() == b.shared_rig() && std::ranges::equal(a.silhouettes(), b.silhouettes());
}

PixelBox BoundsOf(const std::vector<PixelBox>& squares) {
  if (squares.empty()) return {};
  PixelBox bounds = squares.front();
  for (const PixelBox& square : squares) {
    bounds = {std::min(bounds.x, square.x), std::min(bounds.y, square.y),
              std::max(bounds.right, square.right), std::max(bounds.bottom, square.bottom)};
  }
  return bounds;
}

// Two triangles a square, in clip coordinates.
std::vector<float> CornersOf(const std::vector<PixelBox>& squares, const ViewRays& rays) {
  const double across = 2.0 / rays.width_px(), down = 2.0 / rays.height_px();
  std::vector<float> corners;
  corners.reserve(12 * squares.size());
  for (const PixelBox& square : squares) {
    const auto left = static_cast<float>(square.x * across - 1.0);
    const auto right = static_cast<float>(square.right * across - 1.0);
    const auto top = static_cast<float>(square.y * down - 1.0);
    const auto bottom = static_cast<float>(square.bottom * down - 1.0);
    corners.insert(corners.end(),
                   {left, top, right, top, right, bottom, left, top, right, bottom, left, bottom});
  }
  return corners;
}

}  // namespace

// The context is the first member, so that it is destroyed last.
class ExactViewGl::Impl {
 public:
  Impl();

  [[nodiscard]] HullView View(const VisualHull& hull, const ViewRays& rays, const HullViewOptions& options);

  void MakeCurrent() const { context_.MakeCurrent(); }
  [[nodiscard]] bool MakeCurrentOrReplace() noexcept { return context_.MakeCurrentOrReplace(); }
  [[nodiscard]] std::thread::id thread() const { return thread_; }
  [[nodiscard]] const std::string& driver() const { return context_.driver(); }
  [[nodiscard]] std::int64_t draws() const { return draws_; }
  [[nodiscard]] std::int64_t ray_uploads() const { return ray_uploads_; }

 private:
  [[nodiscard]] bool IsDrawn(const VisualHull& hull, const ViewRays& rays, bool with_surfaces) const;
  void Draw(const VisualHull& hull, const ViewRays& rays, bool with_surfaces);
  void UploadRays(const ViewRays& rays);
  void UploadPencils(const ViewPencils& pencils, const std::vector<PixelBox>& squares);
  void Read(bool with_surfaces, HullView* view);

  EglContext context_;
  std::thread::id thread_ = std::this_thread::get_id();
  ShaderProgram program_{"exact view", kExactViewVertexSource, kExactViewFragmentSource};
  VertexArray corners_{2};
  FloatTexture ray_texture_{3};
  FloatTexture labels_{1};
  BufferTexture forms_{GL_RGBA32F, sizeof(Eigen::Vector4f)};
  BufferTexture runs_{GL_RG32UI, 2 * sizeof(std::uint32_t)};
  BufferTexture angles_{GL_RG32F, sizeof(Eigen::Vector2f)};
  BufferTexture keys_{GL_RGBA32F, sizeof(Eigen::Vector4f)};
  std::optional<HullTarget> target_;
  std::optional<ViewRays> rays_;  // on the card
  std::optional<Drawn> drawn_;    // the picture there
  std::vector<GLint> surfaces_;   // caster and edge a pixel, as read
  std::int64_t draws_ = 0;
  std::int64_t ray_uploads_ = 0;
};

ExactViewGl::Impl::Impl() {
  program_.Use();
  program_.Set("rays", kRays);
  program_.Set("labels", kLabels);
  program_.Set("forms", kForms);
  program_.Set("runs", kRuns);
  program_.Set("angles", kAngles);
  program_.Set("keys", kKeys);
  const float nothing = 0.0F;
  labels_.Upload(1, 1, {&nothing, 1});
}

HullView ExactViewGl::Impl::View(const VisualHull& hull, const ViewRays& rays,
                                 const HullViewOptions& options) {
  const bool with_surfaces = options.surfaces || options.normals;
  HullView view;
  view.width_px = rays.width_px(), view.height_px = rays.height_px();
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  view.depth_mm.assign(pixels, 0.0F);
  if (with_surfaces) view.surface.assign(pixels, {});
  if (!hull.IsEmpty()) {
    if (!IsDrawn(hull, rays, with_surfaces)) Draw(hull, rays, with_surfaces);
    Read(with_surfaces, &view);
    ThrowOnGlError(context_.renderer());
  }
  view.skipped_pixels = static_cast<std::int64_t>(pixels) - view.cast_pixels;
  if (options.normals) view.normal_in_world = NormalsOf(hull, rays, view);
  if (!options.surfaces) view.surface = {};
  return view;
}

bool ExactViewGl::Impl::IsDrawn(const VisualHull& hull, const ViewRays& rays, bool with_surfaces) const {
  return drawn_ && drawn_->rays.HasSameRays(rays) &&
         drawn_->rays.view_from_world() == rays.view_from_world() &&
         drawn_->rays.half_spaces() == rays.half_spaces() && (drawn_->with_surfaces || !with_surfaces) &&
         IsSameHull(drawn_->hull, hull);
}

void ExactViewGl::Impl::UploadRays(const ViewRays& rays) {
  if (rays_ && rays_->HasSameRays(rays)) return;
  rays_.reset();
  const auto width = static_cast<std::size_t>(rays.width_px());
  std::vector<float> floats(3 * width * static_cast<std::size_t>(rays.height_px()), 0.0F);
  tbb::parallel_for(0, rays.height_px(), [&](int y) {
    float* at = floats.data() + 3 * width * static_cast<std::size_t>(y);
    for (int x = 0; x < rays.width_px(); ++x, at += 3) {
      const Eigen::Vector2d uv = rays.At(x, y);
      if (std::isnan(uv.x())) continue;
      at[0] = static_cast<float>(uv.x()), at[1] = static_cast<float>(uv.y()), at[2] = 1.0F;
    }
  });
  ray_texture_.Upload(rays.width_px(), rays.height_px(), floats);
  rays_ = rays;
  ++ray_uploads_;
}

void ExactViewGl::Impl::UploadPencils(const ViewPencils& pencils, const std::vector<PixelBox>& squares) {
  const PencilTables tables = Tabulate(pencils);
  forms_.Upload(std::span(tables.forms));
  runs_.Upload(std::span(tables.runs));
  angles_.Upload(std::span(tables.angles));
  keys_.Upload(std::span(tables.keys));
  const std::vector<float> labels = LabelsByPixel(pencils, squares);
  const ViewRays& rays = pencils.rays();
  if (!labels.empty()) labels_.Upload(rays.width_px(), rays.height_px(), labels);
  program_.Use();
  program_.Set("has_labels", labels.empty() ? 0 : 1);
  program_.Set("cameras", static_cast<int>(pencils.cameras().size()));
  program_.Set("visibility_outlines", static_cast<int>(pencils.visibility_outlines().size()));
  const CastBox& box = pencils.box();
  program_.Set("faces",
               Eigen::Vector3i(static_cast<int>(box.not_before.size()),
                               static_cast<int>(box.not_after.size()), static_cast<int>(box.beside.size())));
  program_.Set("key_end", std::min(pencils.key_end(), kLargest));
  program_.Set("is_perspective", rays.projection() == Projection::kPerspective ? 1 : 0);
}

void ExactViewGl::Impl::Draw(const VisualHull& hull, const ViewRays& rays, bool with_surfaces) {
  drawn_.reset();
  if (!target_ || target_->width_px() != rays.width_px() || target_->height_px() != rays.height_px()) {
    target_.reset();
    target_.emplace(rays.width_px(), rays.height_px());
  }
  const ViewPencils pencils(hull, rays);
  const std::vector<PixelBox> squares = pencils.Squares();
  Drawn drawn{hull, rays, with_surfaces, BoundsOf(squares), 0, pencils.edges()};
  for (const PixelBox& square : squares)
    drawn.cast_pixels += std::int64_t{square.right - square.x} * (square.bottom - square.y);
  if (!squares.empty()) {
    UploadRays(rays);
    UploadPencils(pencils, squares);
    corners_.Upload(CornersOf(squares, rays), Refill::kEachFrame);
    target_->Bind(with_surfaces);
    const GLfloat no_depth[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    const GLint no_surface[4] = {TileHits::kMiss, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, no_depth);
    if (with_surfaces) glClearBufferiv(GL_COLOR, 1, no_surface);
    ray_texture_.BindTo(kRays), labels_.BindTo(kLabels), forms_.BindTo(kForms);
    runs_.BindTo(kRuns), angles_.BindTo(kAngles), keys_.BindTo(kKeys);
    corners_.Draw(GL_TRIANGLES);
    ++draws_;
  }
  ThrowOnGlError(context_.renderer());
  drawn_ = std::move(drawn);
}

void ExactViewGl::Impl::Read(bool with_surfaces, HullView* view) {
  view->edges = drawn_->edges;
  view->cast_pixels = drawn_->cast_pixels;
  const PixelBox& b = drawn_->bounds;
  if (b.right == b.x) return;
  target_->ReadDepth(b.x, b.y, b.right, b.bottom, view->depth_mm.data());
  const auto width = static_cast<std::size_t>(view->width_px);
  for (int y = b.y; y < b.bottom; ++y) {
    const float* row = view->depth_mm.data() + width * static_cast<std::size_t>(y);
    view->hit_pixels += std::count_if(row + b.x, row + b.right, [](float depth) { return depth != 0.0F; });
  }
  view->hits = {b.x, b.y, b.right, b.bottom};
  if (!with_surfaces) return;
  surfaces_.resize(2 * view->depth_mm.size());
  target_->ReadSurfaces(b.x, b.y, b.right, b.bottom, surfaces_.data());
  tbb::parallel_for(b.y, b.bottom, [&](int y) {
    for (int x = b.x; x < b.right; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
      const GLint* surface = surfaces_.data() + 2 * pixel;
      if (surface[0] == TileHits::kMiss) continue;
      view->surface[pixel] = SurfaceOf(drawn_->hull, surface[0], static_cast<std::uint32_t>(surface[1]));
    }
  });
}

ExactViewGl::ExactViewGl() : impl_(std::make_unique<Impl>()) {}

ExactViewGl::~ExactViewGl() {
  // What the destructors delete is in its context; without any context nothing can be deleted.
  if (impl_ != nullptr && !impl_->MakeCurrentOrReplace()) (void)impl_.release();
}

ExactViewGl::ExactViewGl(ExactViewGl&&) noexcept = default;
ExactViewGl& ExactViewGl::operator=(ExactViewGl&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

ExactViewGl::Impl& ExactViewGl::OnOwnThread() const {
  core::Require(impl_ != nullptr, "an exact view that was moved from isn't used");
  core::Require(impl_->thread() == std::this_thread::get_id(),
                "an exact view is used on the thread that made it");
  impl_->MakeCurrent();
  return *impl_;
}

HullView ExactViewGl::ViewHull(const VisualHull& hull, const ViewRays& rays, const HullViewOptions& options) {
  return OnOwnThread().View(hull, rays, options);
}

const std::string& ExactViewGl::driver() const { return OnOwnThread().driver(); }
std::int64_t ExactViewGl::draws() const { return OnOwnThread().draws(); }
std::int64_t ExactViewGl::ray_uploads() const { return OnOwnThread().ray_uploads(); }

}  // namespace elbowroom::recon::gl
