#include "cad_import/normalisation/model_normalisation.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cad_import/normalisation/body_joining.h"
#include "cad_import/normalisation/healing.h"
#include "cad_import/normalisation/rigid_instances.h"
#include "cad_import/normalisation/self_intersections.h"
#include "cad_import/normalisation/unit_choice.h"
#include "core/error.h"
#include "core/plain_text.h"

namespace elbowroom::cad_import {
namespace {

// Files with more triangles aren't searched for self-intersections: each triangle takes about 3 us.
constexpr std::int64_t kMostLookedThrough = 250'000;

// The most triangles of all instances together, as in one mesh of the whole model.
constexpr std::int64_t kMostPlaced = 20'000'000;

std::int64_t CheckedPlacedTriangles(const RawScene& scene, const std::string& where) {
  const std::int64_t count = PlacedTriangles(scene);
  if (count <= kMostPlaced) return count;
  throw core::Error(
      core::ErrorKind::kCad,
      fmt::format("{}: {} triangles in {} places, more than {}; export a coarser or a smaller model", where,
                  count, scene.instances.size(), kMostPlaced));
}

void Scale(RawScene& scene, double factor) {
  if (factor == 1.0) return;
  for (RawShape& shape : scene.shapes) {
    for (Eigen::Vector3d& vertex : shape.mesh.vertices_mm) vertex *= factor;
    shape.deviation *= factor;
  }
  for (RawInstance& instance : scene.instances) instance.model_from_shape.translation() *= factor;
}

CadShape ShapeOf(Body body) {
  CadShape shape{body.name, nullptr, {}, Heal(body.owned)};
  body.owned.mesh.deviation_mm = body.deviation;
  const std::vector<std::uint32_t>& owners = body.owned.owner_of_triangle;
  for (auto begin = owners.begin(); begin != owners.end();) {
    const auto end = std::upper_bound(begin, owners.end(), *begin);
    shape.pieces.push_back({body.piece_names[*begin], begin - owners.begin(), end - begin});
    begin = end;
  }
  shape.mesh = std::make_shared<const core::TriangleMesh>(std::move(body.owned.mesh));
  return shape;
}

std::int64_t TriangleCount(const CadModel& model) {
  std::int64_t count = 0;
  for (const CadInstance& instance : model.instances)
    count += static_cast<std::int64_t>(model.shapes[instance.shape].mesh->triangles.size());
  return count;
}

// Looks for self-intersections in each shape once, unless there is too much to look through.
void LookForSelfIntersections(CadModel& model) {
  std::int64_t triangles = 0;
  for (const CadShape& shape : model.shapes)
    triangles += static_cast<std::int64_t>(shape.mesh->triangles.size());
  const bool is_much = triangles > kMostLookedThrough;
  tbb::parallel_for(std::size_t{0}, model.shapes.size(), [&](std::size_t i) {
    CadShape& shape = model.shapes[i];
    shape.surface.self_intersections =
        is_much ? std::nullopt : std::optional(FindSelfIntersections(*shape.mesh).pairs);
  });
  if (is_much)
    model.report.warnings.push_back(
        fmt::format("{} triangles, more than {}: whether the surface runs through itself wasn't looked for",
                    triangles, kMostLookedThrough));
}

void Report(CadModel& model, std::int64_t before) {
  ImportReport& report = model.report;
  report.triangles = TriangleCount(model);
  report.dropped_triangles = before - report.triangles;
  report.watertight = true;
  SurfaceReport sum;
  for (const CadInstance& instance : model.instances) {
    const CadShape& shape = model.shapes[instance.shape];
    report.parts += static_cast<std::int64_t>(shape.pieces.size());
    for (const Eigen::Vector3d& vertex : shape.mesh->vertices_mm)
      report.bounds_mm.extend(instance.model_from_shape * vertex);
    report.watertight = report.watertight && shape.surface.watertight;
    report.deviation_mm = std::max(report.deviation_mm, shape.mesh->deviation_mm);
    sum.dropped_duplicates += shape.surface.dropped_duplicates;
    sum.turned += shape.surface.turned;
    sum.kept_flat += shape.surface.kept_flat;
    sum.open_edges += shape.surface.open_edges;
    sum.non_manifold_edges += shape.surface.non_manifold_edges;
    sum.inconsistent_edges += shape.surface.inconsistent_edges;
    if (shape.surface.self_intersections) *sum.self_intersections += *shape.surface.self_intersections;
  }
  report.repaired = report.dropped_triangles > 0 || sum.turned > 0;
  const auto warn = [&](std::int64_t count, const char* text) {
    if (count > 0) report.warnings.push_back(fmt::format(fmt::runtime(text), count));
  };
  warn(report.dropped_triangles - sum.dropped_duplicates, "{} triangles without area were dropped");
  warn(sum.kept_flat, "{} triangles have no area but hold a closed surface together; they were kept");
  warn(sum.dropped_duplicates, "{} triangles that are there twice were dropped");
  warn(sum.turned, "{} triangles that faced inwards or against their neighbours were turned");
  warn(*sum.self_intersections,
       "the surface runs through itself: {} pairs of triangles cross or lie on each other; where bodies "
       "overlap, how deep a hand is in them is measured to faces inside, too, and may be told too small");
  if (!report.watertight) {
    report.warnings.push_back(
        fmt::format("the surface isn't closed: {} open edges, {} edges of three or more triangles, {} "
                    "between triangles that face "
                    "different ways; it has no inside, so only touch of it is judged, not containment",
                    sum.open_edges, sum.non_manifold_edges, sum.inconsistent_edges));
  }
}

// assimp has names of its own: "<STL_BINARY>".
bool HasName(const std::string& name) { return !name.empty() && !name.starts_with('<'); }

// Those without a name are called `otherwise`.
BodyScene BodiesOf(RigidInstances rigid, const std::string& otherwise, const core::Progress& progress) {
  BodyScene bodies{{}, std::move(rigid.instances)};
  for (RawShape& shape : rigid.shapes) {
    progress.Report(static_cast<std::int64_t>(bodies.bodies.size()),
                    static_cast<std::int64_t>(rigid.shapes.size()), "healing part");
    if (!HasName(shape.name)) shape.name = otherwise;
    bodies.bodies.push_back(BodyOf(std::move(shape)));
  }
  return bodies;
}

}  // namespace

CadModel NormaliseModel(RawScene scene, FileFormat format, const ImportOptions& options,
                        const std::filesystem::path& file, const core::Progress& progress) {
  const std::string where = file.string();
  for (const RawShape& shape : scene.shapes) core::ValidateMesh(shape.mesh, where);
  if (scene.instances.empty()) core::ValidateMesh({}, where);
  for (RawShape& shape : scene.shapes) shape.name = core::Blanked(shape.name);
  for (RawInstance& instance : scene.instances) instance.path = core::Blanked(instance.path);
  CadModel model;
  std::vector<std::string>& warnings = model.report.warnings;
  warnings = scene.warnings;
  const FileUnit unit = ChooseUnit(scene, format, options, where, warnings);
  model.report.unit = unit.name;
  model.report.is_unit_stated = scene.unit.has_value();
  Scale(scene, unit.mm_per_unit / (scene.are_mm ? scene.unit->mm_per_unit : 1.0));

  const std::int64_t before = CheckedPlacedTriangles(scene, where);
  RigidInstances rigid = MakeRigid(scene, where);
  const std::string stem = file.stem().string();
  BodyScene bodies = BodiesOf(std::move(rigid), stem, progress);
  const bool is_single = bodies.instances.size() == 1 && !scene.are_bodies;
  if (const int joined = JoinOpenBodies(bodies); joined > 0)
    warnings.push_back(fmt::format(
        "{} open parts are closed surfaces together; they were joined, each under its first one's "
        "name",
        joined));
  if (is_single) SplitIntoPieces(bodies.bodies.front());
  for (Body& body : bodies.bodies) model.shapes.push_back(ShapeOf(std::move(body)));
  model.instances = std::move(bodies.instances);
  std::erase_if(model.instances, [&](const CadInstance& instance) {
    return model.shapes[instance.shape].mesh->triangles.empty();
  });
  for (CadInstance& instance : model.instances)
    if (!HasName(instance.path)) instance.path = stem;
  if (model.instances.empty()) core::ValidateMesh({}, where);
  LookForSelfIntersections(model);
  Report(model, before);
  if (scene.left_out > 0)
    warnings.push_back(
        fmt::format("{} lines, points and bodies without faces were left out", scene.left_out));
  WarnOfSize(model.report.bounds_mm, unit, warnings);
  return model;
}

}  // namespace elbowroom::cad_import
