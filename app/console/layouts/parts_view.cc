#include "app/console/layouts/parts_view.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/layouts/part_look.h"

namespace elbowroom::console {
namespace {

constexpr QSize kLargestBySoftwarePx(1280, 800);
constexpr QSize kLargestByCardPx(3840, 2400);
constexpr std::chrono::milliseconds kRestsAfter(400);  // then the scene is drawn in full
constexpr float kChosenShare = 0.4F;                   // of white in the colour of what is chosen
constexpr double kLowestOnTableMm = -1.0;              // a table is drawn under parts that stand on it

QImage PictureFrom(const recon::Image& image) {
  const QImage view(image.rgb.data(), image.width_px, image.height_px, 3 * image.width_px,
                    QImage::Format_RGB888);
  return view.convertToFormat(QImage::Format_RGB32);  // a deep copy
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
      worker_(
          [this](const recon::Image& image, const control::RenderRequest& request) {
            bridge_.PostLatest(Bridge::Stream::kPicture,
                               [this, picture = PictureFrom(image), camera = request.camera] {
                                 ShowPicture(picture, camera);
                               });
          },
          [this](const std::string& line) {
            bridge_.PostLatest(Bridge::Stream::kPicture, [this, text = QString::fromStdString(line)] {
              drawing_.invalidate();
              if (text != std::exchange(last_error_, text)) emit Failed(text);
            });
          }) {
  setMinimumSize(320, 240);
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setAttribute(Qt::WA_OpaquePaintEvent);
  rest_.setSingleShot(true);
  rest_.setInterval(kRestsAfter);
  connect(&rest_, &QTimer::timeout, this, [this] {
    if (scene_ && camera_ && !drawing_.isValid()) Submit(PicturePace::kFinest);
  });
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
    part.box_in_part = known != parts_.end() ? known->box_in_part : core::BoundsOf(*part.mesh);
  }
  parts_ = std::move(parts);
  gaps_ = std::move(gaps);
  bounds_in_world_.setEmpty();
  for (const ShownPart& part : parts_)
    if (part.is_visible) bounds_in_world_.extend(core::BoundsOf(*part.mesh, part.world_from_part));
  MakeScene();
  MakeTrees();
  if (was_empty || !camera_) Fit();
  AskForPicture();
  update();
}

void PartsView::MakeScene() {
  if (bounds_in_world_.isEmpty()) {
    scene_.reset();
    picture_ = QImage();
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
  if (!scene_ || !camera_) return;
  if (drawing_.isValid()) {
    is_outdated_ = true;
  } else {
    Submit(pace_.fineness());
  }
}

void PartsView::Submit(const PictureFineness& fineness) {
  const QSize size = LargestPicture() * fineness.picture;
  drawn_with_ = fineness;
  is_outdated_ = false;
  drawing_.start();
  control::RenderRequest request;
  request.camera = *camera_;
  request.width_px = size.width();
  request.height_px = size.height();
  request.is_smooth = fineness.is_smooth;
  request.scene = scene_;
  worker_.Submit(std::move(request));
}

QSize PartsView::LargestPicture() const {
  const QSize pixels = size() * devicePixelRatio();
  const QSize most = worker_.is_software().value_or(true) ? kLargestBySoftwarePx : kLargestByCardPx;
  return pixels.boundedTo(pixels.scaled(most, Qt::KeepAspectRatio)).expandedTo(QSize(64, 64));
}

void PartsView::ShowPicture(const QImage& picture, const recon::OrbitCamera& camera) {
  const double drawing_ms = 1e-6 * static_cast<double>(drawing_.nsecsElapsed());
  drawing_.invalidate();
  if (!scene_) return;
  last_error_.clear();
  if (drawn_with_ == pace_.fineness()) pace_.Add(drawing_ms);
  picture_ = picture;
  picture_camera_ = camera;
  update();
  if (is_outdated_) {
    Submit(pace_.fineness());
  } else if (drawn_with_ != PicturePace::kFinest) {
    rest_.start();
  }
  emit PictureShown();
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
