// The program as a user runs it: exit statuses, single lines, JSON keys, files whole or not at all.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/triangle_mesh.h"
#include "recon/rig_files/rig_file.h"
#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::ProgramRun;
using test_support::RunProgram;
using test_support::TemporaryFolder;
using test_support::WriteText;

ProgramRun Elbowroom(const std::vector<std::string>& arguments) {
  return RunProgram(test_support::ProgramFile(), arguments);
}

// Exit status 1, nothing on stdout, one line on stderr that says all of `words`.
void ExpectOneLine(const ProgramRun& run, const std::vector<std::string>& words) {
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  for (const std::string& word : words)
    EXPECT_NE(run.err.find(word), std::string::npos) << word << " in: " << run.err;
}

class CliOnBallRig : public testing::Test {
 protected:
  void SetUp() override {
    rig_ = test_support::WriteBallRig(folder_.path() / "rig").string();
    box_ = (folder_ / "box.stl").string();
    test_support::WriteBoxStl(box_, 80.0);
  }
  // A pose file that puts the part at a point of the world.
  std::string PoseAt(double x, double y, double z) const {
    const std::filesystem::path file = folder_ / "pose.yml";
    WriteText(
        file,
        "%YAML:1.0\nrotation_world_from_part: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
        "   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]\n"
        "translation_world_from_part_mm: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n   data: [ " +
            std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(z) + " ]\n");
    return file.string();
  }

  // A camera that looks down on the ball from (300, -350, 450).
  std::string WriteView() const {
    core::CameraCalibration c;
    c.name = "view";
    c.image_width_px = 200;
    c.image_height_px = 150;
    c.camera_matrix << 360.0, 0.0, 100.0, 0.0, 360.0, 75.0, 0.0, 0.0, 1.0;
    c.distortion_coefficients = {-0.1, 0.02, 0.0, 0.0, 0.0};
    c.cam_from_world = core::CamFromWorldLookingAt({300.0, -350.0, 450.0}, {0.0, 0.0, 200.0});
    core::Rig rig;
    rig.workspace_mm = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
    rig.cameras.emplace_back(c);
    recon::WriteRigFile({rig, {{}}}, folder_ / "view.yml");
    return (folder_ / "view.yml").string();
  }

  TemporaryFolder folder_;
  std::string rig_;
  std::string box_;
};

TEST(Cli, HelpNamesWhatIsBuilt) {
  const ProgramRun run = Elbowroom({"--help"});
  EXPECT_EQ(run.exit_status, 0);
  for (const char* command : {"demo",      "trial",  "report",  "segment",  "view",   "hull",  "contacts",
                              "clearance", "clash",  "sweep",   "import",   "layout", "board", "bench",
                              "keepout",   "replay", "touches", "sessions", "study",  "plan",  "simulate"}) {
    EXPECT_NE(run.out.find(std::string("\n  ") + command + " "), std::string::npos) << command;
  }
}

TEST(Cli, EveryCommandHasHelp) {
  for (const char* command : {"demo",   "report",  "segment",  "view",   "hull",  "contacts", "clearance",
                              "clash",  "sweep",   "import",   "layout", "board", "bench",    "keepout",
                              "replay", "touches", "sessions", "study",  "plan",  "simulate"}) {
    EXPECT_EQ(Elbowroom({command, "--help"}).exit_status, 0) << command;
  }
  EXPECT_EQ(Elbowroom({"trial", "run", "--help"}).exit_status, 0);
}

TEST(Cli, WrongUsageExitsWithTwo) {
  EXPECT_EQ(Elbowroom({"levitate"}).exit_status, 2);
  EXPECT_EQ(Elbowroom({"hull"}).exit_status, 2);
  EXPECT_EQ(Elbowroom({"hull", "rig.yml", "--frame", "x", "--edge", "1", "--out", "o.ply"}).exit_status, 2);
  EXPECT_EQ(Elbowroom({"import", "a.stl", "--unit", "furlong"}).exit_status, 2);
  EXPECT_EQ(
      Elbowroom({"trial", "run", "t.toml", "--session", "s.db", "--headless", "--frames", "a:b"}).exit_status,
      2);
  EXPECT_EQ(Elbowroom({"--threads", "0", "import", "a.stl"}).exit_status, 2);
  EXPECT_EQ(Elbowroom({"trial", "run", "t.toml", "--session", "s.db", "--frames", "5:2"}).exit_status, 2);
}

TEST(Cli, VersionIsOneLine) {
  const ProgramRun run = Elbowroom({"--version"});
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_TRUE(run.out.starts_with("elbowroom "));
}

TEST_F(CliOnBallRig, HullIsWatertightAndAroundTheBall) {
  const std::string out = (folder_ / "hull.ply").string();
  const ProgramRun run = Elbowroom({"hull", rig_, "--frame", "0", "--edge", "3", "--out", out, "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  for (const char* key : {"vertices", "triangles", "volume_mm3", "watertight", "time_ms", "first_time_ms"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_TRUE(json["watertight"].get<bool>());
  const double ball_mm3 = 4.0 / 3.0 * M_PI * std::pow(test_support::kBallRadiusMm, 3);
  EXPECT_GT(json["volume_mm3"].get<double>(), ball_mm3);
  EXPECT_LT(json["volume_mm3"].get<double>(),
            1.5 * ball_mm3);  // four views leave corners, not twice the ball
  EXPECT_GT(json["time_ms"].get<double>(), 0.0);
  EXPECT_TRUE(std::filesystem::exists(out));
}

TEST_F(CliOnBallRig, ViewSeesTheBallByEveryMethod) {
  const std::string view = WriteView();
  std::map<std::string, cv::Mat> depth;
  for (const std::string method : {"exact", "sweep", "sweep-gl"}) {
    const std::string tiff = (folder_ / (method + ".tiff")).string(),
                      png = (folder_ / (method + ".png")).string();
    const ProgramRun run = Elbowroom({"view", rig_, "--frame", "0", "--camera", view, "--method", method,
                                      "--depth", tiff, "--image", png, "--json"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["method"], method);
    EXPECT_EQ(json["width"], 200);
    EXPECT_EQ(json["height"], 150);
    EXPECT_GT(json["time_ms"].get<double>(), 0.0);
    EXPECT_GT(json["first_time_ms"].get<double>(), 0.0);
    depth[method] = cv::imread(tiff, cv::IMREAD_UNCHANGED);
    ASSERT_EQ(depth[method].type(), CV_32FC1);
    EXPECT_EQ(json["hit_pixels"], cv::countNonZero(depth[method]));
    EXPECT_EQ(depth[method].at<float>(0, 0), 0.0F);
    const cv::Mat picture = cv::imread(png, cv::IMREAD_COLOR);
    ASSERT_EQ(picture.size(), cv::Size(200, 150));
    EXPECT_NE(picture.at<cv::Vec3b>(75, 100), picture.at<cv::Vec3b>(75, 2));
  }
  const double distance_mm = Eigen::Vector3d(300.0, -350.0, 250.0).norm();
  const float exact_mm = depth["exact"].at<float>(75, 100);
  EXPECT_LT(exact_mm, distance_mm - test_support::kBallRadiusMm + 1.0);  // the hull holds the ball
  EXPECT_GT(exact_mm, distance_mm - 2.0 * test_support::kBallRadiusMm);
  constexpr float kSpacingMm = 15.0F, kPixelMm = 1.5F;
  for (const char* method : {"sweep", "sweep-gl"}) {
    EXPECT_GT(depth[method].at<float>(75, 100), exact_mm - kPixelMm);
    EXPECT_LT(depth[method].at<float>(75, 100), exact_mm + kSpacingMm + kPixelMm);
  }
}

TEST_F(CliOnBallRig, OnlySweepsHaveASpacing) {
  const std::string view = WriteView(), tiff = (folder_ / "depth.tiff").string();
  const std::vector<std::string> common = {"view", rig_, "--frame", "0", "--camera", view, "--depth", tiff};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = common;
    all.insert(all.end(), more.begin(), more.end());
    return Elbowroom(all);
  };
  EXPECT_EQ(with({"--spacing", "5"}).exit_status, 2);
  EXPECT_EQ(with({"--method", "exact", "--spacing", "5"}).exit_status, 2);
  EXPECT_EQ(with({"--method", "sweep", "--spacing", "0"}).exit_status, 2);
  EXPECT_EQ(with({"--method", "sculpt"}).exit_status, 2);
  EXPECT_FALSE(std::filesystem::exists(tiff));
  const ProgramRun run = with({"--method", "sweep", "--spacing", "3", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["spacing_mm"], 3.0);
  EXPECT_GT(json["planes"].get<int>(), 90);
  ExpectOneLine(with({"--method", "sweep", "--spacing", "0.0001"}), {"planes", "choose a wider one"});
}

TEST_F(CliOnBallRig, AViewThatFailsIsOneLineAndLeavesNothing) {
  const std::string view = WriteView();
  const std::filesystem::path out = folder_ / "out";
  std::filesystem::create_directory(out);
  const std::string tiff = (out / "depth.tiff").string(), nowhere = (folder_ / "no" / "where.png").string();
  const auto run = [&](const std::string& frame, const std::string& camera, const std::string& image) {
    return Elbowroom({"view", rig_, "--frame", frame, "--camera", camera, "--method", "sweep", "--depth",
                      tiff, "--image", image});
  };
  ExpectOneLine(run("7", view, (out / "image.png").string()), {"7"});
  ExpectOneLine(run("0", (folder_ / "none.yml").string(), (out / "image.png").string()),
                {"none.yml", "check"});
  WriteText(folder_ / "bad.yml", "%YAML:1.0\n---\nimage_width: 5\n");
  ExpectOneLine(run("0", (folder_ / "bad.yml").string(), (out / "image.png").string()),
                {"bad.yml", "image_height"});
  ExpectOneLine(run("0", view, nowhere), {"where.png", "can't be written"});
  EXPECT_TRUE(std::filesystem::is_empty(out));
}

TEST_F(CliOnBallRig, AViewsFilesAreWhatTheirNamesSay) {
  const std::string view = WriteView();
  const auto run = [&](const std::string& depth, const std::string& image) {
    return Elbowroom({"view", rig_, "--frame", "0", "--camera", view, "--depth", (folder_ / depth).string(),
                      "--image", (folder_ / image).string()});
  };
  ExpectOneLine(run("a.png", "b.png"), {"--depth", "a.png", ".tiff"});
  ExpectOneLine(run("a.tiff", "b.jpg"), {"--image", "b.jpg", ".png"});
  ExpectOneLine(run("a.tiff", "a.tiff"), {"--depth", "--image", "a.tiff", "two names"});
  for (const char* file : {"a.png", "b.png", "a.tiff", "b.jpg"})
    EXPECT_FALSE(std::filesystem::exists(folder_ / file)) << file;
}

TEST_F(CliOnBallRig, AViewFromWithinTheHullSaysSo) {
  const auto run = [&](double z_mm) {
    const std::filesystem::path view = folder_ / "place.yml";
    WriteText(view,
              "%YAML:1.0\n---\nimage_width: 8\nimage_height: 6\n"
              "camera_matrix: [ 8, 0, 3.5, 0, 8, 2.5, 0, 0, 1 ]\ndistortion_model: \"plumb_bob\"\n"
              "distortion_coefficients: [ 0, 0, 0, 0, 0 ]\n"
              "rotation_cam_from_world: [ 1, 0, 0,  0, -1, 0,  0, 0, -1 ]\n"
              "translation_cam_from_world_mm: [ 0, 0, " +
                  std::to_string(z_mm) + " ]\n");
    return Elbowroom(
        {"view", rig_, "--frame", "0", "--camera", view.string(), "--depth", (folder_ / "d.tiff").string()});
  };
  // The ball's middle, where all cameras look, and a place far above.
  const ProgramRun within = run(200.0), above = run(2000.0);
  ASSERT_EQ(within.exit_status, 0) << within.err;
  EXPECT_NE(within.err.find("place.yml"), std::string::npos) << within.err;
  EXPECT_NE(within.err.find("inside the hull"), std::string::npos) << within.err;
  EXPECT_EQ(std::count(within.err.begin(), within.err.end(), '\n'), 1);
  EXPECT_EQ(above.err, "");
}

TEST(CliOnSharedData, ViewSeesTheBunny) {
  const std::filesystem::path bunny = test_support::SharedDataFolder() / "bunny6";
  if (!std::filesystem::exists(bunny))
    GTEST_SKIP() << bunny << " isn't there: no view of the bunny was tested";
  const TemporaryFolder folder;
  // From the first camera of the rig: the hull then fills its mask.
  const auto rig = recon::ReadRigFile(bunny / "rig.yml");
  recon::RigFile view{rig.rig, {{}}};
  view.rig.cameras.resize(1, rig.rig.cameras[0]);
  recon::WriteRigFile(view, folder / "camera.yml");
  std::map<std::string, int> hits;
  for (const std::string method : {"exact", "sweep", "sweep-gl"}) {
    const ProgramRun run = Elbowroom({"view", (bunny / "rig.yml").string(), "--frame", "0", "--camera",
                                      (folder / "camera.yml").string(), "--method", method, "--depth",
                                      (folder / "depth.tiff").string(), "--json"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    hits[method] = nlohmann::json::parse(run.out)["hit_pixels"];
  }
  EXPECT_GT(hits["exact"], 10'000);
  constexpr double kRim = 0.05;  // of the pixels: the hull is thinner there than the planes' spacing
  EXPECT_NEAR(hits["sweep"], hits["exact"], kRim * hits["exact"]);
  EXPECT_NEAR(hits["sweep-gl"], hits["sweep"], 0.002 * hits["sweep"]);
}

TEST_F(CliOnBallRig, OneThreadGivesTheSameMesh) {
  const std::string one = (folder_ / "one.ply").string(), two = (folder_ / "two.ply").string();
  ASSERT_EQ(
      Elbowroom({"hull", rig_, "--frame", "0", "--edge", "5", "--out", one, "--threads", "1"}).exit_status,
      0);
  ASSERT_EQ(
      Elbowroom({"hull", rig_, "--frame", "0", "--edge", "5", "--out", two, "--threads", "2"}).exit_status,
      0);
  EXPECT_EQ(test_support::ReadText(one), test_support::ReadText(two));
}

TEST_F(CliOnBallRig, ContactsTouchWhereTheBallIs) {
  const ProgramRun touching = Elbowroom({"contacts", rig_, "--frame", "0", "--mesh", box_, "--unit", "mm",
                                         "--world-from-part", PoseAt(80, 0, 200), "--json"});
  ASSERT_EQ(touching.exit_status, 0) << touching.err;
  const auto json = nlohmann::json::parse(touching.out);
  EXPECT_EQ(json["verdict"], "contact");
  EXPECT_GT(json["contact_points"].get<int>(), 0);
  EXPECT_GT(json["contact_area_mm2"].get<double>(), 0.0);
  EXPECT_EQ(json["cp_obj_mm"].size(), 3U);
  EXPECT_EQ(json["cp_hull_mm"].size(), 3U);
  EXPECT_EQ(json["v_rec"].size(), 3U);
  EXPECT_GT(json["d_rec_mm"].get<double>(), 0.0);
  EXPECT_EQ(json["n_hull"].size(), 3U);
  EXPECT_EQ(json["triangles"], 12);
  for (const char* key : {"time_ms", "first_time_ms", "queries", "skipped"})
    EXPECT_TRUE(json.contains(key)) << key;
}

TEST_F(CliOnBallRig, ContactsSayWhichWayIsOut) {
  const std::vector<std::string> contacts = {
      "contacts",         rig_,    "--frame", "0", "--mesh", box_, "--unit", "mm", "--world-from-part",
      PoseAt(80, 0, 200), "--json"};
  const auto json_with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = contacts;
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = Elbowroom(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return nlohmann::json::parse(run.out);
  };
  const auto plain = json_with({});
  EXPECT_EQ(plain["status"], plain["recovery_status"]);
  EXPECT_EQ(plain["recovery"]["kind"], "reference");
  EXPECT_TRUE(plain["recovery"]["axis"].is_null());
  const double lower_mm = plain["penetration_mm"][0], upper_mm = plain["penetration_mm"][1];
  EXPECT_GT(lower_mm, 0.0);
  EXPECT_LE(lower_mm, upper_mm);
  EXPECT_EQ(plain["penetration_direction"].size(), 3U);
  EXPECT_LE(lower_mm, plain["recovery"]["part_free_mm"][1].get<double>()) << "one way is no shorter than any";
  for (const char* key : {"cp_obj_mm", "v_rec_deg", "d_rec_mm", "cp_hull_mm", "n_hull_deg"})
    EXPECT_GT(plain["uncertainty"][key].get<double>(), 0.0) << key;

  const auto slider = json_with({"--recovery", "slider", "--axis", "-1,0,0"});
  EXPECT_EQ(slider["recovery"]["sense"], "-") << "away from the ball, along +x";
  EXPECT_NEAR(slider["v_rec"][0].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(slider["recovery"]["part_free_mm"].size(), 2U);
  const auto hinge =
      json_with({"--recovery", "hinge", "--axis", "0,0,1", "--at", "0,300,0", "--reference", "0,0,0"});
  EXPECT_EQ(hinge["recovery"]["kind"], "hinge");
  EXPECT_TRUE(hinge["recovery"]["angle_deg"].is_number());
  EXPECT_TRUE(hinge["recovery"]["part_free_mm"].is_null());
  const auto with_sure_silhouettes = json_with({"--silhouette-error", "0.05"});
  EXPECT_LT(with_sure_silhouettes["uncertainty"]["d_rec_mm"].get<double>(),
            plain["uncertainty"]["d_rec_mm"].get<double>());
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--recovery", "slider"},
                                                {"--axis", "0,0,1"},
                                                {"--recovery", "sideways"},
                                                {"--recovery", "slider", "--axis", "0,1"},
                                                {"--silhouette-error", "-1"}}) {
    std::vector<std::string> words = contacts;
    words.insert(words.end(), wrong.begin(), wrong.end());
    EXPECT_EQ(Elbowroom(words).exit_status, 2) << wrong.front();
  }
}

TEST_F(CliOnBallRig, ContactsAreNullWhereNothingTouches) {
  const ProgramRun apart = Elbowroom({"contacts", rig_, "--frame", "0", "--mesh", box_, "--unit", "mm",
                                      "--world-from-part", PoseAt(600, 0, 200), "--json"});
  ASSERT_EQ(apart.exit_status, 0) << apart.err;
  const auto json = nlohmann::json::parse(apart.out);
  EXPECT_EQ(json["verdict"], "clear");
  EXPECT_EQ(json["contact_points"], 0);
  for (const char* key : {"cp_obj_mm", "cp_hull_mm", "v_rec", "d_rec_mm", "n_hull", "recovery", "uncertainty",
                          "penetration_mm", "penetration_direction"})
    EXPECT_TRUE(json[key].is_null()) << key;
  EXPECT_EQ(json["skipped"], 12);
}

TEST_F(CliOnBallRig, ClearanceLiesBetweenItsBounds) {
  const std::vector<std::string> clearance = {"clearance",
                                              rig_,
                                              "--frame",
                                              "0",
                                              "--mesh",
                                              box_,
                                              "--unit",
                                              "mm",
                                              "--world-from-part",
                                              PoseAt(200, 0, 200),
                                              "--tolerance",
                                              "0.5",
                                              "--required",
                                              "20",
                                              "--json"};
  const ProgramRun apart = Elbowroom(clearance);
  ASSERT_EQ(apart.exit_status, 0) << apart.err;
  const auto json = nlohmann::json::parse(apart.out);
  const double lower_mm = json["lower_mm"], upper_mm = json["upper_mm"];
  EXPECT_GT(lower_mm, 0.0);
  EXPECT_LE(lower_mm, upper_mm);
  EXPECT_LE(upper_mm - lower_mm, 0.5);
  EXPECT_EQ(json["witness_part_mm"].size(), 3U);
  EXPECT_EQ(json["witness_hull_mm"].size(), 3U);
  EXPECT_EQ(json["verdict"], lower_mm >= 20.0 ? "clear" : upper_mm < 20.0 ? "near" : "undecided");
  for (const char* key : {"time_ms", "first_time_ms", "queries"}) EXPECT_TRUE(json.contains(key)) << key;

  const ProgramRun touching = Elbowroom({"clearance", rig_, "--frame", "0", "--mesh", box_, "--unit", "mm",
                                         "--world-from-part", PoseAt(80, 0, 200), "--json"});
  ASSERT_EQ(touching.exit_status, 0) << touching.err;
  EXPECT_EQ(nlohmann::json::parse(touching.out)["upper_mm"], 0.0);
  const ProgramRun refused =
      Elbowroom({"clearance", rig_, "--frame", "0", "--mesh", box_, "--unit", "mm", "--tolerance", "0"});
  EXPECT_EQ(refused.exit_status, 2);
}

TEST_F(CliOnBallRig, MatterInsideAClosedPartIsAContactAndInItsCavityIsNot) {
  const std::string part = (folder_ / "part.stl").string();
  const std::vector<std::string> contacts = {
      "contacts",        rig_,    "--frame", "0", "--mesh", part, "--unit", "mm", "--world-from-part",
      PoseAt(0, 0, 200), "--json"};
  test_support::WriteBoxStl(part, 400.0);
  const auto closed = nlohmann::json::parse(Elbowroom(contacts).out);
  EXPECT_EQ(closed["verdict"], "contact");
  EXPECT_EQ(closed["contact_points"], 0);
  EXPECT_EQ(closed["contained_mm"].size(), 3U);
  EXPECT_TRUE(closed["v_rec"].is_null());
  EXPECT_EQ(closed["status"], "hull inside part");
  EXPECT_GT(closed["penetration_mm"][0].get<double>(), 100.0);
  test_support::WriteHollowBoxStl(part, 400.0, 260.0);
  EXPECT_EQ(nlohmann::json::parse(Elbowroom(contacts).out)["verdict"], "clear");
}

TEST_F(CliOnBallRig, ACameraNameCantLeadOutOfTheFolder) {
  std::string text = test_support::ReadText(rig_);
  text.replace(text.find("cam2"), 4, "../x");
  WriteText(rig_, text);
  ExpectOneLine(Elbowroom({"segment", rig_, "--frame", "0", "--out", (folder_ / "masks").string()}),
                {"../x", "name"});
}

TEST_F(CliOnBallRig, AMisspeltRigKeyIsNamed) {
  const std::string text = test_support::ReadText(rig_);
  WriteText(rig_, text + "unsen: \"abstain\"\n");
  ExpectOneLine(Elbowroom({"segment", rig_, "--frame", "0", "--out", (folder_ / "masks").string()}),
                {"unsen", "unseen"});
}

TEST_F(CliOnBallRig, SegmentWritesTheReadyMasks) {
  const ProgramRun run =
      Elbowroom({"segment", rig_, "--frame", "0", "--out", (folder_ / "masks").string(), "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  ASSERT_EQ(json["masks"].size(), 4U);
  for (const auto& mask : json["masks"]) {
    EXPECT_GT(mask["object_pixels"].get<int>(), 1000);
    EXPECT_TRUE(std::filesystem::exists(mask["file"].get<std::string>()));
  }
}

TEST_F(CliOnBallRig, ImportEchoesUnitAndSize) {
  const ProgramRun run = Elbowroom({"import", box_, "--unit", "in", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  for (const char* key : {"parts", "triangles", "unit", "bounds_mm", "watertight", "repaired",
                          "dropped_triangles", "warnings"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["unit"], "in");
  EXPECT_NEAR(json["bounds_mm"][1][0].get<double>(), 40.0 * 25.4, 1e-3);  // single precision file
  ExpectOneLine(Elbowroom({"import", box_}), {"box.stl", "--unit"});
}

TEST_F(CliOnBallRig, BadInputIsOneLineAndLeavesNothing) {
  const std::string out = (folder_ / "none.ply").string();
  ExpectOneLine(
      Elbowroom({"hull", (folder_ / "no.yml").string(), "--frame", "0", "--edge", "3", "--out", out}),
      {"no.yml"});
  ExpectOneLine(Elbowroom({"hull", rig_, "--frame", "7", "--edge", "3", "--out", out}), {"7"});
  ExpectOneLine(Elbowroom({"hull", rig_, "--frame", "-1", "--edge", "3", "--out", out}), {"-1"});
  EXPECT_EQ(Elbowroom({"hull", rig_, "--frame", "0", "--edge", "0", "--out", out}).exit_status, 2);
  EXPECT_EQ(Elbowroom({"hull", rig_, "--frame", "0", "--edge", "inf", "--out", out}).exit_status, 2);
  ExpectOneLine(Elbowroom({"hull", rig_, "--frame", "0", "--edge", "3", "--out", out + ".xyz"}),
                {".xyz", ".ply"});
  ExpectOneLine(Elbowroom({"hull", rig_, "--frame", "0", "--edge", "3", "--out", "/nowhere/none.ply"}),
                {"/nowhere/none.ply"});
  ExpectOneLine(Elbowroom({"contacts", rig_, "--frame", "0", "--mesh", "missing.stl", "--unit", "mm"}),
                {"missing.stl"});
  ExpectOneLine(Elbowroom({"report", (folder_ / "no.db").string(), "--out", (folder_ / "report").string()}),
                {"no.db"});
  ExpectOneLine(Elbowroom({"report", rig_, "--out", (folder_ / "report").string()}), {"rig.yml"});
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "report" / "report.html"));
}

TEST_F(CliOnBallRig, DamagedMasksAreNamed) {
  const std::filesystem::path mask = folder_.path() / "rig" / "cam2" / "mask_0000.png";
  const std::string whole = test_support::ReadText(mask);
  const std::string out = (folder_ / "none.ply").string();
  const std::vector<std::string> hull = {"hull", rig_, "--frame", "0", "--edge", "3", "--out", out};
  WriteText(mask, whole.substr(0, whole.size() / 2));
  ExpectOneLine(Elbowroom(hull), {"cam2", "mask_0000.png"});
  WriteText(mask, "no picture");
  ExpectOneLine(Elbowroom(hull), {"cam2", "mask_0000.png"});
  std::filesystem::remove(mask);
  ExpectOneLine(Elbowroom(hull), {"cam2"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(CliOnBallRig, TrialRunRecordsAndReports) {
  WriteText(folder_ / "layout.toml",
            "unit = \"mm\"\n[[part]]\nname = \"near\"\nfile = \"box.stl\"\nposition_mm = [80, 0, 200]\n"
            "[[part]]\nname = \"far\"\nfile = \"box.stl\"\nposition_mm = [600, 0, 200]\n");
  WriteText(folder_ / "trial.toml", "rig = \"rig/rig.yml\"\nlayout = \"layout.toml\"\n");
  const std::string trial = (folder_ / "trial.toml").string(), session = (folder_ / "s.db").string();
  const ProgramRun run = Elbowroom({"trial", "run", trial, "--session", session, "--headless", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["frames"], 1);
  EXPECT_EQ(json["parts"][0]["frames_in_contact"], 1);
  EXPECT_EQ(json["parts"][1]["frames_in_contact"], 0);
  EXPECT_NE(json["ended"].get<std::string>().find("shortest source"), std::string::npos);
  // The same session again would overwrite it.
  ExpectOneLine(Elbowroom({"trial", "run", trial, "--session", session, "--headless"}), {"s.db"});
  ExpectOneLine(Elbowroom({"trial", "run", trial, "--session", (folder_ / "t.db").string(), "--headless",
                           "--frames", "0:9"}),
                {"0:9"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "t.db"));
  const ProgramRun report = Elbowroom({"report", session, "--out", (folder_ / "report").string()});
  ASSERT_EQ(report.exit_status, 0) << report.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report" / "report.html"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report" / "contacts.csv"));
}

TEST_F(CliOnBallRig, ATrialWithABadMaskLeavesNoSession) {
  WriteText(folder_ / "layout.toml", "unit = \"mm\"\n[[part]]\nname = \"near\"\nfile = \"box.stl\"\n");
  WriteText(folder_ / "trial.toml", "rig = \"rig/rig.yml\"\nlayout = \"layout.toml\"\n");
  const std::filesystem::path mask = folder_.path() / "rig" / "cam3" / "mask_0000.png";
  WriteText(mask, test_support::ReadText(mask).substr(0, 60));
  ExpectOneLine(Elbowroom({"trial", "run", (folder_ / "trial.toml").string(), "--session",
                           (folder_ / "s.db").string(), "--headless"}),
                {"cam3"});
  for (const char* left : {"s.db", "s.db-wal", "s.db-shm"})
    EXPECT_FALSE(std::filesystem::exists(folder_ / left)) << left;
}

TEST(Cli, TheWindowNeedsADisplay) {
  const ProgramRun run =
      RunProgram(test_support::ProgramFile(), {},
                 {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}, {"QT_QPA_PLATFORM", ""}}});
  ExpectOneLine(run, {"display"});
}

}  // namespace
}  // namespace elbowroom
