#include "app/console/sights/section_tool.h"

#include <utility>

namespace elbowroom::console {
namespace {

QPointF PositionOf(const Eigen::Vector2d& pixel) { return {pixel.x() + 0.5, pixel.y() + 0.5}; }

}  // namespace

SectionTool::SectionTool(SectionPanel* panel, OperatorView* view, PartPicker* picker, QObject* parent)
    : QObject(parent), panel_(panel), view_(view), picker_(picker) {
  view_->SetHandles(HandlesForView());
  connect(panel_, &SectionPanel::Changed, view_, &OperatorView::SetCut);
  connect(view_, &OperatorView::ShiftDragged, panel_, &SectionPanel::Drag);
  connect(view_, &OperatorView::ShiftDragEnded, panel_, &SectionPanel::EndStep);
  connect(view_, &OperatorView::Clicked, this, &SectionTool::PickFace);
  connect(panel_, &SectionPanel::AlignAsked, this, &SectionTool::BeginAligning);
  connect(panel_, &SectionPanel::FacingAsked, this, &SectionTool::AddFacing);
}

std::optional<PlaneHandles> SectionTool::Handles() const {
  const std::optional<control::Section> section = panel_->active();
  return section ? PlaneHandles::Of(*section, panel_->workspace_mm()) : std::nullopt;
}

std::optional<QPointF> SectionTool::GripOf(PlaneHandle handle) const {
  const std::optional<PlaneHandles> handles = Handles();
  const std::optional<recon::SceneView> view = view_->shown_view();
  if (!handles || !view) return std::nullopt;
  const std::optional<QPointF> grip = handles->GripOn(*view, handle);
  return grip ? std::optional(*grip + view_->picture_corner()) : std::nullopt;
}

ViewHandles SectionTool::HandlesForView() {
  return {.paint =
              [this](QPainter& painter, const recon::SceneView& view) {
                if (const auto handles = Handles())
                  handles->Paint(painter, view, drag_ ? std::optional(drag_->handle()) : hot_);
              },
          .hover = [this](const recon::SceneView& view, const Eigen::Vector2d& pixel) { Hover(view, pixel); },
          .press = [this](const recon::SceneView& view,
                          const Eigen::Vector2d& pixel) { return Press(view, pixel); },
          .drag =
              [this](const recon::SceneView& view, const Eigen::Vector2d& pixel, bool in_steps) {
                if (drag_) panel_->SetActive(drag_->At(control::RayThrough(view, pixel), in_steps));
              },
          .release = [this](bool is_kept) { Release(is_kept); }};
}

void SectionTool::Hover(const recon::SceneView& view, const Eigen::Vector2d& pixel) {
  const std::optional<PlaneHandles> handles = Handles();
  const std::optional<PlaneHandle> under =
      handles ? handles->HandleAt(view, PositionOf(pixel)) : std::nullopt;
  if (hot_ != std::exchange(hot_, under)) view_->update();
}

bool SectionTool::Press(const recon::SceneView& view, const Eigen::Vector2d& pixel) {
  const std::optional<PlaneHandles> handles = Handles();
  if (!handles || is_aligning_) return false;
  const std::optional<PlaneHandle> handle = handles->HandleAt(view, PositionOf(pixel));
  if (!handle) return false;
  panel_->EndStep();
  drag_ = PlaneDrag::Begin(*handle, *handles, *panel_->active(), control::RayThrough(view, pixel));
  return drag_.has_value();
}

void SectionTool::Release(bool is_kept) {
  if (drag_ && !is_kept) panel_->SetActive(drag_->start());
  drag_.reset();
  panel_->EndStep();
  view_->update();
}

void SectionTool::AddFacing() {
  if (!view_->camera()) return;
  const recon::SceneView view = recon::ViewFrom(*view_->camera(), view_->width(), view_->height());
  panel_->Add(tr("Facing the view"), view.EyeInWorld() - view_->camera()->target_in_world,
              view_->camera()->target_in_world);
}

void SectionTool::BeginAligning(bool is_on) {
  is_aligning_ = is_on;
  emit Advised(is_on ? tr("Click on the face that the plane is to lie on") : QString());
}

void SectionTool::PickFace(const recon::SceneView& view, const Eigen::Vector2d& pixel) {
  if (!is_aligning_) return;
  picker_->Pick(view, pixel, [this](const std::optional<control::Pick>& pick) {
    if (!is_aligning_) return;
    if (!pick) return emit Advised(tr("There is no part: click on a part's face"));
    const std::vector<control::Section>& sections = panel_->sections();
    const std::optional<std::size_t> active = panel_->active_index();
    if (active) {
      control::Section aligned =
          control::AlignedTo(sections[*active], pick->normal_in_world, pick->point_in_world);
      aligned.is_on = true;
      panel_->EndStep();
      panel_->SetActive(aligned);
      panel_->EndStep();
    }
    panel_->SetAligning(false);
  });
}

}  // namespace elbowroom::console
