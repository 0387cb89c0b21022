#include "app/console/sights/part_picker.h"

#include <utility>
#include <vector>

#include "app/control/section/part_sections.h"
#include "core/bvh.h"

namespace elbowroom::console {

struct PartPicker::PickedParts {
  control::PartSections sections;
  std::vector<std::shared_ptr<const core::TriangleTree>> trees;

  std::shared_ptr<const core::TriangleTree> TreeOf(const core::SharedMesh& mesh) {
    for (const auto& tree : trees)
      if (tree->shared_mesh() == mesh) return tree;
    trees.push_back(std::make_shared<const core::TriangleTree>(mesh));
    return trees.back();
  }

  std::optional<control::Pick> PickAt(const control::FrameResult& result, const control::SectionCut& cut,
                                      const recon::SceneView& view, const Eigen::Vector2d& pixel) {
    std::vector<control::PickablePart> pickable;
    std::vector<core::PartIndex> owners;
    for (core::PartIndex i = 0; i < result.layout->parts.size(); ++i) {
      const control::PartSection& section =
          sections.Of(i, result.layout->parts[i].mesh, result.world_from_parts[i], cut);
      for (const core::SharedMesh& mesh : {section.surface, section.cut_faces}) {
        if (mesh == nullptr) continue;
        pickable.push_back({TreeOf(mesh), result.world_from_parts[i]});
        owners.push_back(i);
      }
    }
    KeepTreesOf(pickable);
    std::optional<control::Pick> pick =
        control::PickPart(pickable, control::RayThrough(view, pixel), view.near_mm);
    if (pick) pick->part = owners[pick->part];
    return pick;
  }

  // Those of cuts that are gone are let go.
  void KeepTreesOf(const std::vector<control::PickablePart>& pickable) {
    std::vector<std::shared_ptr<const core::TriangleTree>> kept;
    for (const control::PickablePart& part : pickable) kept.push_back(part.tree);
    trees = std::move(kept);
  }
};

PartPicker::PartPicker(const OperatorView* view, QObject* parent)
    : QObject(parent), view_(view), parts_(std::make_shared<PickedParts>()) {}

PartPicker::~PartPicker() = default;

void PartPicker::Forget() { parts_ = std::make_shared<PickedParts>(); }

bool PartPicker::Pick(const recon::SceneView& view, const Eigen::Vector2d& pixel, Take take) {
  if (picking_ || !view_->result()) return false;
  auto found = std::make_shared<std::optional<control::Pick>>();
  picking_ = std::make_unique<BackgroundJob>(
      bridge_,
      [parts = parts_, result = view_->result(), cut = view_->cut(), view, pixel,
       found](const std::stop_token&) { *found = parts->PickAt(*result, cut, view, pixel); },
      [this, found, take = std::move(take)](const std::string& error) {
        picking_.reset();
        if (!error.empty()) return emit Failed(QString::fromStdString(error));
        take(*found);
      });
  return true;
}

}  // namespace elbowroom::console
