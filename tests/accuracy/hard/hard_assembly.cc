#include "tests/accuracy/hard/hard_assembly.h"

#include <fmt/format.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <filesystem>

#include "cad_import/cad_file.h"
#include "core/error.h"
#include "core/heat_map.h"
#include "tests/support/step_assembly.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kRequiredMm = 15.0, kUncertaintyMm = 0.5;

// Parts 40 mm apart, ten a row, ten rows a layer.
void WriteParts(const std::filesystem::path& path, std::uint64_t seed) {
  constexpr int kARow = 10;
  constexpr double kApartMm = 40.0;
  const std::vector<test_support::StepBody> bodies = {
      {"block", BRepPrimAPI_MakeBox(26.0, 22.0, 14.0).Shape()},
      {"post", BRepPrimAPI_MakeCylinder(6.0, 36.0).Shape()},
      {"ring", BRepPrimAPI_MakeTorus(13.0, 4.0).Shape()}};
  recon::Random random(seed);
  std::vector<test_support::StepInstance> instances;
  for (int i = 0; i < kAssemblyParts; ++i) {
    const std::size_t body = static_cast<std::size_t>(i) % bodies.size();
    const Vector3d at_mm = kApartMm * Vector3d(i % kARow, i / kARow % kARow, i / (kARow * kARow));
    instances.push_back({fmt::format("{} {}", bodies[body].name, i), body, {random.Rotation(), at_mm}});
  }
  test_support::WriteStepAssembly(path, "rack", bodies, instances);
}

}  // namespace

HardAssembly ImportHardAssembly(std::uint64_t seed) {
  const test_support::TemporaryFolder folder;
  WriteParts(folder / "rack.step", seed);
  const cad_import::CadModel model = cad_import::ImportCadFile(folder / "rack.step");
  core::Require(model.instances.size() == kAssemblyParts, "every part is imported");
  HardAssembly assembly;
  for (const cad_import::CadShape& shape : model.shapes) assembly.shapes.emplace_back(shape.mesh);
  for (const cad_import::CadInstance& instance : model.instances)
    assembly.instances.push_back({instance.shape, instance.model_from_shape});
  const core::SharedMesh whole = cad_import::Flatten(model).mesh;
  assembly.whole = {"assembly", std::make_shared<const core::TriangleTree>(whole),
                    std::make_shared<const core::SurfacePatches>(whole, core::kHeatPatchMm)};
  return assembly;
}

review::PartReviewOptions AssemblyReview() {
  review::PartReviewOptions options;
  options.required_clearance_mm = kRequiredMm;
  options.uncertainty_mm = kUncertaintyMm;
  return options;
}

core::PartContact ReviewOf(const recon::VisualHull& hull, const HardAssembly& assembly,
                           const core::RigidTransform& world_from_assembly, std::size_t part,
                           review::InsideCells* inside) {
  return review::ReviewPart(hull, assembly.TreeOf(part),
                            world_from_assembly * assembly.instances[part].assembly_from_part, part,
                            AssemblyReview(), inside);
}

}  // namespace elbowroom::accuracy
