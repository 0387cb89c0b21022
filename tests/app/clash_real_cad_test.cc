// `clash` on fifty parts from real CAD files, where ../shared/data is present, against brute force.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "cad_import/layout/layout_file.h"
#include "cad_import/mesh_file.h"
#include "tests/oracles/mesh_gap.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using core::LengthUnit;

const std::filesystem::path kCad = test_support::SharedDataFolder() / "cad";

// What both sides make of the same doubles differs by some 1e-12 mm; this is the accuracy that is promised.
constexpr double kToleranceMm = 1e-6;
constexpr int kParts = 50;
constexpr double kRequiredMm = 10.0;
// Brute force takes the product of the triangles.
constexpr std::size_t kMostTriangles = 2500;
// All parts stand in a cube of this side, and are about this large.
constexpr double kReachMm = 500.0, kSizeMm = 120.0;

constexpr const char* kFiles[] = {"nasa42/ARC_ChaserBody.obj",
                                  "nasa42/ARC_Target.obj",
                                  "nasa42/Aura_SolarArray.obj",
                                  "nasa42/CMG.obj",
                                  "nasa42/Cubesat_1U.obj",
                                  "nasa42/Cubesat_3U.obj",
                                  "nasa42/Cubesat_6U.obj",
                                  "nasa42/HST.obj",
                                  "nasa42/ISS_SmSolarPanel.obj",
                                  "nasa42/ISS_SolarTruss.obj",
                                  "nasa42/IonCruiser.obj",
                                  "nasa42/Kepler.obj",
                                  "nasa42/Knot.obj",
                                  "nasa42/LanderBody.obj",
                                  "nasa42/LanderLeg.obj",
                                  "nasa42/MDLSat_Antenna.obj",
                                  "nasa42/MDLSat_MainBody.obj",
                                  "nasa42/RST.obj",
                                  "nasa42/RoverBody.obj",
                                  "nasa42/SmallTet.obj",
                                  "nasa42/Sunflower.obj",
                                  "nasa42/Telescope.obj",
                                  "nasa42/TestSlab1.obj",
                                  "nasa42/TumbleSat0.obj",
                                  "nasa42/TwoSpheres.obj",
                                  "trimesh_models/featuretype.STL",
                                  "trimesh_models/angle_block.STL",
                                  "trimesh_models/plate_holes.STL",
                                  "trimesh_models/idler_riser.STL",
                                  "trimesh_models/octagonal_pocket.stl",
                                  "trimesh_models/1002_tray_bottom.STL",
                                  "trimesh_models/cycloidal.ply",
                                  "trimesh_models/fandisk.obj",
                                  "trimesh_models/tube.obj",
                                  "trimesh_models/wallhole.obj",
                                  "trimesh_models/round.stl",
                                  "trimesh_models/large_block.STL",
                                  "trimesh_models/7_8ths_cube.stl",
                                  "trimesh_models/cylinder.stl",
                                  "trimesh_models/multibody.stl"};

// The unit that makes the file's longest side nearest to kSizeMm; nothing for a file with too many triangles.
std::optional<LengthUnit> FittingUnit(const std::filesystem::path& file) {
  const cad_import::ImportedMesh imported =
      cad_import::ImportMeshFile(file, {.unit = LengthUnit::kMillimetre});
  const std::size_t most = kMostTriangles * static_cast<std::size_t>(test_support::SoakScale());
  if (imported.mesh->triangles.size() > most) return std::nullopt;
  const double side_mm = imported.report.bounds_mm.sizes().maxCoeff();
  const auto misfit = [&](LengthUnit unit) {
    return std::abs(std::log(side_mm * core::MillimetresPer(unit) / kSizeMm));
  };
  constexpr LengthUnit kUnits[] = {LengthUnit::kMillimetre, LengthUnit::kCentimetre, LengthUnit::kInch,
                                   LengthUnit::kMetre};
  return *std::min_element(std::begin(kUnits), std::end(kUnits),
                           [&](LengthUnit a, LengthUnit b) { return misfit(a) < misfit(b); });
}

// Fifty parts at seeded poses: every file of few enough triangles, then the first of them again.
std::string LayoutText() {
  std::vector<std::string> parts;
  for (const char* file : kFiles) {
    if (const auto unit = FittingUnit(kCad / file))
      parts.push_back(fmt::format("file = \"{}\"\nunit = \"{}\"\n", (kCad / file).string(), ToString(*unit)));
  }
  std::mt19937_64 random(50);
  std::uniform_real_distribution<double> position_mm(0.0, kReachMm), angle_deg(-180.0, 180.0);
  std::string text;
  for (std::size_t i = 0; i < kParts; ++i) {
    text += fmt::format("[[part]]\nname = \"part {}\"\n{}", i, parts[i % parts.size()]);
    text += fmt::format("position_mm = [{}, {}, {}]\n", position_mm(random), position_mm(random),
                        position_mm(random));
    text += fmt::format("rotation_rpy_deg = [{}, {}, {}]\n", angle_deg(random), angle_deg(random),
                        angle_deg(random));
  }
  return text;
}

struct Truth {
  double distance_mm = 0.0;
  bool contained = false;

  [[nodiscard]] std::string Verdict() const {
    if (contained || distance_mm <= kToleranceMm) return "contact";
    return distance_mm < kRequiredMm ? "near" : "clear";
  }
};

Truth ByBruteForce(const core::Part& a, const core::Part& b) {
  Truth truth{static_cast<double>(
      oracles::GapOfMeshes(*a.mesh, a.world_from_part, *b.mesh, b.world_from_part).distance_mm)};
  truth.contained = truth.distance_mm > kToleranceMm &&
                    (oracles::HasVertexInside(*a.mesh, a.world_from_part, *b.mesh, b.world_from_part) ||
                     oracles::HasVertexInside(*b.mesh, b.world_from_part, *a.mesh, a.world_from_part));
  return truth;
}

// Counts the verdicts; the largest error of a distance.
double ExpectAll(const nlohmann::json& results, const std::vector<Truth>& truths,
                 std::map<std::string, int>& of_verdict) {
  double worst_mm = 0.0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const nlohmann::json& result = results[i];
    SCOPED_TRACE(result.dump());
    EXPECT_EQ(result["verdict"], truths[i].Verdict()) << truths[i].distance_mm;
    EXPECT_EQ(result["contained"], truths[i].contained);
    EXPECT_LE(result["at_least_mm"].get<double>(), truths[i].distance_mm + kToleranceMm);
    ++of_verdict[result["verdict"].get<std::string>()];
    if (result["distance_mm"].is_null()) continue;
    worst_mm = std::max(worst_mm, std::abs(result["distance_mm"].get<double>() - truths[i].distance_mm));
  }
  return worst_mm;
}

TEST(ClashOnRealCad, FiftyPartsAreJudgedAsByBruteForce) {
  if (!std::filesystem::is_directory(kCad))
    GTEST_SKIP() << "NOT TESTED: the real CAD files of " << kCad << " are not on this machine";
  const test_support::TemporaryFolder folder;
  const std::filesystem::path file = folder / "layout.toml";
  test_support::WriteText(file, LayoutText());
  const core::Layout layout = cad_import::ImportLayoutFile(file).layout;
  const test_support::ProgramRun run = test_support::RunProgram(
      test_support::ProgramFile(),
      {"clash", file.string(), "--required", fmt::format("{}", kRequiredMm), "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const nlohmann::json json = nlohmann::json::parse(run.out);
  const nlohmann::json& results = json["results"];
  ASSERT_EQ(results.size(), static_cast<std::size_t>(kParts * (kParts - 1) / 2));

  std::vector<Truth> truths(results.size());
  const auto part = [&](const nlohmann::json& name) -> const core::Part& {
    return layout.parts[*layout.FindPart(name.get<std::string>())];
  };
  tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
    truths[i] = ByBruteForce(part(results[i]["a"]), part(results[i]["b"]));
  });
  std::map<std::string, int> of_verdict;
  const double worst_mm = ExpectAll(results, truths, of_verdict);
  EXPECT_LE(worst_mm, kToleranceMm);
  EXPECT_GT(of_verdict["contact"], 20);
  EXPECT_GT(of_verdict["near"], 5);
  std::size_t triangles = 0;
  for (const core::Part& each : layout.parts) triangles += each.mesh->triangles.size();
  fmt::print(
      "{} parts, {} triangles, {} pairs: {} contacts, {} near, {} clear ({} by bounds); {} FCL calls, "
      "{:.1f} ms; largest error of a distance {:.1e} mm\n",
      kParts, triangles, json["pairs"].get<int>(), of_verdict["contact"], of_verdict["near"],
      of_verdict["clear"], json["settled_by_bounds"].get<int>(), json["fcl_calls"].get<int>(),
      json["time_ms"].get<double>(), worst_mm);
}

}  // namespace
}  // namespace elbowroom
