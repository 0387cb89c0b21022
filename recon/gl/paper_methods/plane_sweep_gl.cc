#include "recon/gl/paper_methods/plane_sweep_gl.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/gl/objects/byte_texture.h"
#include "recon/gl/objects/egl_context.h"
#include "recon/gl/objects/gl_error.h"
#include "recon/gl/objects/shader_program.h"
#include "recon/gl/objects/texture.h"
#include "recon/gl/objects/vertex_array.h"
#include "recon/gl/paper_methods/plane_sweep_shader.h"
#include "recon/gl/paper_methods/plane_target.h"
#include "recon/paper_methods/plane_grid.h"
#include "recon/paper_methods/sweep_space.h"

namespace elbowroom::recon::gl {
namespace {

constexpr std::size_t kMostTextures = 15;  // OpenGL 3.3 promises 16 units; one is for the view's rays
constexpr int kRayUnit = 15;
constexpr int kSurveyPx = 2 * kSweepTilePx;

using PixelRect = Eigen::AlignedBox2i;  // upper ends excluded

// x_in_b = matrix * (ray, 1) for the point of the ray at a depth.
Eigen::Matrix3d FromRay(const core::RigidTransform& b_from_view, double depth_mm) {
  Eigen::Matrix3d matrix = depth_mm * b_from_view.rotation;
  matrix.col(2) += b_from_view.translation_mm;
  return matrix;
}

Eigen::Matrix3d RayFromPixel(const core::CameraModel& view) {
  return view.calibration().camera_matrix.inverse();
}

// The pixels of each plane that the hull can be in.
class Survey {
 public:
  explicit Survey(const SweepSpace& space)
      : space_(space), rects_(static_cast<std::size_t>(space.plane_count())) {
    const int width_px = space.rays().width_px(), height_px = space.rays().height_px();
    for (int y0 = 0; y0 < height_px && space.plane_count() > 0; y0 += kSurveyPx) {
      for (int x0 = 0; x0 < width_px; x0 += kSurveyPx) {
        Visit({x0, y0, std::min(x0 + kSurveyPx, width_px), std::min(y0 + kSurveyPx, height_px), 0,
               space.plane_count()},
              space.AllQuestions());
      }
    }
  }

  [[nodiscard]] const PixelRect& operator[](int plane) const {
    return rects_[static_cast<std::size_t>(plane)];
  }

 private:
  void Visit(const SweepRegion& region, const OpenQuestions& asked) {
    const std::optional<OpenQuestions> open = space_.Narrow(region, asked);
    if (!open) return;
    if (region.end_plane - region.first_plane > 1 && !open->IsSettled()) {
      SweepRegion half = region;
      half.end_plane = (region.first_plane + region.end_plane) / 2;
      Visit(half, *open);
      half.first_plane = half.end_plane;
      half.end_plane = region.end_plane;
      Visit(half, *open);
      return;
    }
    for (int plane = region.first_plane; plane < region.end_plane; ++plane) {
      rects_[static_cast<std::size_t>(plane)].extend(Eigen::Vector2i(region.x0, region.y0));
      rects_[static_cast<std::size_t>(plane)].extend(Eigen::Vector2i(region.x1, region.y1));
    }
  }

  const SweepSpace& space_;
  std::vector<PixelRect> rects_;
};

}  // namespace

// The context is the first member, so that it is destroyed last.
class PlaneSweepGl::Impl {
 public:
  // `cells`: of the undistortion grid; 0: none.
  [[nodiscard]] SweptView Sweep(const SweepSpace& space, const core::CameraModel& view, SweepPasses passes,
                                int cells);

  void MakeCurrent() const { context_.MakeCurrent(); }
  [[nodiscard]] bool MakeCurrentOrReplace() noexcept { return context_.MakeCurrentOrReplace(); }
  [[nodiscard]] const std::string& driver() const { return context_.driver(); }
  [[nodiscard]] std::thread::id thread() const { return thread_; }

 private:
  // One draw of every plane.
  struct Pass {
    SweepPass kind;
    const ShaderProgram* program;
    std::size_t first_camera;
    std::size_t cameras;
    bool tests_workspace;
  };

  void Upload(const SweepSpace& space);
  [[nodiscard]] std::vector<Pass> PassesOf(const SweepSpace& space, SweepPasses passes, bool has_grid);
  [[nodiscard]] Pass PassOf(const SweepSpace& space, SweepPass kind, std::size_t first, std::size_t count,
                            bool has_grid);
  void SetUp(const SweepSpace& space, const core::CameraModel& view, const Pass& pass) const;
  // Returns the number of triangles drawn, which cover the picture together.
  std::size_t Draw(const SweepSpace& space, const PlaneGrid* grid, const Pass& pass, int plane,
                   GLuint wanted_count);
  void UploadGrid(const SweepSpace& space, const PlaneGrid& grid, const SweepCamera& camera, double depth_mm);
  [[nodiscard]] DepthMap ReadPicture(const SweepSpace& space) const;

  EglContext context_;
  std::thread::id thread_ = std::this_thread::get_id();
  VertexArray corners_ = VertexArray({});
  VertexArray grid_triangles_ = VertexArray({2, 3});
  // By fragment source and first camera, so that the uniforms that hold for all planes are set once a sweep.
  std::map<std::pair<std::string, std::size_t>, ShaderProgram> programs_;
  std::vector<ByteTexture> masks_;
  FloatTexture rays_{3};
  std::optional<PlaneTarget> target_;
};

void PlaneSweepGl::Impl::Upload(const SweepSpace& space) {
  masks_.resize(std::max(masks_.size(), space.cameras().size()));
  for (std::size_t i = 0; i < space.cameras().size(); ++i) {
    const CoverageTexture& coverage = space.cameras()[i].coverage;
    masks_[i].Upload(std::max(coverage.width_texels, 1), std::max(coverage.height_texels, 1),
                     coverage.texels);
  }
  const SweepRays& rays = space.rays();
  if (!target_ || target_->width_px() != rays.width_px() || target_->height_px() != rays.height_px()) {
    target_.reset();
    target_.emplace(rays.width_px(), rays.height_px());
  }
  if (rays.is_ideal()) return;
  std::vector<float> table;
  for (int y = 0; y < rays.height_px(); ++y) {
    for (int x = 0; x < rays.width_px(); ++x) {
      const Eigen::Vector2f ray = rays.RayAt(x, y);
      const bool has_ray = ray.x() == ray.x();
      table.insert(table.end(), {has_ray ? ray.x() : 0.0F, has_ray ? ray.y() : 0.0F, has_ray ? 1.0F : 0.0F});
    }
  }
  rays_.Upload(rays.width_px(), rays.height_px(), table);
}

PlaneSweepGl::Impl::Pass PlaneSweepGl::Impl::PassOf(const SweepSpace& space, SweepPass kind,
                                                    std::size_t first, std::size_t count, bool has_grid) {
  SweepShader shader;
  shader.pass = kind;
  shader.group = space.cameras().subspan(first, count);
  shader.exterior_is_object = space.exterior_is_object();
  shader.tests_workspace = first == 0 && (kind == SweepPass::kHull || kind == SweepPass::kObject);
  if (!space.rays().is_ideal()) shader.ray_source = SweepRaySource::kRayTexture;
  shader.has_grid_positions = has_grid && kind != SweepPass::kPlane;
  const std::string source = shader.FragmentSource();
  auto found = programs_.find({source, first});
  if (found == programs_.end()) {
    found = programs_
                .emplace(std::pair(source, first),
                         ShaderProgram("plane sweep",
                                       shader.has_grid_positions ? GridVertexSource() : SweepVertexSource(),
                                       source))
                .first;
  }
  return {kind, &found->second, first, count, shader.tests_workspace};
}

std::vector<PlaneSweepGl::Impl::Pass> PlaneSweepGl::Impl::PassesOf(const SweepSpace& space,
                                                                   SweepPasses passes, bool has_grid) {
  const std::size_t cameras = space.cameras().size();
  if (passes == SweepPasses::kOneAPlane && cameras <= kMostTextures) {
    return {PassOf(space, SweepPass::kHull, 0, cameras, has_grid)};
  }
  const std::size_t most = passes == SweepPasses::kOneAPlane ? kMostTextures : 1;
  std::vector<Pass> result;
  for (std::size_t first = 0; first < cameras; first += most) {
    const std::size_t count = std::min(most, cameras - first);
    result.push_back(PassOf(space, SweepPass::kObject, first, count, has_grid));
    if (space.exterior_is_object()) result.push_back(PassOf(space, SweepPass::kSeen, first, count, has_grid));
  }
  result.push_back(PassOf(space, SweepPass::kPlane, 0, 0, has_grid));
  return result;
}

// What holds for all planes.
void PlaneSweepGl::Impl::SetUp(const SweepSpace& space, const core::CameraModel& view,
                               const Pass& pass) const {
  const ShaderProgram& program = *pass.program;
  program.Use();
  program.Set("rays", kRayUnit);
  program.Set("ray_from_pixel", Eigen::Matrix3f(RayFromPixel(view).cast<float>()));
  SetWorkspace(program, space.workspace_mm());
  for (std::size_t i = 0; i < pass.cameras; ++i)
    SetCamera(program, space.cameras()[pass.first_camera + i], i);
}

// The corners of all cells go through the camera's lens here; the graphics card interpolates between them and
// divides. Where there are no positions all three numbers are 0.
void PlaneSweepGl::Impl::UploadGrid(const SweepSpace& space, const PlaneGrid& grid, const SweepCamera& camera,
                                    double depth_mm) {
  const auto positions = grid.PositionsOf(camera, depth_mm);
  const Eigen::Vector2d picture_px(space.rays().width_px(), space.rays().height_px());
  std::vector<float> vertices;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    GridTriangle from_texels;
    if (positions[i])
      from_texels = positions[i]->CountedFrom({camera.coverage.left_px, camera.coverage.top_px});
    for (const Eigen::Vector2d& corner : grid.CornersOf(i)) {
      const Eigen::Vector2d place = (corner + Eigen::Vector2d::Constant(0.5)).cwiseQuotient(picture_px);
      const Eigen::Vector3d position =
          from_texels.origin + corner.x() * from_texels.along_x + corner.y() * from_texels.along_y;
      for (const double number : {place.x(), place.y(), position.x(), position.y(), position.z()})
        vertices.push_back(static_cast<float>(number));
    }
  }
  grid_triangles_.Upload(vertices, Refill::kEachFrame);
}

std::size_t PlaneSweepGl::Impl::Draw(const SweepSpace& space, const PlaneGrid* grid, const Pass& pass,
                                     int plane, GLuint wanted_count) {
  const ShaderProgram& program = *pass.program;
  const double depth_mm = space.DepthMmOf(plane);
  program.Use();
  program.Set("plane_depth", (static_cast<float>(plane) + 0.5F) / static_cast<float>(space.plane_count()));
  if (pass.tests_workspace) {
    program.Set("world_from_ray", Eigen::Matrix3f(FromRay(space.world_from_view(), depth_mm).cast<float>()));
  }
  for (std::size_t i = 0; i < pass.cameras; ++i) {
    const SweepCamera& camera = space.cameras()[pass.first_camera + i];
    Eigen::Matrix3d from_ray = FromRay(camera.cam_from_view, depth_mm);
    if (camera.model.is_ideal()) from_ray = PictureFromNormalised(camera) * from_ray;
    program.Set(("from_ray_" + std::to_string(i)).c_str(), Eigen::Matrix3f(from_ray.cast<float>()));
    masks_[pass.first_camera + i].BindTo(static_cast<int>(i));
  }
  SetStencil(pass.kind, wanted_count);
  if (grid != nullptr && pass.cameras == 1) {
    UploadGrid(space, *grid, space.cameras()[pass.first_camera], depth_mm);
    grid_triangles_.Draw(GL_TRIANGLES);
    return grid->triangles();
  }
  corners_.Draw(GL_TRIANGLES, 3);
  return 1;
}

DepthMap PlaneSweepGl::Impl::ReadPicture(const SweepSpace& space) const {
  DepthMap picture{target_->width_px(), target_->height_px(), {}, 0};
  picture.depth_mm.resize(static_cast<std::size_t>(picture.width_px) *
                          static_cast<std::size_t>(picture.height_px));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, picture.width_px, picture.height_px, GL_DEPTH_COMPONENT, GL_FLOAT,
               picture.depth_mm.data());
  for (float& depth : picture.depth_mm) {
    if (depth >= 1.0F) {
      depth = 0.0F;
      continue;
    }
    depth = static_cast<float>(
        space.DepthMmOf(static_cast<int>(depth * static_cast<float>(space.plane_count()))));
    ++picture.hit_pixels;
  }
  return picture;
}

SweptView PlaneSweepGl::Impl::Sweep(const SweepSpace& space, const core::CameraModel& view,
                                    SweepPasses passes, int cells) {
  core::Require(cells == 0 || passes == SweepPasses::kOneAPlaneAndCamera,
                "an undistortion grid belongs to a draw a plane and camera");
  const std::optional<PlaneGrid> grid =
      cells > 0 ? std::optional<PlaneGrid>(std::in_place, view, cells) : std::nullopt;
  Upload(space);
  target_->Bind();
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glStencilMask(~0U);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_STENCIL_TEST);
  rays_.BindTo(kRayUnit);
  const std::vector<Pass> order = PassesOf(space, passes, grid.has_value());
  for (const Pass& pass : order) SetUp(space, view, pass);
  const auto groups = static_cast<GLuint>(std::count_if(
      order.begin(), order.end(), [](const Pass& pass) { return pass.kind == SweepPass::kObject; }));
  const GLuint wanted = groups | (space.exterior_is_object() ? kSeenBit : 0U);
  const bool is_cut = passes == SweepPasses::kOneAPlane;
  const std::optional<Survey> survey = is_cut ? std::optional<Survey>(space) : std::nullopt;
  SweptView swept;
  const std::int64_t pixels = std::int64_t{view.width_px()} * view.height_px();
  if (is_cut) glEnable(GL_SCISSOR_TEST);
  for (int plane = 0; plane < space.plane_count(); ++plane) {
    if (is_cut) {
      const PixelRect& rect = (*survey)[plane];
      if (rect.isEmpty()) continue;
      glScissor(rect.min().x(), rect.min().y(), rect.sizes().x(), rect.sizes().y());
    }
    const std::int64_t covered =
        is_cut ? std::int64_t{(*survey)[plane].sizes().x()} * (*survey)[plane].sizes().y() : pixels;
    swept.stats.tested_points += covered;
    for (const Pass& pass : order) {
      swept.stats.drawn_triangles +=
          static_cast<std::int64_t>(Draw(space, grid ? &*grid : nullptr, pass, plane, wanted));
      swept.stats.filled_pixels += covered;
    }
  }
  swept.picture = ReadPicture(space);
  ThrowOnGlError(context_.renderer());
  swept.stats.planes = space.plane_count();
  swept.stats.skipped_points = swept.stats.planes * pixels - swept.stats.tested_points;
  return swept;
}

PlaneSweepGl::PlaneSweepGl() : impl_(std::make_unique<Impl>()) {}

PlaneSweepGl::~PlaneSweepGl() {
  // What the destructors delete is in its context; without any context nothing can be deleted.
  if (impl_ != nullptr && !impl_->MakeCurrentOrReplace()) (void)impl_.release();
}

PlaneSweepGl::PlaneSweepGl(PlaneSweepGl&&) noexcept = default;
PlaneSweepGl& PlaneSweepGl::operator=(PlaneSweepGl&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

SweptView PlaneSweepGl::Sweep(const core::Rig& rig, std::span<const core::SoftMask> masks,
                              const core::CameraModel& view, const SweepRays& rays,
                              const PlaneSweepOptions& options, SweepPasses passes) {
  core::Require(impl_ != nullptr, "a plane sweep that was moved from isn't used");
  core::Require(impl_->thread() == std::this_thread::get_id(),
                "a plane sweep is used on the thread that made it");
  impl_->MakeCurrent();
  return impl_->Sweep(SweepSpace(rig, masks, view, rays, options), view, passes, options.undistortion_grid);
}

const std::string& PlaneSweepGl::driver() const {
  core::Require(impl_ != nullptr, "a plane sweep that was moved from isn't used");
  return impl_->driver();
}

}  // namespace elbowroom::recon::gl
