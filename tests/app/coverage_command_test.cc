// What a rig can do at each place, as a user asks for it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "cad_import/cad_file.h"
#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "recon/calibration/lens_projection.h"
#include "recon/rig_files/rig_file.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using Eigen::Vector3d;
using test_support::ProgramRun;
namespace fs = std::filesystem;

constexpr std::array kQuantities = {"uncertainty_mm", "footprint_mm", "cameras_seeing", "phantom_fraction"};

class CoverageCommand : public testing::Test {
 protected:
  void Write(const core::Rig& rig, bool has_covariance = false) const {
    recon::RigFile file;
    file.rig = rig;
    file.sources.resize(rig.cameras.size());
    if (has_covariance) {
      recon::RigCalibration& calibration = file.calibration.emplace();
      calibration.noise_px = 0.2;
      calibration.covariance = Covariance(rig);
    }
    recon::WriteRigFile(file, folder_ / "rig.yml");
  }

  // A turn of 0.1 degrees and a centre off by 1 mm, each axis of each camera by itself.
  [[nodiscard]] static Eigen::MatrixXd Covariance(const core::Rig& rig) {
    std::vector<double> sigmas;
    for (const core::CameraModel& camera : rig.cameras) {
      const int intrinsics = recon::LensParametersOf(camera.calibration()).count();
      sigmas.insert(sigmas.end(), static_cast<std::size_t>(intrinsics), 0.0);
      sigmas.insert(sigmas.end(), 3, 0.0017);
      sigmas.insert(sigmas.end(), 3, 1.0);
      sigmas.push_back(0.0);
    }
    const auto count = static_cast<Eigen::Index>(sigmas.size());
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      covariance(i, i) = sigmas[static_cast<std::size_t>(i)] * sigmas[static_cast<std::size_t>(i)];
    return covariance;
  }

  [[nodiscard]] ProgramRun Run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"coverage", (folder_ / "rig.yml").string(), "--out",
                                       (folder_ / "out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments);
  }

  [[nodiscard]] nlohmann::json Json(std::vector<std::string> more = {}) const {
    more.emplace_back("--json");
    const ProgramRun run = Run(more);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }

  void WriteLayout(const Vector3d& second_at_mm) const {
    core::TriangleMesh tetrahedron;
    tetrahedron.vertices_mm = {{0, 0, 0}, {80, 0, 0}, {0, 80, 0}, {0, 0, 80}};
    tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    cad_import::WriteMeshFile(tetrahedron, folder_ / "part.stl");
    test_support::WriteText(folder_ / "layout.toml",
                            fmt::format("unit = \"mm\"\n[[part]]\nname = \"box & lid\"\nfile = "
                                        "\"part.stl\"\n[[part]]\nname = \"far\"\nfile = "
                                        "\"part.stl\"\nposition_mm = [{}, {}, {}]\n",
                                        second_at_mm.x(), second_at_mm.y(), second_at_mm.z()));
  }

  test_support::TemporaryFolder folder_;
};

void ExpectSpreads(const nlohmann::json& json) {
  for (const char* quantity : kQuantities) {
    ASSERT_TRUE(json.contains(quantity) && json[quantity].is_object()) << quantity;
    EXPECT_LE(json[quantity]["median"].get<double>(), json[quantity]["p95"].get<double>()) << quantity;
    EXPECT_LE(json[quantity]["p95"].get<double>(), json[quantity]["max"].get<double>()) << quantity;
    EXPECT_GE(json[quantity]["median"].get<double>(), 0.0) << quantity;
  }
  EXPECT_LE(json["phantom_fraction"]["max"].get<double>(), 1.0);
  EXPECT_LE(json["cameras_seeing"]["min"].get<double>(), json["cameras_seeing"]["median"].get<double>());
}

TEST_F(CoverageCommand, PrintsTheFourQuantitiesAndWritesItsFiles) {
  const core::Rig rig = recon::FourCameraRig();
  Write(rig);
  const nlohmann::json json = Json({"--grid", "60"});
  ASSERT_FALSE(json.is_null());
  ExpectSpreads(json);
  EXPECT_EQ(json["grid_mm"], 60.0);
  EXPECT_EQ(json["ball_mm"], 50.0);
  EXPECT_EQ(json["noise_px"], 0.3);
  EXPECT_FALSE(json["has_covariance"].get<bool>());
  EXPECT_FALSE(json["warnings"].empty()) << "that cameras are taken as exact";
  ASSERT_FALSE(json["advice"].empty());
  ASSERT_FALSE(json["next_cameras"].empty());
  std::set<std::string> names;
  for (const auto& file : json["files"]) {
    EXPECT_TRUE(fs::exists(file.get<std::string>())) << file;
    names.insert(fs::path(file.get<std::string>()).filename().string());
  }
  EXPECT_EQ(names, (std::set<std::string>{"coverage.html", "coverage.glb", "uncertainty_mm.svg",
                                          "footprint_mm.svg", "cameras_seeing.svg", "phantom_fraction.svg"}));
  const std::string page = test_support::ReadText(folder_ / "out/coverage.html");
  for (const char* from_elsewhere : {"http:", "https:"})
    EXPECT_EQ(page.find(from_elsewhere), std::string::npos) << "the page needs nothing from elsewhere";
  const std::string picture = test_support::ReadText(folder_ / "out/uncertainty_mm.svg");
  for (const core::CameraModel& camera : rig.cameras) {
    EXPECT_NE(page.find(camera.name()), std::string::npos);
    EXPECT_NE(picture.find(camera.name()), std::string::npos);
  }
  EXPECT_TRUE(picture.starts_with("<svg xmlns="));
}

TEST_F(CoverageCommand, TheVolumeReadsBackWithColoursCamerasAndParts) {
  const core::Rig rig = recon::FourCameraRig();
  Write(rig);
  WriteLayout({-100.0, 50.0, 20.0});
  ASSERT_FALSE(Json({"--grid", "60", "--layout", (folder_ / "layout.toml").string()}).is_null());
  const cad_import::CadModel model = cad_import::ImportCadFile(folder_ / "out/coverage.glb");
  std::set<std::string> paths;
  std::set<cad_import::ColorRgb> colours;
  std::int64_t cubes = 0;
  for (const cad_import::CadInstance& instance : model.instances) {
    paths.insert(instance.path);
    if (instance.path.find("uncertainty/") == std::string::npos) continue;
    ASSERT_TRUE(instance.color.has_value()) << instance.path;
    colours.insert(*instance.color);
    cubes += static_cast<std::int64_t>(model.shapes[instance.shape].mesh->triangles.size()) / 12;
  }
  EXPECT_GE(colours.size(), 6U);
  EXPECT_GT(cubes, 100);
  const auto holds = [&](const std::string& text) {
    return std::ranges::any_of(paths,
                               [&](const std::string& path) { return path.find(text) != std::string::npos; });
  };
  for (const core::CameraModel& camera : rig.cameras) EXPECT_TRUE(holds("cameras/" + camera.name()));
  EXPECT_TRUE(holds("workspace") && holds("next camera") && holds("parts/box & lid") && holds("parts/far"));
  // It is where it belongs: all of the workspace and the cameras are in it, in millimetres.
  const Eigen::AlignedBox3d& box = model.report.bounds_mm;
  constexpr double kSinglePrecisionMm = 0.5;
  for (const core::CameraModel& camera : rig.cameras)
    EXPECT_LT(box.exteriorDistance(camera.center_in_world()), kSinglePrecisionMm);
  EXPECT_LT(box.exteriorDistance(rig.workspace_mm.max()), kSinglePrecisionMm);
}

TEST_F(CoverageCommand, UsesTheCovarianceOfTheFile) {
  Write(recon::FourCameraRig(), true);
  const nlohmann::json json = Json({"--grid", "80", "--no-next"});
  ASSERT_FALSE(json.is_null());
  EXPECT_TRUE(json["has_covariance"].get<bool>());
  EXPECT_TRUE(json["warnings"].empty()) << json["warnings"];
  EXPECT_EQ(json["noise_px"], 0.2);
  EXPECT_TRUE(json["next_cameras"].empty());
  EXPECT_LT(json["exact_uncertainty_mm"].get<double>(), 0.5 * json["uncertainty_mm"]["median"].get<double>());
  EXPECT_NE(json["advice"].dump().find("most of a point's error is that of the calibration"),
            std::string::npos);
}

TEST_F(CoverageCommand, SaysThatTheGaugeRefutesTheRig) {
  Write(recon::FourCameraRig(), true);
  core::RigGauge gauge;
  gauge.error_mm = 2.25;
  gauge.bound_mm = 0.5;
  recon::SaveGauge(gauge, folder_ / "rig.yml");
  const nlohmann::json json = Json({"--grid", "80", "--no-next"});
  ASSERT_FALSE(json.is_null());
  ASSERT_EQ(json["warnings"].size(), 1U) << json["warnings"];
  EXPECT_NE(json["warnings"][0].get<std::string>().find("2.25 mm off, 0.50 mm is the bound"),
            std::string::npos)
      << json["warnings"];
}

TEST_F(CoverageCommand, ThePromisedCameraKeepsItsPromise) {
  constexpr double kSampling = 0.03;  // the promise is over some of the places
  core::Rig rig = recon::FourCameraRig();
  Write(rig);
  const nlohmann::json before = Json({"--grid", "50"});
  ASSERT_FALSE(before["next_cameras"].empty());
  const nlohmann::json& next = before["next_cameras"][0];
  core::CameraCalibration camera;
  for (const core::CameraModel& other : rig.cameras)
    if (other.name() == next["lens_of"].get<std::string>()) camera = other.calibration();
  const auto place = [&](const char* key) { return Vector3d(next[key][0], next[key][1], next[key][2]); };
  camera.name = "added";
  camera.cam_from_world = core::CamFromWorldLookingAt(place("position_mm"), place("look_at_mm"));
  rig.cameras.emplace_back(camera);
  Write(rig);
  const nlohmann::json after = Json({"--grid", "50", "--no-next"});
  for (const char* quantity : {"uncertainty_mm", "phantom_fraction"}) {
    EXPECT_NEAR(next["after"][quantity]["median"].get<double>() / after[quantity]["median"].get<double>(),
                1.0, kSampling);
    EXPECT_LT(after[quantity]["median"].get<double>(), before[quantity]["median"].get<double>());
  }
}

TEST_F(CoverageCommand, SaysWhatIsNearThePartsOfALayout) {
  Write(recon::FourCameraRig());
  WriteLayout({9000.0, 0.0, 0.0});
  const nlohmann::json json =
      Json({"--grid", "80", "--near", "60", "--layout", (folder_ / "layout.toml").string()});
  ASSERT_FALSE(json.is_null());
  ASSERT_EQ(json["parts"].size(), 2U);
  EXPECT_EQ(json["parts"][0]["part"], "box & lid");
  ExpectSpreads(json["parts"][0]);
  EXPECT_GT(json["parts"][0]["nodes"].get<int>(), 100);
  EXPECT_EQ(json["parts"][1]["nodes"], 0);
  EXPECT_TRUE(json["parts"][1]["uncertainty_mm"].is_null());
  EXPECT_NE(json["warnings"].dump().find("'far'"), std::string::npos) << json["warnings"];
  EXPECT_FALSE(json["next_cameras"][0]["near_after"].is_null());
  const std::string page = test_support::ReadText(folder_ / "out/coverage.html");
  EXPECT_NE(page.find("box &amp; lid"), std::string::npos);
}

TEST_F(CoverageCommand, ChoosesAGridThatFitsTheWorkspace) {
  core::Rig rig = recon::FourCameraRig();
  rig.workspace_mm = {Vector3d(-20000, -20000, 0), Vector3d(20000, 20000, 20000)};
  Write(rig);
  const nlohmann::json huge = Json({"--no-next"});
  EXPECT_GT(huge["grid_mm"].get<double>(), 20.0);
  EXPECT_LE(huge["nodes"].get<double>(), 250000.0);
  EXPECT_NE(huge["warnings"].dump().find("the grid is"), std::string::npos);
  rig.workspace_mm = {Vector3d(-4, -4, 10), Vector3d(4, 4, 26)};
  Write(rig);
  const nlohmann::json tiny = Json({"--no-next"});
  EXPECT_LT(tiny["grid_mm"].get<double>(), 2.0);
  EXPECT_EQ(tiny["ball_mm"], 4.0);
  ExpectSpreads(tiny);
}

TEST_F(CoverageCommand, NothingSeenIsAnAnswer) {
  core::Rig rig = recon::FourCameraRig();
  rig.workspace_mm = {Vector3d(0, 0, 50000), Vector3d(200, 200, 50200)};  // above all cameras
  Write(rig);
  const nlohmann::json json = Json();
  ASSERT_FALSE(json.is_null());
  EXPECT_TRUE(json["uncertainty_mm"].is_null());
  EXPECT_TRUE(json["phantom_fraction"].is_null());
  EXPECT_EQ(json["cameras_seeing"]["max"], 0.0);
  EXPECT_EQ(json["seen_share"], 0.0);
}

TEST_F(CoverageCommand, OneCameraIsToldToGetASecond) {
  core::Rig rig = recon::FourCameraRig();
  rig.cameras.resize(1, rig.cameras[0]);
  Write(rig);
  const nlohmann::json json = Json({"--grid", "80"});
  ASSERT_FALSE(json.is_null());
  EXPECT_TRUE(json["uncertainty_mm"].is_null());
  EXPECT_NE(json["advice"].dump().find("a second"), std::string::npos) << json["advice"];
  ASSERT_FALSE(json["next_cameras"].empty());
  EXPECT_FALSE(json["next_cameras"][0]["after"]["uncertainty_mm"].is_null());
}

TEST_F(CoverageCommand, BadInputIsOneLineAndLeavesNoFiles) {
  Write(recon::FourCameraRig());
  const auto expect = [&](const std::vector<std::string>& arguments, int status, const std::string& part) {
    const ProgramRun run = test_support::RunProgram(test_support::ProgramFile(), arguments);
    EXPECT_EQ(run.exit_status, status) << part;
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << part;
  };
  const std::string rig = (folder_ / "rig.yml").string(), out = (folder_ / "out").string();
  expect({"coverage", (folder_ / "none.yml").string(), "--out", out}, 1, "none.yml");
  expect({"coverage", rig, "--grid", "0", "--out", out}, 2, "--grid");
  expect({"coverage", rig, "--grid", "-5", "--out", out}, 2, "--grid");
  expect({"coverage", rig, "--grid", "0.01", "--out", out}, 1, "choose --grid");
  expect({"coverage", rig, "--ball", "nan", "--out", out}, 2, "--ball");
  expect({"coverage", rig, "--layout", (folder_ / "none.toml").string(), "--out", out}, 1, "none.toml");
  expect({"coverage", rig}, 2, "--out");
  test_support::WriteText(folder_ / "file", "not a folder");
  expect({"coverage", rig, "--grid", "100", "--no-next", "--out", (folder_ / "file/out").string()}, 1,
         "file");
  EXPECT_EQ(test_support::ReadText(folder_ / "file"), "not a folder");
}

const fs::path kSharedData = test_support::SharedDataFolder();

TEST_F(CoverageCommand, TakesEveryRigOfTheRealData) {
  if (!fs::exists(kSharedData)) GTEST_SKIP() << "NOT TESTED: there is no real data at " << kSharedData;
  for (const char* set : {"four_cameras", "bunny6", "bunny36", "teapot", "elephant"}) {
    const ProgramRun run = test_support::RunProgram(
        test_support::ProgramFile(), {"coverage", (kSharedData / set / "rig.yml").string(), "--out",
                                      (folder_ / set).string(), "--no-next", "--json"});
    ASSERT_EQ(run.exit_status, 0) << set << ": " << run.err;
    const auto json = nlohmann::json::parse(run.out);
    ExpectSpreads(json);
    EXPECT_GT(json["seen_share"].get<double>(), 0.9) << set;
    EXPECT_GT(json["reach_share"].get<double>(), 0.3) << set;
    EXPECT_TRUE(fs::exists(folder_ / set / "coverage.glb"));
    std::printf("%s: error %.3f mm, %.3f at worst; phantom share %.3f, %.3f at worst\n", set,
                json["uncertainty_mm"]["median"].get<double>(), json["uncertainty_mm"]["max"].get<double>(),
                json["phantom_fraction"]["median"].get<double>(),
                json["phantom_fraction"]["max"].get<double>());
  }
}

}  // namespace
}  // namespace elbowroom
