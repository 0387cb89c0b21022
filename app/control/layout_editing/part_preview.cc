#include "app/control/layout_editing/part_preview.h"

#include <Eigen/Geometry>
#include <map>
#include <utility>

#include "cad_import/cad_file.h"
#include "cad_import/normalisation/likely_unit.h"

namespace elbowroom::control {
namespace {

using cad_import::CadModel;
using cad_import::CadShape;

// Adds the instance to the nodes on its path, from the leaf up.
void Count(const CadShape& shape, const Eigen::AlignedBox3d& bounds_mm, std::optional<std::size_t> leaf,
           std::vector<PreviewNode>& nodes, std::vector<Eigen::AlignedBox3d>& boxes_mm) {
  for (auto at = leaf; at; at = nodes[*at].parent) {
    PreviewNode& node = nodes[*at];
    ++node.instances;
    node.triangles += static_cast<std::int64_t>(shape.mesh->triangles.size());
    node.open_edges += shape.surface.open_edges;
    node.is_watertight = node.is_watertight && shape.surface.watertight;
    boxes_mm[*at].extend(bounds_mm);
  }
}

std::vector<PreviewNode> TreeOf(const CadModel& model) {
  std::vector<PreviewNode> nodes;
  std::map<std::string, std::size_t> places;
  for (std::string& path : cad_import::NodesOf(model)) {
    PreviewNode node;
    const std::size_t slash = path.rfind('/');
    if (slash != std::string::npos) node.parent = places.at(path.substr(0, slash));
    node.name = slash == std::string::npos ? path : path.substr(slash + 1);
    places.emplace(path, nodes.size());
    node.path = std::move(path);
    nodes.push_back(std::move(node));
  }
  std::vector<Eigen::AlignedBox3d> boxes_mm(nodes.size());
  for (const cad_import::CadInstance& instance : model.instances) {
    const CadShape& shape = model.shapes[instance.shape];
    Count(shape, core::BoundsOf(*shape.mesh, instance.model_from_shape), places.at(instance.path), nodes,
          boxes_mm);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].size_mm = boxes_mm[i].sizes();
  return nodes;
}

// The numbers were taken for millimetres.
std::vector<SizeInUnit> SizesOf(const Eigen::Vector3d& size_mm) {
  const core::LengthUnit likely = cad_import::LikelyUnit(size_mm.maxCoeff());
  std::vector<SizeInUnit> sizes;
  for (const core::LengthUnit unit : cad_import::kLengthUnits)
    sizes.push_back({unit, core::MillimetresPer(unit) * size_mm, unit == likely});
  return sizes;
}

}  // namespace

PartPreview PreviewPart(const std::filesystem::path& file, std::optional<core::LengthUnit> unit,
                        const core::Progress& progress, const std::stop_token& stop) {
  return PreviewOf(
      std::make_shared<const CadModel>(cad_import::ImportCadFile(
          file, {.unit = unit, .unit_if_file_has_none = core::LengthUnit::kMillimetre}, progress, stop)),
      file, unit);
}

PartPreview PreviewOf(std::shared_ptr<const CadModel> model, const std::filesystem::path& file,
                      std::optional<core::LengthUnit> unit) {
  PartPreview preview;
  preview.file = file;
  preview.chosen_unit = unit;
  preview.nodes = TreeOf(*model);
  preview.size_mm = model->report.bounds_mm.sizes();
  for (const cad_import::CadInstance& instance : model->instances)
    preview.open_edges += model->shapes[instance.shape].surface.open_edges;
  if (!unit && !model->report.is_unit_stated) preview.sizes = SizesOf(preview.size_mm);
  preview.model = std::move(model);
  return preview;
}

}  // namespace elbowroom::control
