#include "recon/gl/exact_view/pencil_tables.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "recon/exact_view/cast_intervals.h"

namespace elbowroom::recon::gl {
namespace {

// Stands for an infinite angle: shaders needn't know infinities, and angles end at 2.
constexpr float kBeyondAngles = 4.0F;

// Adds the crossings of one interval that are entries, or those that are exits.
void AddCrossings(const CastPencil& pencil, std::size_t interval, bool entries, PencilTables* tables) {
  const CastIntervals& intervals = pencil.intervals;
  const Eigen::Vector2f angles(std::max(intervals.begins[interval], -kBeyondAngles),
                               std::min(intervals.begins[interval + 1], kBeyondAngles));
  const CastIntervals::Run run = intervals.RunOf(interval);
  for (std::size_t i = run.begin; i < run.end; ++i) {
    if (pencil.IsEntry(run, i) != entries) continue;
    const CastEdge& edge = pencil.edges[static_cast<std::size_t>(intervals.crossings[i].edge())];
    tables->angles.push_back(angles);
    tables->keys.emplace_back(edge.key.du, edge.key.dv, edge.key.at_origin, static_cast<float>(edge.edge));
  }
}

// Adds a run of crossings for each bin. Returns the number of the first run.
std::size_t AddRuns(const CastPencil& pencil, bool entries, PencilTables* tables) {
  const std::size_t first_run = tables->runs.size();
  for (std::uint32_t bin = 0; bin < pencil.bins(); ++bin) {
    const auto begin = static_cast<std::uint32_t>(tables->angles.size());
    const auto [first, last] = IntervalsOf(pencil, bin, bin);
    for (std::size_t i = first; i <= last; ++i) AddCrossings(pencil, i, entries, tables);
    tables->runs.push_back({begin, static_cast<std::uint32_t>(tables->angles.size())});
  }
  return first_run;
}

RayLabel LabelOf(const EpipolarEdges& pencil) {
  if (pencil.is_concentric()) return RayLabel::kByPixel;
  return pencil.starts_inside() ? RayLabel::kObject : RayLabel::kBackground;
}

void AddCaster(const EpipolarEdges& pencil, PencilTables* tables) {
  const CastPencil& cast = pencil.cast();
  const std::size_t entries = AddRuns(cast, true, tables);
  const std::size_t exits = AddRuns(cast, false, tables);
  tables->forms.emplace_back(cast.x.du, cast.x.dv, cast.x.at_origin, cast.least_angle);
  tables->forms.emplace_back(cast.y.du, cast.y.dv, cast.y.at_origin, cast.bins_per_angle);
  tables->forms.emplace_back(static_cast<float>(entries), static_cast<float>(exits),
                             static_cast<float>(cast.bins()), static_cast<float>(LabelOf(pencil)));
}

std::vector<const EpipolarEdges*> ConcentricOf(const ViewPencils::Pencils& pencils) {
  std::vector<const EpipolarEdges*> concentric;
  for (const auto& pencil : pencils)
    if (pencil->is_concentric()) concentric.push_back(pencil.get());
  return concentric;
}

}  // namespace

PencilTables Tabulate(const ViewPencils& pencils) {
  PencilTables tables;
  for (const auto& pencil : pencils.cameras()) AddCaster(*pencil, &tables);
  for (const auto& pencil : pencils.visibility_outlines()) AddCaster(*pencil, &tables);
  for (const auto* faces : {&pencils.box().not_before, &pencils.box().not_after, &pencils.box().beside})
    for (const CastForm& face : *faces) tables.forms.emplace_back(face.du, face.dv, face.at_origin, 0.0F);
  return tables;
}

std::vector<float> LabelsByPixel(const ViewPencils& pencils, const std::vector<PixelBox>& squares) {
  const std::vector<const EpipolarEdges*> cameras = ConcentricOf(pencils.cameras());
  const std::vector<const EpipolarEdges*> visibility_outlines = ConcentricOf(pencils.visibility_outlines());
  std::vector<float> labels;
  if (cameras.empty()) return labels;
  const auto width = static_cast<std::size_t>(pencils.rays().width_px());
  labels.assign(width * static_cast<std::size_t>(pencils.rays().height_px()), 0.0F);
  tbb::parallel_for(std::size_t{0}, squares.size(), [&](std::size_t i) {
    const PixelBox& square = squares[i];
    for (int y = square.y; y < square.bottom; ++y) {
      for (int x = square.x; x < square.right; ++x) {
        const Eigen::Vector2d uv = pencils.rays().At(x, y);
        if (std::isnan(uv.x())) continue;
        const auto sees = [&](const EpipolarEdges* pencil) { return pencil->IsObjectAlong(uv); };
        labels[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
            (std::all_of(cameras.begin(), cameras.end(), sees) ? 1.0F : 0.0F) +
            (std::any_of(visibility_outlines.begin(), visibility_outlines.end(), sees) ? 2.0F : 0.0F);
      }
    }
  });
  return labels;
}

}  // namespace elbowroom::recon::gl
