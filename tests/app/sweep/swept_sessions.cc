#include "tests/app/sweep/swept_sessions.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/control/demo_parts.h"
#include "app/control/frame_pipeline.h"
#include "recon/synthetic/demo_motion.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "sessions/session_writer.h"
#include "tests/support/places.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {

int RecordTaskFrames(const std::filesystem::path& path, core::FrameIndex first,
                     const std::string& participant) {
  const recon::SyntheticRig source(recon::FourCameraRig(),
                                   [](double time_s) { return recon::DemoSceneAt(time_s).objects; });
  core::SessionHeader header;
  header.rig = source.rig();
  header.layout = control::DemoLayout();
  header.trial.participant = participant;
  header.trial.estimate_mm = 184.0;
  header.trial.required_clearance_mm = 15.0;
  control::FramePipeline pipeline(source.rig(), control::DemoLayout(),
                                  std::vector<recon::BackgroundReference>(4), {});
  sessions::SessionWriter writer(path, header);
  int touched = 0;
  for (core::FrameIndex frame = first; frame < first + 60; frame += 10) {
    recon::FrameSet frames;
    frames.index = frame;
    for (core::BitMask& mask : source.TrueMasks(source.ObjectsAt(frame)))
      frames.cameras.push_back({{}, std::move(mask)});
    const auto result = pipeline.Process(std::move(frames), std::vector{140.0});
    touched += result->record.contacts[1].verdict == core::Verdict::kContact ? 1 : 0;
    if (frame == first + 30)
      writer.Append(core::SessionEvent{frame, result->record.time_s, core::ToolMarked{"tongs", true}});
    writer.Append(result->record);
  }
  writer.Finish({});
  return touched;
}

test_support::ProgramRun RunSweep(const std::vector<std::filesystem::path>& sessions,
                                  const std::string& spacing, const std::filesystem::path& out,
                                  const std::vector<std::string>& more,
                                  const test_support::RunOptions& options) {
  std::vector<std::string> arguments{"sweep"};
  for (const std::filesystem::path& session : sessions) arguments.push_back(session.string());
  arguments.insert(arguments.end(), {"--spacing", spacing, "--out", out.string()});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test_support::RunProgram(test_support::ProgramFile(), arguments, options);
}

void WriteStl(const core::TriangleMesh& mesh, const std::filesystem::path& file) {
  std::string text = "solid part\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t corner : triangle) {
      const Eigen::Vector3d& x = mesh.vertices_mm[static_cast<std::size_t>(corner)];
      text += fmt::format("vertex {} {} {}\n", x.x(), x.y(), x.z());
    }
    text += "endloop\nendfacet\n";
  }
  test_support::WriteText(file, text + "endsolid part\n");
}

std::set<std::string> CellFiles(const std::filesystem::path& out) {
  std::error_code none;
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out / "cells", none))
    if (entry.is_regular_file(none) && !entry.path().has_extension())  // one that is being written has one
      files.insert(entry.path().lexically_relative(out / "cells").string());
  return files;
}

void ExpectSameSweep(const std::filesystem::path& a, const std::filesystem::path& b) {
  for (const char* name : {"sweep.csv", "sweep.svg", "sweep.png"}) {
    const std::string content = test_support::ReadText(a / name);
    EXPECT_FALSE(content.empty()) << a / name;
    EXPECT_TRUE(content == test_support::ReadText(b / name)) << name;
  }
}

}  // namespace elbowroom::tests
