#include "app/console/layouts/parts_view.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/layouts/part_look.h"

namespace elbowroom::console {
namespace {

constexpr float kChosenShare = 0.4F;       // of white in the colour of what is chosen
constexpr double kLowestOnTableMm = -1.0;  // a table is drawn under parts that stand on it

// A box of so many takes a thread less than a millisecond.
constexpr std::size_t kMostVerticesAtOnce = 50'000;

struct BoxToFind {
  core::SharedMesh mesh;
  core::RigidTransform world_from_part;
  Eigen::AlignedBox3d box_in_part;
  Eigen::AlignedBox3d box_in_world;
};

template <typename Part>
void FindBoxes(Part* part) {
  if (part->box_in_part.isEmpty()) part->box_in_part = core::BoundsOf(*part->mesh);
  part->box_in_world = core::BoundsOf(*part->mesh, part->world_from_part);
}

Eigen::Vector3f Lighter(const Eigen::Vector3f& color) {
  return color + kChosenShare * (Eigen::Vector3f::Ones() - color);
}

std::optional<QPointF> PositionIn(const recon::SceneView& view, const Eigen::Vector3d& x_in_world) {
  const auto pixel = view.Project(x_in_world);
  if (!pixel) return std::nullopt;
  return QPointF(pixel->x() + 0.5, pixel->y() + 0.5);  // the pixel's centre
}

}  // namespace

PartsView::PartsView(QWidget* parent)
    : QWidget(parent),
      asker_(*this, {.request = [this](const QSize& size,
                                       const PictureFineness& fineness) { return Request(size, fineness); },
                     .take = [this](const QImage& picture,
                                    const control::RenderRequest& request) { return Take(picture, request); },
                     .shown = [this](double) { emit PictureShown(); },
                     .failed = [this](const QString& line) { emit Failed(line); }}) {
  setMinimumSize(320, 130);
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setAttribute(Qt::WA_OpaquePaintEvent);
}

PartsView::~PartsView() = default;

void PartsView::SetEmptyText(const QString& text) {
  empty_text_ = text;
  update();
}

void PartsView::SetAdvice(const QString& advice) {
  advice_ = advice;
  update();
}

void PartsView::Show(std::vector<ShownPart> parts, std::vector<ShownGap> gaps) {
  const bool was_empty = parts_.empty();
  drag_.reset();  // of parts that are replaced
  for (ShownPart& part : parts) {
    const auto known = std::ranges::find(parts_, part.mesh, &ShownPart::mesh);
    if (known == parts_.end()) continue;
    part.box_in_part = known->box_in_part;
    const auto same = std::ranges::find_if(parts_, [&](const ShownPart& other) {
      return other.mesh == part.mesh && other.world_from_part == part.world_from_part;
    });
    if (same != parts_.end()) part.box_in_world = same->box_in_world;
  }
  parts_ = std::move(parts);
  gaps_ = std::move(gaps);
  fits_when_measured_ = fits_when_measured_ || was_empty || !camera_;
  Measure();
  ShowMeasured();
  MakeTrees();
}

void PartsView::Measure() {
  std::vector<BoxToFind> large;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    ShownPart& part = parts_[i];
    if (!part.box_in_world.isEmpty()) continue;
    if (part.mesh->vertices_mm.size() > kMostVerticesAtOnce) {
      large.push_back({part.mesh, part.world_from_part, part.box_in_part, {}});
    } else {
      FindBoxes(&part);
    }
  }
  if (large.empty() || measuring_) return;
  auto found = std::make_shared<std::vector<BoxToFind>>(std::move(large));
  measuring_ = std::make_unique<BackgroundJob>(
      bridge_,
      [found](const std::stop_token& stop) {
        for (BoxToFind& part : *found)
          if (!stop.stop_requested()) FindBoxes(&part);
      },
      [this, found](const std::string& error) {
        measuring_.reset();
        if (!error.empty()) return emit Failed(QString::fromStdString(error));
        for (const BoxToFind& known : *found) {
          for (ShownPart& part : parts_) {
            if (part.mesh != known.mesh) continue;
            part.box_in_part = known.box_in_part;
            if (part.world_from_part == known.world_from_part) part.box_in_world = known.box_in_world;
          }
        }
        Measure();  // of what has come since
        ShowMeasured();
      });
}

void PartsView::ShowMeasured() {
  bounds_in_world_.setEmpty();
  for (const ShownPart& part : parts_) {
    if (!part.is_visible) continue;
    bounds_in_world_.extend(part.box_in_world);
    if (!part.box_in_world.isEmpty() || part.box_in_part.isEmpty()) continue;
    for (int i = 0; i < 8; ++i)  // in the meantime: its box where the part stands now
      bounds_in_world_.extend(part.world_from_part *
                              part.box_in_part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  MakeScene();
  if (fits_when_measured_ && !measuring_) {
    fits_when_measured_ = false;
    Fit();
  }
  AskForPicture();
  update();
}

void PartsView::MakeScene() {
  if (bounds_in_world_.isEmpty()) {
    scene_.reset();
    if (!measuring_) picture_ = QImage();
    if (parts_.empty()) camera_.reset();
    return;
  }
  auto scene = std::make_shared<recon::gl::Scene>();
  for (const ShownPart& part : parts_) {
    if (!part.is_visible) continue;
    recon::gl::ScenePart& shown = scene->parts.emplace_back();
    shown.mesh = part.mesh;
    shown.world_from_part = part.world_from_part;
    shown.color = part.choice == 0 ? part.color : Lighter(part.color);
    shown.opacity = part.opacity;
  }
  scene->lamp = recon::gl::LampOver(bounds_in_world_);
  if (bounds_in_world_.min().z() >= kLowestOnTableMm) {
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.25 * bounds_in_world_.sizes().maxCoeff());
    scene->table_in_world = Eigen::AlignedBox2d(bounds_in_world_.min().head<2>() - margin,
                                                bounds_in_world_.max().head<2>() + margin);
    scene->table_grid_mm = bounds_in_world_.sizes().maxCoeff() > 1000.0 ? 100.0 : 10.0;
  }
  scene_ = std::move(scene);
}

void PartsView::MakeTrees() {
  std::vector<core::SharedMesh> missing;
  std::map<core::SharedMesh, SharedTree> kept;  // those of parts that are gone are let go
  for (const ShownPart& part : parts_) {
    const auto found = trees_.find(part.mesh);
    if (found != trees_.end()) {
      kept.insert(*found);
    } else if (std::ranges::find(missing, part.mesh) == missing.end()) {
      missing.push_back(part.mesh);
    }
  }
  trees_ = std::move(kept);
  if (missing.empty() || tree_making_) return;
  auto made = std::make_shared<std::vector<SharedTree>>();
  tree_making_ = std::make_unique<BackgroundJob>(
      bridge_,
      [missing, made](const std::stop_token& stop) {
        for (const core::SharedMesh& mesh : missing)
          if (!stop.stop_requested()) made->push_back(std::make_shared<const core::TriangleTree>(mesh));
      },
      [this, made](const std::string& error) {
        tree_making_.reset();
        if (!error.empty()) return emit Failed(QString::fromStdString(error));
        for (const SharedTree& tree : *made) trees_.emplace(tree->shared_mesh(), tree);
        MakeTrees();  // of what has come since
      });
}

bool PartsView::CanPick() const {
  return std::ranges::all_of(
      parts_, [this](const ShownPart& part) { return !part.is_visible || trees_.contains(part.mesh); });
}

void PartsView::Fit() {
  if (bounds_in_world_.isEmpty()) return;
  Turn(recon::FittedTo(camera_.value_or(recon::OrbitCamera()), bounds_in_world_, std::max(width(), 1),
                       std::max(height(), 1)));
}

void PartsView::LookAlong(double azimuth_rad, double elevation_rad) {
  if (!camera_) return;
  camera_->azimuth_rad = azimuth_rad;
  camera_->elevation_rad = elevation_rad;
  Fit();
}

void PartsView::Turn(const recon::OrbitCamera& camera) {
  camera_ = camera;
  AskForPicture();
  update();
}

void PartsView::AskForPicture() {
  if (scene_ && camera_) asker_.Ask();
}

std::optional<control::RenderRequest> PartsView::Request(const QSize& size,
                                                         const PictureFineness& fineness) const {
  if (!scene_ || !camera_) return std::nullopt;
  control::RenderRequest request;
  request.camera = *camera_;
  request.width_px = size.width();
  request.height_px = size.height();
  request.is_smooth = fineness.is_smooth;
  request.scene = scene_;
  return request;
}

bool PartsView::Take(const QImage& picture, const control::RenderRequest& request) {
  if (!scene_) return false;
  picture_ = picture;
  picture_camera_ = request.camera;
  update();
  return true;
}

recon::SceneView PartsView::WidgetView() const { return recon::ViewFrom(*camera_, width(), height()); }

recon::SceneView PartsView::PictureView() const {
  return recon::ViewFrom(picture_camera_.value_or(*camera_), width(), height());
}

std::optional<QPointF> PartsView::PositionOf(const Eigen::Vector3d& x_in_world) const {
  return camera_ ? PositionIn(WidgetView(), x_in_world) : std::nullopt;
}

std::optional<QPointF> PartsView::PaintedAt(const Eigen::Vector3d& x_in_world) const {
  return PositionIn(PictureView(), x_in_world);
}

std::optional<control::Pick> PartsView::PickAt(const QPointF& position) const {
  if (!camera_) return std::nullopt;
  std::vector<control::PickablePart> pickable;
  for (const ShownPart& part : parts_) {
    const auto tree = trees_.find(part.mesh);
    pickable.push_back(
        {part.is_visible && tree != trees_.end() ? tree->second : nullptr, part.world_from_part});
  }
  return control::PickPart(pickable, RayAt(position), WidgetView().near_mm);
}

void PartsView::resizeEvent(QResizeEvent* /*event*/) { AskForPicture(); }

}  // namespace elbowroom::console
