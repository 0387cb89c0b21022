// The keep-out volume as a user makes it, of recorded frames of the demo.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "app/control/demo_parts.h"
#include "cad_import/mesh_file.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/oracles/mesh_sides.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using Eigen::Vector3d;
using test_support::ProgramRun;

constexpr double kFramesPerSecond = 5.0;

struct Recording {
  core::FrameIndex first = 0, end = 80;
  core::FrameIndex step = 4;
  bool shows_nothing = false;
  std::vector<core::FrameIndex> lacking{};  // frames without the first camera's picture
};

// The demo's motion from exact masks; the tongs are in use from frame 20 to 39.
void Record(const std::filesystem::path& path, const Recording& recording = {}) {
  const recon::SyntheticRig source(recon::FourCameraRig(),
                                   [](double time_s) { return recon::DemoSceneAt(time_s).objects; });
  core::SessionHeader header;
  header.rig = source.rig();
  header.layout = control::DemoLayout();
  header.trial.tools = {"tongs", "driver"};
  sessions::SessionWriter writer(path, header);
  for (core::FrameIndex frame = recording.first; frame < recording.end; ++frame) {
    if (frame == 20 || frame == 40)
      writer.Append(core::SessionEvent{frame, static_cast<double>(frame) / kFramesPerSecond,
                                       core::ToolMarked{"tongs", frame == 20}});
    core::FrameRecord record;
    record.frame = frame;
    record.time_s = static_cast<double>(frame) / kFramesPerSecond;
    std::vector<recon::SyntheticObject> objects;
    if (!recording.shows_nothing) objects = source.ObjectsAt(recording.step * frame);
    auto masks = std::make_shared<std::vector<core::SoftMask>>();
    for (core::BitMask& mask : source.TrueMasks(objects)) masks->push_back({std::move(mask), {}});
    const bool lacks = std::ranges::find(recording.lacking, frame) != recording.lacking.end();
    if (!recording.lacking.empty())
      for (std::size_t camera = 0; camera < masks->size(); ++camera)
        record.stamps.push_back(
            lacks && camera == 0
                ? std::nullopt
                : std::optional(core::CameraStamp{static_cast<std::uint64_t>(frame), record.time_s}));
    record.masks = masks;
    record.spacing_mm = {140.0};
    record.contacts.resize(header.layout.parts.size());
    for (core::PartIndex part = 0; part < record.contacts.size(); ++part) record.contacts[part].part = part;
    writer.Append(record);
  }
  writer.Finish({});
}

std::vector<std::shared_ptr<const recon::VisualHull>> HullsOf(const std::filesystem::path& session) {
  const sessions::SessionReader reader(session);
  const auto rig = std::make_shared<const core::Rig>(reader.header().rig);
  std::vector<std::shared_ptr<const recon::VisualHull>> hulls;
  for (const auto& frame : reader.frames()) {
    std::vector<core::BitMask> masks;
    const core::FrameRecord record = reader.ReadFrame(frame.frame);
    for (const core::SoftMask& mask : *record.masks) masks.push_back(mask.mask);
    hulls.push_back(std::make_shared<const recon::VisualHull>(recon::MakeVisualHull(rig, masks)));
  }
  return hulls;
}

core::TriangleMesh Read(const std::filesystem::path& file) {
  return *cad_import::ImportMeshFile(file, {.unit_if_file_has_none = core::LengthUnit::kMillimetre}).mesh;
}

class KeepoutCommand : public testing::Test {
 protected:
  [[nodiscard]] ProgramRun Keepout(const std::vector<std::string>& sessions, const std::string& out,
                                   const std::vector<std::string>& more = {},
                                   const test_support::RunOptions& options = {}) const {
    std::vector<std::string> arguments{"keepout"};
    for (const std::string& session : sessions) arguments.push_back((folder_ / session).string());
    arguments.insert(arguments.end(), {"--out", (folder_ / out).string(), "--json"});
    if (std::ranges::find(more, "--edge") == more.end()) arguments.insert(arguments.end(), {"--edge", "8"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test_support::RunProgram(test_support::ProgramFile(), arguments, options);
  }
  nlohmann::json JsonOf(const ProgramRun& run) const {
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
  }
  void ExpectRefused(const ProgramRun& run, const std::string& word, int exit_status = 1) const {
    EXPECT_EQ(run.exit_status, exit_status) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  }
  [[nodiscard]] bool HasFile(const std::string& name) const {
    return std::filesystem::exists(folder_ / name);
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(KeepoutCommand, HoldsEveryRecordedHull) {
  Record(folder_ / "s.db");
  const auto json = JsonOf(Keepout({"s.db"}, "k.ply"));
  EXPECT_EQ(json["frames"], 80);
  EXPECT_TRUE(json["watertight"]);
  EXPECT_NEAR(json["seconds"].get<double>(), 80.0 / kFramesPerSecond, 1e-9);
  const core::TriangleMesh mesh = Read(folder_ / "k.ply");
  EXPECT_EQ(mesh.triangles.size(), json["triangles"]);
  EXPECT_TRUE(core::IsWatertight(mesh)) << "as a second reader has it";
  EXPECT_NEAR(core::VolumeMm3(mesh), json["volume_mm3"], 1e-5 * json["volume_mm3"].get<double>());
  const oracles::MeshSides sides(mesh);
  const auto hulls = HullsOf(folder_ / "s.db");
  recon::Random random(2411);
  int points = 0, missed = 0;
  std::size_t at = 0;
  while (points < 100'000) {
    const recon::VisualHull& hull = *hulls[at++ % hulls.size()];
    if (hull.IsEmpty()) continue;
    for (int k = 0; k < 500; ++k) {
      const Vector3d point = random.PointIn(hull.rig().workspace_mm);
      if (!hull.Contains(point)) continue;
      // On to the hull's surface, where it is the hardest.
      Vector3d inside = point, outside = random.PointIn(hull.rig().workspace_mm);
      for (int step = 0; step < 20; ++step) {
        const Vector3d middle = 0.5 * (inside + outside);
        (hull.Contains(middle) ? inside : outside) = middle;
      }
      missed += sides.Holds(point) ? 0 : 1;
      missed += sides.Holds(inside) ? 0 : 1;
      points += 2;
    }
  }
  EXPECT_EQ(missed, 0);
}

TEST_F(KeepoutCommand, AllFormatsHoldTheSameMeshAndSayHowFarItMayBeOff) {
  Record(folder_ / "s.db", {.end = 20});
  const auto json = JsonOf(Keepout({"s.db"}, "k.ply"));
  JsonOf(Keepout({"s.db"}, "k.stl"));
  JsonOf(Keepout({"s.db"}, "k.glb"));
  for (const char* name : {"k.ply", "k.stl", "k.glb"}) {
    const core::TriangleMesh mesh = Read(folder_ / name);
    EXPECT_TRUE(core::IsWatertight(mesh)) << name;
    EXPECT_EQ(mesh.triangles.size(), json["triangles"]) << name;
    const std::string text = test_support::ReadText(folder_ / name);
    EXPECT_NE(text.find("contains every hull"), std::string::npos) << name;
  }
  EXPECT_NE(test_support::ReadText(folder_ / "k.ply").find("property float dwell_s\n"), std::string::npos);
  const std::string glb = test_support::ReadText(folder_ / "k.glb");
  EXPECT_NE(glb.find("\"_DWELL_S\":2"), std::string::npos);
  EXPECT_NE(glb.find("\"COLOR_0\":1"), std::string::npos);
  EXPECT_GT(json["dwell_s"]["max"], json["dwell_s"]["median"]);
  EXPECT_LE(json["dwell_s"]["max"], json["seconds"]);
  EXPECT_GT(json["bound_mm"], 0.0);
}

TEST_F(KeepoutCommand, AToolHasItsSpansAndARangeItsFrames) {
  Record(folder_ / "s.db");
  const auto all = JsonOf(Keepout({"s.db"}, "all.ply"));
  const auto tongs = JsonOf(Keepout({"s.db"}, "tongs.ply", {"--tool", "tongs"}));
  const auto range = JsonOf(Keepout({"s.db"}, "range.ply", {"--frames", "20:40"}));
  EXPECT_EQ(tongs["frames"], 20);
  EXPECT_LT(tongs["volume_mm3"], all["volume_mm3"]);
  EXPECT_TRUE(Read(folder_ / "tongs.ply") == Read(folder_ / "range.ply"));
  EXPECT_EQ(JsonOf(Keepout({"s.db"}, "end.ply", {"--frames", "75:"}))["frames"], 5);
  ExpectRefused(Keepout({"s.db"}, "no.ply", {"--tool", "tong"}), "did you mean 'tongs'");
  ExpectRefused(Keepout({"s.db"}, "no.ply", {"--tool", "driver"}), "'driver' was in use in no frame");
  ExpectRefused(Keepout({"s.db"}, "no.ply", {"--frames", "80:90"}), "there are 0:80");
  ExpectRefused(Keepout({"s.db"}, "no.ply", {"--frames", "9:3"}), "A:B", 2);
  EXPECT_FALSE(HasFile("no.ply"));
}

TEST_F(KeepoutCommand, SeveralSessionsAreOneVolume) {
  Record(folder_ / "a.db", {.end = 40});
  Record(folder_ / "b.db", {.first = 40});
  Record(folder_ / "whole.db");
  const auto both = JsonOf(Keepout({"a.db", "b.db"}, "both.ply"));
  JsonOf(Keepout({"whole.db"}, "whole.ply"));
  EXPECT_EQ(both["sessions"], 2);
  EXPECT_EQ(both["frames"], 80);
  EXPECT_TRUE(Read(folder_ / "both.ply") == Read(folder_ / "whole.ply"));
}

TEST_F(KeepoutCommand, FramesThatLackACameraAreLeftOutAndCounted) {
  Record(folder_ / "s.db", {.end = 30, .lacking = {3, 4, 29}});
  const ProgramRun run = Keepout({"s.db"}, "k.ply");
  const auto json = JsonOf(run);
  EXPECT_EQ(json["frames"], 27);
  EXPECT_EQ(json["frames_without_camera"], 3);
  EXPECT_NE(run.err.find("3 frames are left out"), std::string::npos) << run.err;
}

TEST_F(KeepoutCommand, SaysWhatIsWrongInOneLineAndLeavesNoFile) {
  Record(folder_ / "empty.db", {.end = 5, .shows_nothing = true});
  ExpectRefused(Keepout({"empty.db"}, "k.ply"), "nothing real");
  ExpectRefused(Keepout({"empty.db"}, "k.obj"), ".stl or .ply or .glb");
  ExpectRefused(Keepout({"missing.db"}, "k.ply"), "missing.db");
  ExpectRefused(Keepout({"empty.db"}, "k.ply", {"--edge", "0"}), "--edge", 2);
  ExpectRefused(Keepout({"empty.db"}, "k.ply", {"--edge", "0.00001"}), "choose --edge");
  Record(folder_ / "none.db", {.end = 0});
  ExpectRefused(Keepout({"none.db"}, "k.ply"), "no frame was recorded");
  EXPECT_FALSE(HasFile("k.ply"));
}

TEST_F(KeepoutCommand, AnInterruptLeavesNoFile) {
  Record(folder_ / "s.db");
  // Takes far longer than the second after which it is interrupted.
  const ProgramRun run = Keepout({"s.db"}, "k.ply", {"--edge", "0.7"}, {.while_running = [](int process) {
                                   std::this_thread::sleep_for(std::chrono::seconds(1));
                                   kill(process, SIGINT);
                                 }});
  EXPECT_NE(run.exit_status, 0);
  EXPECT_FALSE(HasFile("k.ply"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1) << "the session alone";
}

TEST_F(KeepoutCommand, OneThreadWritesWhatTwoWrite) {
  Record(folder_ / "s.db", {.end = 40});
  JsonOf(Keepout({"s.db"}, "one.ply", {"--threads", "1"}));
  JsonOf(Keepout({"s.db"}, "two.ply", {"--threads", "2"}));
  EXPECT_EQ(test_support::ReadText(folder_ / "one.ply"), test_support::ReadText(folder_ / "two.ply"));
}

}  // namespace
}  // namespace elbowroom
