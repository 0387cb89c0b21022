#include "app/control/layers/heat_layer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/control/layers/color_scale.h"
#include "core/error.h"

namespace elbowroom::control {

HeatLayerMaker::HeatLayerMaker(std::vector<core::SharedMesh> part_meshes) {
  for (core::SharedMesh& mesh : part_meshes) parts_.emplace_back().mesh = std::move(mesh);
}

void HeatLayerMaker::Take(core::HeatMap map) {
  core::Require(map.part < parts_.size(), "a heat map of a part of the layout");
  Part& part = parts_[map.part];
  if (!part.patches) part.patches.emplace(part.mesh, map.patch_mm);
  core::Require(map.dwell_s.size() == part.patches->size(), "a heat map of the part's mesh");
  part.dwell_s = std::move(map.dwell_s);
  part.most_s = part.dwell_s.empty() ? 0.0F : *std::ranges::max_element(part.dwell_s);
  part.scale_s = 0.0;
}

SharedHeatLayer HeatLayerMaker::Make() {
  auto layer = std::make_shared<HeatLayer>();
  float most_s = 0.0F;
  for (const Part& part : parts_) most_s = std::max(most_s, part.most_s);
  layer->most_s = RoundedUp(static_cast<double>(most_s));
  for (core::PartIndex i = 0; i < parts_.size(); ++i) {
    if (!(parts_[i].most_s > 0.0F)) continue;
    if (parts_[i].scale_s != layer->most_s) Renew(i, layer->most_s);
    layer->parts.push_back(parts_[i].layer);
  }
  return layer;
}

void HeatLayerMaker::Renew(core::PartIndex index, double most_s) {
  Part& part = parts_[index];
  part.scale_s = most_s;
  std::vector<std::vector<std::size_t>> of(kHeatShades + 1);
  for (std::size_t patch = 0; patch < part.dwell_s.size(); ++patch) {
    const double share = static_cast<double>(part.dwell_s[patch]) / most_s;
    if (share > 0.0)
      of[static_cast<std::size_t>(std::clamp(std::ceil(share * kHeatShades), 1.0, 1.0 * kHeatShades))]
          .push_back(patch);
  }
  if (part.layer != nullptr && of == part.of) return;
  auto renewed = std::make_shared<PartHeat>();
  renewed->part = index;
  for (std::size_t shade = 1; shade < of.size(); ++shade) {
    if (of[shade].empty()) continue;
    const bool is_kept = part.layer != nullptr && of[shade] == part.of[shade];
    if (is_kept) {
      renewed->pieces.push_back(
          *std::ranges::find(part.layer->pieces, static_cast<int>(shade), &HeatPiece::shade));
    } else {
      renewed->pieces.push_back({MeshOf(part, of[shade]), static_cast<int>(shade)});
      ++pieces_made_;
    }
  }
  part.of = std::move(of);
  part.layer = std::move(renewed);
}

// Patches are numbered triangle by triangle, and are in rising order.
core::SharedMesh HeatLayerMaker::MeshOf(const Part& part, const std::vector<std::size_t>& patches) {
  core::TriangleMesh mesh;
  std::size_t triangle = 0;
  for (auto patch = patches.begin(); patch != patches.end();) {
    while (part.patches->EndOf(triangle) <= *patch) ++triangle;
    const std::vector<core::SurfacePatches::Corners> corners = part.patches->CornersOf(triangle);
    for (; patch != patches.end() && *patch < part.patches->EndOf(triangle); ++patch) {
      const core::SurfacePatches::Corners& of_patch = corners[*patch - part.patches->FirstOf(triangle)];
      const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
      mesh.vertices_mm.insert(mesh.vertices_mm.end(), {of_patch.a, of_patch.b, of_patch.c});
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

}  // namespace elbowroom::control
