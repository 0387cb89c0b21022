#include "app/console/sights/measure_tool.h"

#include <array>
#include <utility>

#include "app/control/measuring/frame_dimensions.h"

namespace elbowroom::console {
namespace {

using control::MeasurementKind;

struct NamedKind {
  MeasurementKind kind;
  const char* name;
  const char* object_name;
};

constexpr std::array kKinds = {
    NamedKind{MeasurementKind::kPoints,
              QT_TRANSLATE_NOOP("elbowroom::console::MeasureTool", "&Point to point"), "measure_points"},
    NamedKind{MeasurementKind::kFaces, QT_TRANSLATE_NOOP("elbowroom::console::MeasureTool", "&Face to face"),
              "measure_faces"},
    NamedKind{MeasurementKind::kPointHull,
              QT_TRANSLATE_NOOP("elbowroom::console::MeasureTool", "Point to the &hull"), "measure_hull"}};

}  // namespace

MeasureTool::MeasureTool(OperatorView* view, PartPicker* picker, QObject* parent)
    : QObject(parent), view_(view), picker_(picker) {
  MakeActions();
  connect(view_, &OperatorView::Clicked, this, &MeasureTool::Pick);
}

MeasureTool::~MeasureTool() = default;

void MeasureTool::MakeActions() {
  for (const NamedKind& named : kKinds) {
    auto* action = new QAction(tr(named.name), this);
    action->setObjectName(named.object_name);
    action->setCheckable(true);
    action->setToolTip(tr("Then click on parts in the 3-D view; the length follows as they move"));
    connect(action, &QAction::triggered, this, [this, kind = named.kind] { Begin(kind); });
    kinds_.push_back(action);
    actions_.push_back(action);
  }
  auto* clear = new QAction(tr("&Clear measurements"), this);
  clear->setObjectName("measure_clear");
  clear->setToolTip(tr("Take all measured lengths out of the 3-D view"));
  connect(clear, &QAction::triggered, this, [this] {
    measurements_.clear();
    to_hull_.reset();
    hull_distance_.reset();
    Show();
  });
  actions_.push_back(clear);
  clearances_ = new QAction(tr("C&learances and depths"), this);
  clearances_->setObjectName("show_clearances");
  clearances_->setCheckable(true);
  clearances_->setChecked(true);
  clearances_->setShortcut(QKeySequence(Qt::Key_C));
  clearances_->setToolTip(
      tr("Each part's clearance to the hull in mm between its bounds, and the deepest points"));
  connect(clearances_, &QAction::toggled, this, &MeasureTool::Show);
  actions_.push_back(clearances_);
}

void MeasureTool::Begin(MeasurementKind kind) {
  const bool is_same = kind_ == kind;
  first_.reset();
  kind_ = is_same ? std::optional<MeasurementKind>() : kind;
  for (std::size_t i = 0; i < kinds_.size(); ++i) kinds_[i]->setChecked(kind_ == kKinds.at(i).kind);
  if (kind_) emit Begun();
  emit Advised(!kind_                            ? QString()
               : kind == MeasurementKind::kFaces ? tr("Click on the first face")
                                                 : tr("Click on a point of a part"));
}

void MeasureTool::End() {
  if (kind_) Begin(*kind_);  // off again
}

void MeasureTool::Clear() {
  measurements_.clear();
  to_hull_.reset();
  hull_distance_.reset();
  result_.reset();
  first_.reset();
  Show();
}

void MeasureTool::Pick(const recon::SceneView& view, const Eigen::Vector2d& pixel) {
  if (!kind_ || !result_) return;
  picker_->Pick(view, pixel, [this](const std::optional<control::Pick>& pick) {
    if (pick) return Take(*pick);
    emit Advised(tr("There is no part: click on one"));
  });
}

void MeasureTool::Take(const control::Pick& pick) {
  if (!kind_ || !result_ || pick.part >= result_->world_from_parts.size()) return;
  const core::RigidTransform part_from_world = result_->world_from_parts[pick.part].Inverse();
  const control::SurfacePlace place{pick.part, part_from_world * pick.point_in_world,
                                    part_from_world.rotation * pick.normal_in_world};
  if (*kind_ == MeasurementKind::kPointHull) {
    to_hull_ = place;
    AskHull();
  } else if (!first_) {
    first_ = place;
    return emit Advised(*kind_ == MeasurementKind::kFaces ? tr("Click on the second face")
                                                          : tr("Click on the second point"));
  } else {
    measurements_.push_back({*kind_, *std::exchange(first_, std::nullopt), place});
  }
  Show();
  Begin(*kind_);  // done: the choice is off again
}

void MeasureTool::ShowFrame(const control::SharedFrameResult& result) {
  result_ = result;
  AskHull();
  Show();
}

void MeasureTool::AskHull() {
  if (!to_hull_ || !result_ || asking_) return;
  auto found = std::make_shared<std::optional<control::Dimension>>();
  asking_ = std::make_unique<BackgroundJob>(
      bridge_,
      [place = *to_hull_, result = result_, found](const std::stop_token&) {
        *found = control::MeasureToHull(place, *result);
      },
      [this, found](const std::string& error) {
        asking_.reset();
        if (!to_hull_) return;
        if (!error.empty()) {  // the next frame would fail likewise
          to_hull_.reset();
          hull_distance_.reset();
          emit Failed(
              tr("The distance to the hull couldn't be measured: %1").arg(QString::fromStdString(error)));
          return Show();
        }
        hull_distance_ = *found;
        Show();
      });
}

void MeasureTool::Show() {
  shown_.clear();
  if (result_ && clearances_->isChecked()) shown_ = control::DimensionsOf(*result_);
  for (const control::Measurement& measurement : measurements_) {
    if (!result_) break;
    if (const auto now = control::MeasureNow(measurement, *result_)) shown_.push_back(*now);
  }
  if (hull_distance_) shown_.push_back(*hull_distance_);
  view_->SetDimensions(shown_);
}

}  // namespace elbowroom::console
