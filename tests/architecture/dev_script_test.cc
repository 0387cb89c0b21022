// ./dev on a machine whose package and build tools are scripts that write down how they were called.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::architecture {
namespace {

namespace fs = std::filesystem;
using test_support::ProgramRun;

const fs::path kSourceRoot = test_support::SourceFolder();

class DevScript : public testing::Test {
 protected:
  DevScript() {
    fs::create_directories(folder_ / "tree");
    fs::copy_file(kSourceRoot / "dev", folder_ / "tree/dev");
    for (const std::string name : {"apt-get", "cmake"})
      AddTool(name, "echo " + name + " \"$@\" >> \"$TOOL_LOG\"");
    AddTool("sudo", "exec \"$@\"");
    PretendThatAllIsInstalledBut("nothing");
  }

  void PretendThatAllIsInstalledBut(const std::string& pattern) {
    AddTool("dpkg-query",
            "for name; do case $name in -*|" + pattern + ") ;; *) echo \"$name installed\";; esac; done");
  }

  [[nodiscard]] ProgramRun Dev(const std::vector<std::string>& arguments,
                               std::map<std::string, std::string> environment = {}) const {
    environment["PATH"] = (folder_ / "tools").string() + ":/usr/bin:/bin";
    environment["TOOL_LOG"] = (folder_ / "log").string();
    return test_support::RunProgram(folder_ / "tree/dev", arguments, {.environment = environment});
  }

  // How the tools were called, one call a line.
  [[nodiscard]] std::string Calls() const {
    return fs::exists(folder_ / "log") ? test_support::ReadText(folder_ / "log") : "";
  }

 private:
  void AddTool(const std::string& name, const std::string& script) {
    const fs::path tool = folder_ / "tools" / name;
    test_support::WriteText(tool, "#!/bin/sh\n" + script + "\n");
    fs::permissions(tool, fs::perms::owner_all);
  }

  const test_support::TemporaryFolder folder_;
};

constexpr const char* kBuildCalls = "cmake --preset release\ncmake --build --preset release\n";

TEST_F(DevScript, InstallsNothingWhereNothingIsMissing) {
  const ProgramRun run = Dev({"build"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(Calls(), kBuildCalls);
}

TEST_F(DevScript, InstallsWhatIsMissingByNameAndSaysSo) {
  PretendThatAllIsInstalledBut("libzstd-dev|libegl1");
  const ProgramRun run = Dev({"build"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.err.find("installing Debian packages: libzstd-dev libegl1\n"), std::string::npos) << run.err;
  EXPECT_EQ(Calls(), std::string("apt-get update -qq\n")
                         .append("apt-get install -y -qq --no-install-recommends libzstd-dev libegl1\n")
                         .append(kBuildCalls));
}

TEST_F(DevScript, AReleaseNeedsNoTestPackages) {
  PretendThatAllIsInstalledBut("libgtest-dev");
  EXPECT_EQ(Dev({"build"}).exit_status, 0);
  EXPECT_EQ(Calls(), kBuildCalls);
}

TEST_F(DevScript, CanBeForbiddenToInstall) {
  PretendThatAllIsInstalledBut("libzstd-dev");
  const ProgramRun run = Dev({"build"}, {{"ELBOWROOM_INSTALL", "no"}});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(run.err, "./dev: missing Debian packages: libzstd-dev\n");
  EXPECT_EQ(Calls(), "");
}

TEST_F(DevScript, ExplainsItself) {
  const ProgramRun asked = Dev({"help"}), wrong = Dev({"tset"});
  EXPECT_EQ(asked.exit_status, 0);
  EXPECT_EQ(wrong.exit_status, 2);
  EXPECT_EQ(wrong.err, asked.out);
  for (const std::string command :
       {"demo", "build", "test", "check", "bench", "package", "package-test", "soak"}) {
    EXPECT_NE(asked.out.find("\n  " + command + " "), std::string::npos) << command;
  }
}

}  // namespace
}  // namespace elbowroom::architecture
