// What a child that reads a file can do to its parent: nothing.
#include "cad_import/import_process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "cad_import/cad_file.h"
#include "cad_import/packed_model.h"
#include "core/error.h"
#include "tests/cad_import/error_of.h"
#include "tests/cad_import/sample_files.h"
#include "tests/core/solids.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using test_support::WriteText;
using testing::ErrorOf;
using testing::Mentions;

constexpr ImportOptions kInMillimetres{.unit = core::LengthUnit::kMillimetre};

class ImportProcess : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& name, const std::string& bytes) {
    WriteText(folder_ / name, bytes);
    return folder_ / name;
  }
  test_support::TemporaryFolder folder_;
};

// COLLADA whose node holds a node, and so on: the parser and everything after it recurse.
std::string NestedCollada(int depth) {
  std::string open, close;
  for (int i = 0; i < depth; ++i) {
    open += "<node>";
    close += "</node>";
  }
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">)"
         R"(<library_visual_scenes><visual_scene id="s">)" +
         open + close +
         R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

// A mesh of so many triangles, as text that takes a while to read.
std::string LargeObj(int triangles) {
  std::string text = "v 0 0 0\n";
  for (int i = 0; i < triangles; ++i)
    text += "v " + std::to_string(i) + " 1 0\nv " + std::to_string(i) + " 2 5\nf 1 " +
            std::to_string(2 * i + 2) + ' ' + std::to_string(2 * i + 3) + '\n';
  return text;
}

TEST_F(ImportProcess, HandsOverTheModel) {
  const auto file = Write("box.stl", testing::StlBinary(core::testing::Box({10, 20, 30})));
  const PackedModel packed = Unpack(ImportInChild(file, kInMillimetres).bytes(), "test");
  ASSERT_EQ(packed.model.shapes.size(), 1U);
  EXPECT_NEAR(core::VolumeMm3(*packed.model.shapes[0].mesh), 6000.0, 1e-3);
  EXPECT_TRUE(packed.model.report.watertight);
}

TEST_F(ImportProcess, HandsOverWhatTheChildThrew) {
  const auto file = Write("box.stl", testing::StlBinary(core::testing::Box({10, 20, 30})));
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kCad, [&] { (void)ImportInChild(file, {}); }), "carries no unit"));
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kFile, [&] { (void)ImportInChild(folder_ / "none.stl", {}); }),
                       "no such file"));
}

TEST_F(ImportProcess, ACrashIsOneLine) {
  const auto file = Write("deep.dae", NestedCollada(200'000));
  const std::string message = ErrorOf(ErrorKind::kCad, [&] { (void)ImportInChild(file, kInMillimetres); });
#if defined(__SANITIZE_ADDRESS__) || \
    defined(__SANITIZE_THREAD__)  // they end a program that crashes in their own way
  EXPECT_TRUE(Mentions(message, "deep.dae: its reader ended without an answer")) << message;
#else
  EXPECT_TRUE(Mentions(message, "deep.dae: its reader crashed (SEGV)")) << message;
#endif
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // there memory isn't limited
TEST_F(ImportProcess, MemoryBeyondTheLimitIsOneLine) {
  const auto file = Write("large.obj", LargeObj(1'000'000));
  ImportOptions options = kInMillimetres;
  options.limits.memory_bytes = std::int64_t{320}
                                << 20;  // a small file takes half of it, for libraries and stacks
  EXPECT_NO_THROW((void)ImportInChild(Write("small.obj", LargeObj(10)), options));
  const std::string message = ErrorOf(ErrorKind::kCad, [&] { (void)ImportInChild(file, options); });
  EXPECT_TRUE(Mentions(message, "large.obj: reading it takes more than 0.312 GiB of memory")) << message;
}
#endif

TEST_F(ImportProcess, TimeBeyondTheLimitIsOneLine) {
  const auto file = Write("large.obj", LargeObj(1'000'000));
  ImportOptions options = kInMillimetres;
  options.limits.time_s = 0.2;
  const std::string message = ErrorOf(ErrorKind::kCad, [&] { (void)ImportInChild(file, options); });
  EXPECT_TRUE(Mentions(message, "large.obj: reading it takes more than 0.2 s")) << message;
}

TEST_F(ImportProcess, ACancelEndsIt) {
  const auto file = Write("large.obj", LargeObj(1'000'000));
  std::stop_source stop;
  stop.request_stop();
  (void)ErrorOf(ErrorKind::kCancelled,
                [&] { (void)ImportInChild(file, kInMillimetres, {}, stop.get_token()); });
}

TEST_F(ImportProcess, TellsHowFarItIs) {
  const auto file = Write("box.stl", testing::StlBinary(core::testing::Box({10, 20, 30})));
  std::vector<std::string> heard;
  const core::Progress progress(
      [&](std::int64_t /*done*/, std::int64_t /*total*/, const std::string& what) { heard.push_back(what); });
  (void)ImportInChild(file, kInMillimetres, progress);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard.front(), "reading");
}

TEST_F(ImportProcess, SeveralThreadsMayImportAtOnce) {
  const auto file = Write("box.stl", testing::StlBinary(core::testing::Box({10, 20, 30})));
  std::vector<std::string> results(4);
  {
    std::vector<std::jthread> threads;
    for (std::string& result : results)
      threads.emplace_back([&] { result = HashOf(ImportInChild(file, kInMillimetres).bytes()); });
  }
  for (const auto& result : results) EXPECT_EQ(result, results.front());
}

TEST_F(ImportProcess, AFileOutsideTheFolderIsNotOpened) {
  std::filesystem::create_directories(folder_ / "inside");
  auto gltf = testing::Gltf(core::testing::Box({1, 1, 1}), {R"({"mesh":0})"}, {0}, "../secret.bin");
  WriteText(folder_ / "secret.bin", gltf.buffer);
  const std::string up =
      ErrorOf(ErrorKind::kFormat, [&] { (void)ImportInChild(Write("inside/a.gltf", gltf.json), {}); });
  EXPECT_TRUE(Mentions(up, "secret.bin', which is outside its own folder")) << up;
  gltf = testing::Gltf(core::testing::Box({1, 1, 1}), {R"({"mesh":0})"}, {0}, "link.bin");
  std::filesystem::create_symlink(folder_ / "secret.bin", folder_ / "inside/link.bin");
  const std::string link =
      ErrorOf(ErrorKind::kFormat, [&] { (void)ImportInChild(Write("inside/b.gltf", gltf.json), {}); });
  EXPECT_TRUE(Mentions(link, "which is outside its own folder")) << link;
}

}  // namespace
}  // namespace elbowroom::cad_import
