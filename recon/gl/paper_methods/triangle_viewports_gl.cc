#include "recon/gl/paper_methods/triangle_viewports_gl.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/gl/objects/byte_texture.h"
#include "recon/gl/objects/egl_context.h"
#include "recon/gl/objects/gl_error.h"
#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/gl/paper_methods/plane_sweep_shader.h"
#include "recon/gl/paper_methods/plane_target.h"

namespace elbowroom::recon::gl {
namespace {

constexpr int kPagePx = 1024;  // a page is no wider and no higher

// Viewports side by side, row by row from the lower left.
struct Page {
  int columns = 1, rows = 1;
  int width_px = 0, height_px = 0;  // of a viewport

  [[nodiscard]] std::size_t Capacity() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  // Lower left corner of the i-th.
  [[nodiscard]] Eigen::Vector2i CornerOf(std::size_t i) const {
    const auto index = static_cast<int>(i);
    return {index % columns * width_px, index / columns * height_px};
  }
};

// As square as possible, for that many triangles or as many as a page can hold.
Page PageFor(std::size_t triangles, const TriangleViewportOptions& options) {
  const int most_columns = kPagePx / options.width_px, most_rows = kPagePx / options.height_px;
  Page page{1, 1, options.width_px, options.height_px};
  const double side = std::ceil(std::sqrt(static_cast<double>(triangles)));
  page.columns = static_cast<int>(std::clamp<double>(side, 1.0, most_columns));
  const double rows = std::ceil(static_cast<double>(triangles) / page.columns);
  page.rows = static_cast<int>(std::clamp<double>(rows, 1.0, most_rows));
  return page;
}

std::vector<float> VerticesOf(std::span<const TriangleViewport> viewports, const Page& page) {
  std::vector<float> floats;
  const auto append = [&](const auto& vector) {
    for (const double value : vector) floats.push_back(static_cast<float>(value));
  };
  for (std::size_t i = 0; i < viewports.size(); ++i) {
    const TriangleViewport& viewport = viewports[i];
    const Eigen::Vector2d corner = page.CornerOf(i).cast<double>();
    for (const Eigen::Vector2d& place : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(page.width_px, 0.0),
                                         Eigen::Vector2d(viewport.apex_x_px(), page.height_px)}) {
      append(Eigen::Vector2d(corner + place));
      append(corner);
      append(viewport.origin_mm());
      append(viewport.along_x_mm());
      append(viewport.along_y_mm());
    }
  }
  return floats;
}

}  // namespace

// The context is the first member, so that it is destroyed last.
class TriangleViewportsGl::Impl {
 public:
  [[nodiscard]] SampledContacts Sample(const CoverageHull& hull, std::span<const TriangleViewport> viewports,
                                       const TriangleViewportOptions& options);

  void MakeCurrent() const { context_.MakeCurrent(); }
  [[nodiscard]] bool MakeCurrentOrReplace() noexcept { return context_.MakeCurrentOrReplace(); }
  [[nodiscard]] const std::string& driver() const { return context_.driver(); }
  [[nodiscard]] std::thread::id thread() const { return thread_; }

 private:
  void Upload(const CoverageHull& hull);
  void BeginPage(const Page& page);
  void Draw(const CoverageHull& hull, std::size_t camera, SweepPass kind);
  void ReadPage(const CoverageHull& hull, std::span<const TriangleViewport> viewports, std::size_t first,
                const Page& page, SampledContacts* result) const;

  EglContext context_;
  std::thread::id thread_ = std::this_thread::get_id();
  VertexArray triangles_ = VertexArray({2, 2, 3, 3, 3});
  std::map<std::string, ShaderProgram> programs_;  // by fragment source
  std::vector<ByteTexture> masks_;
  std::optional<PlaneTarget> target_;
};

void TriangleViewportsGl::Impl::Upload(const CoverageHull& hull) {
  masks_.resize(std::max(masks_.size(), hull.cameras().size()));
  for (std::size_t i = 0; i < hull.cameras().size(); ++i) {
    const CoverageTexture& coverage = hull.cameras()[i].coverage;
    masks_[i].Upload(std::max(coverage.width_texels, 1), std::max(coverage.height_texels, 1),
                     coverage.texels);
  }
}

void TriangleViewportsGl::Impl::BeginPage(const Page& page) {
  const int width_px = page.columns * page.width_px, height_px = page.rows * page.height_px;
  if (!target_ || target_->width_px() != width_px || target_->height_px() != height_px) {
    target_.reset();
    target_.emplace(width_px, height_px);
  }
  target_->Bind();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_STENCIL_TEST);
  glStencilMask(~0U);
  glClear(GL_STENCIL_BUFFER_BIT);
}

void TriangleViewportsGl::Impl::Draw(const CoverageHull& hull, std::size_t index, SweepPass kind) {
  const SweepCamera& camera = hull.cameras()[index];
  SweepShader shader;
  shader.pass = kind;
  shader.group = hull.cameras().subspan(index, 1);
  shader.exterior_is_object = hull.exterior_is_object();
  shader.tests_workspace = index == 0 && kind == SweepPass::kObject;
  shader.ray_source = SweepRaySource::kViewport;
  const std::string source = shader.FragmentSource();
  auto found = programs_.find(source);
  if (found == programs_.end()) {
    found =
        programs_.emplace(source, ShaderProgram("triangle viewports", ViewportVertexSource(), source)).first;
  }
  const ShaderProgram& program = found->second;
  program.Use();
  SetCamera(program, camera, 0);
  SetWorkspace(program, hull.workspace_mm());
  Eigen::Matrix3d rotation = camera.cam_from_view.rotation;
  Eigen::Vector3d translation = camera.cam_from_view.translation_mm;
  if (camera.model.is_ideal()) {
    rotation = PictureFromNormalised(camera) * rotation;
    translation = PictureFromNormalised(camera) * translation;
  }
  program.Set("rotation", Eigen::Matrix3f(rotation.cast<float>()));
  program.Set("translation", Eigen::Vector3f(translation.cast<float>()));
  program.Set("page_px",
              Eigen::Vector2f(Eigen::Vector2i(target_->width_px(), target_->height_px()).cast<float>()));
  masks_[index].BindTo(0);
  SetStencil(kind, 0);
  triangles_.Draw(GL_TRIANGLES);
}

void TriangleViewportsGl::Impl::ReadPage(const CoverageHull& hull,
                                         std::span<const TriangleViewport> viewports, std::size_t first,
                                         const Page& page, SampledContacts* result) const {
  const auto width_px = static_cast<std::size_t>(target_->width_px());
  std::vector<std::uint8_t> counts(width_px * static_cast<std::size_t>(target_->height_px()));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, target_->width_px(), target_->height_px(), GL_STENCIL_INDEX, GL_UNSIGNED_BYTE,
               counts.data());
  ThrowOnGlError(context_.renderer());
  ++result->work.read_backs;
  result->work.read_back_pixels += static_cast<std::int64_t>(counts.size());
  const GLuint wanted =
      static_cast<GLuint>(hull.cameras().size()) | (hull.exterior_is_object() ? kSeenBit : 0U);
  for (std::size_t i = 0; i < viewports.size(); ++i) {
    const Eigen::Vector2i corner = page.CornerOf(i);
    for (int row = 0; row < page.height_px; ++row) {
      const std::uint8_t* line =
          counts.data() + static_cast<std::size_t>(corner.y() + row) * width_px + corner.x();
      for (int column = 0; column < page.width_px; ++column) {
        if (line[column] != wanted) continue;
        result->contacts.push_back(
            {static_cast<std::uint32_t>(first + i), column, row, viewports[i].PositionOf(column, row)});
      }
    }
  }
}

SampledContacts TriangleViewportsGl::Impl::Sample(const CoverageHull& hull,
                                                  std::span<const TriangleViewport> viewports,
                                                  const TriangleViewportOptions& options) {
  Upload(hull);
  SampledContacts result = CountSamples(viewports, hull.cameras().size(), options);
  const Page page = PageFor(viewports.size(), options);
  for (std::size_t first = 0; first < viewports.size(); first += page.Capacity()) {
    const auto drawn = viewports.subspan(first, std::min(page.Capacity(), viewports.size() - first));
    triangles_.Upload(VerticesOf(drawn, page), Refill::kEachFrame);
    BeginPage(page);
    for (std::size_t camera = 0; camera < hull.cameras().size(); ++camera) {
      Draw(hull, camera, SweepPass::kObject);
      if (hull.exterior_is_object()) Draw(hull, camera, SweepPass::kSeen);
    }
    ReadPage(hull, drawn, first, page, &result);
  }
  return result;
}

TriangleViewportsGl::TriangleViewportsGl() : impl_(std::make_unique<Impl>()) {}

TriangleViewportsGl::~TriangleViewportsGl() {
  // What the destructors delete is in its context; without any context nothing can be deleted.
  if (impl_ != nullptr && !impl_->MakeCurrentOrReplace()) (void)impl_.release();
}

TriangleViewportsGl::TriangleViewportsGl(TriangleViewportsGl&&) noexcept = default;
TriangleViewportsGl& TriangleViewportsGl::operator=(TriangleViewportsGl&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

SampledContacts TriangleViewportsGl::Sample(const CoverageHull& hull, const core::TriangleMesh& part,
                                            const core::RigidTransform& world_from_part,
                                            const TriangleViewportOptions& options) {
  core::Require(impl_ != nullptr, "triangle viewports that were moved from aren't used");
  core::Require(impl_->thread() == std::this_thread::get_id(),
                "triangle viewports are used on the thread that made them");
  impl_->MakeCurrent();
  return impl_->Sample(hull, MakeViewports(part, world_from_part, options), options);
}

const std::string& TriangleViewportsGl::driver() const {
  core::Require(impl_ != nullptr, "triangle viewports that were moved from aren't used");
  return impl_->driver();
}

}  // namespace elbowroom::recon::gl
