// The program as `cmake --install` puts it into a folder of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QMimeDatabase>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "tests/app/mask_rig.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramRun;
using test_support::RunProgram;

const fs::path kExample = test_support::SourceFolder() / "docs/examples/first_rig";

class Installed : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test_support::TemporaryFolder>();
    const ProgramRun run =
        RunProgram(ELBOWROOM_CMAKE, {"--install", ELBOWROOM_BINARY_DIR, "--prefix", Prefix().string()});
    ASSERT_EQ(run.exit_status, 0) << run.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path Prefix() { return *folder_ / "installed"; }
  static fs::path Elsewhere() { return folder_->path(); }

  // Found by its name, as a shell finds it.
  static ProgramRun Run(const std::string& arguments, const std::map<std::string, std::string>& more = {}) {
    std::map<std::string, std::string> environment = more;
    environment["PATH"] = (Prefix() / "bin").string() + ":/usr/bin:/bin";
    return RunProgram("/bin/sh", {"-c", "exec elbowroom " + arguments},
                      {.working_folder = Elsewhere(), .environment = environment});
  }

 private:
  static std::unique_ptr<test_support::TemporaryFolder> folder_;
};

std::unique_ptr<test_support::TemporaryFolder> Installed::folder_;

TEST_F(Installed, PlaysTheDemoFromAnotherFolder) {
  const ProgramRun run = Run("demo --headless --out demo");
  EXPECT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  for (const std::string file : {"session.db", "report.html", "report.pdf", "view.png"})
    EXPECT_GT(fs::file_size(Elsewhere() / "demo" / file), 0U);
}

TEST_F(Installed, FindsItsModulesAndPrograms) {
  const ProgramRun import =
      Run("import '" + (kExample / "bracket.stl").string() + "' --unit mm", {{"ELBOWROOM_CACHE", "off"}});
  EXPECT_EQ(import.exit_status, 0) << import.err;
  const fs::path rig = test_support::WriteBallRig(Elsewhere() / "rig");
  const ProgramRun segment = Run("segment '" + rig.string() + "' --frame 0 --out masks");
  EXPECT_EQ(segment.exit_status, 0) << segment.err;
  // The window's program is there, and finds no display.
  const ProgramRun window = Run("open", {{"QT_QPA_PLATFORM", ""}, {"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}});
  EXPECT_EQ(window.exit_status, 1);
  EXPECT_THAT(window.err, testing::HasSubstr("no display"));
}

TEST_F(Installed, HasEveryPartThatTheBuildMade) {
  for (const fs::directory_entry& entry : fs::directory_iterator(ELBOWROOM_BINARY_DIR)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("libelbowroom_") && !name.starts_with("elbowroom_") && name != "elbowroom")
      continue;
    if (entry.is_directory()) continue;
    EXPECT_TRUE(fs::exists(Prefix() / "libexec/elbowroom" / name)) << name;
  }
}

TEST_F(Installed, HasADesktopEntryThatIsValid) {
  const fs::path entry = Prefix() / "share/applications/elbowroom.desktop";
  const ProgramRun run = RunProgram("/usr/bin/desktop-file-validate", {entry.string()});
  EXPECT_EQ(run.exit_status, 0) << run.out;
  EXPECT_EQ(run.out, "");
  for (const std::string icon :
       {"scalable/apps/elbowroom.svg", "16x16/apps/elbowroom.png", "256x256/apps/elbowroom.png"})
    EXPECT_TRUE(fs::exists(Prefix() / "share/icons/hicolor" / icon)) << icon;
}

// Qt's database of file types, made of the installed file and the system's, as where both are installed below
// /usr.
class FileTypes : public Installed {
 protected:
  void SetUp() override {
    const fs::path share = Prefix() / "share";
    fs::copy_file("/usr/share/mime/packages/freedesktop.org.xml", share / "mime/packages/freedesktop.org.xml",
                  fs::copy_options::overwrite_existing);
    const ProgramRun run = RunProgram("/usr/bin/update-mime-database", {(share / "mime").string()},
                                      {.environment = {{"PKGSYSTEM_ENABLE_FSYNC", "0"}}});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    qputenv("XDG_DATA_HOME", (Elsewhere() / "home").c_str());
    qputenv("XDG_DATA_DIRS", share.c_str());
  }

  static std::string TypeOf(const fs::path& file) {
    return QMimeDatabase().mimeTypeForFile(QString::fromStdString(file.string())).name().toStdString();
  }
  // The type of a copy under another name.
  static std::string TypeAs(const std::string& name, const fs::path& file) {
    fs::copy_file(file, Elsewhere() / name, fs::copy_options::overwrite_existing);
    return TypeOf(Elsewhere() / name);
  }
};

TEST_F(FileTypes, AreToldByWhatIsInTheFiles) {
  EXPECT_EQ(TypeAs("P01.toml", kExample / "trial.toml"), "application/x-elbowroom-trial");
  EXPECT_EQ(TypeAs("bench.toml", kExample / "layout.toml"), "application/x-elbowroom-layout");
  EXPECT_EQ(TypeAs("bench.yml", test_support::WriteBallRig(Elsewhere() / "rig")),
            "application/x-elbowroom-rig");
  if (!fs::exists(Elsewhere() / "demo/session.db")) {
    ASSERT_EQ(Run("demo --headless --out demo").exit_status, 0);
  }
  EXPECT_EQ(TypeAs("P01.db", Elsewhere() / "demo/session.db"), "application/x-elbowroom-session");
}

TEST_F(FileTypes, LeaveFilesOfOthersAlone) {
  EXPECT_EQ(TypeAs("CALIB.toml", kExample / "CALIB.toml"), "application/toml");
  EXPECT_EQ(TypeOf(test_support::SourceFolder() / "docs/layout.md"), "text/markdown");
  test_support::WriteText(Elsewhere() / "other.yml", "%YAML:1.0\ncameras: [ a, b ]\n");
  EXPECT_EQ(TypeOf(Elsewhere() / "other.yml"), "application/x-yaml");
  ASSERT_EQ(
      RunProgram("/usr/bin/sqlite3", {(Elsewhere() / "other.db").string(), "CREATE TABLE a (b)"}).exit_status,
      0);
  EXPECT_EQ(TypeOf(Elsewhere() / "other.db"), "application/vnd.sqlite3");
}

}  // namespace
}  // namespace elbowroom
