#include "core/system/configuration_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "core/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::core {
namespace {

namespace fs = std::filesystem;

class Configuration : public testing::Test {
 protected:
  // What reading it says.
  static std::string ErrorOf(const fs::path& path) {
    try {
      (void)ReadConfiguration(path, path.filename().string(), "trial file");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kFile);
      return error.what();
    }
    ADD_FAILURE() << "no error for " << path;
    return "";
  }
  test_support::TemporaryFolder folder_;
};

TEST_F(Configuration, IsReadWholeAndThroughALink) {
  const std::string text("a = 1\r\n\0b", 9);
  test_support::WriteText(folder_ / "t.toml", text);
  fs::create_symlink("t.toml", folder_ / "link.toml");
  EXPECT_EQ(ReadConfiguration(folder_ / "link.toml", "it", "trial file"), text);
  test_support::WriteText(folder_ / "empty.toml", "");
  EXPECT_EQ(ReadConfiguration(folder_ / "empty.toml", "it", "trial file"), "");
}

TEST_F(Configuration, WhatIsNoFileIsRefusedWithoutWaitingForIt) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.toml").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_ / "zero.toml");
  fs::create_symlink("loop.toml", folder_ / "loop.toml");
  EXPECT_EQ(ErrorOf(folder_ / "pipe.toml"), "pipe.toml: isn't a file; name a trial file");
  EXPECT_EQ(ErrorOf(folder_ / "zero.toml"), "zero.toml: isn't a file; name a trial file");
  EXPECT_NE(ErrorOf(folder_.path()).find("isn't a file"), std::string::npos);
  EXPECT_EQ(ErrorOf(folder_ / "none.toml"), "none.toml: no such trial file; check the path");
  EXPECT_EQ(ErrorOf(folder_ / "none" / "t.toml"), "t.toml: no such trial file; check the path");
  EXPECT_NE(ErrorOf(folder_ / "loop.toml").find("can't be read ("), std::string::npos);
  EXPECT_NE(ErrorOf(folder_ / std::string(5000, 'n')).find("can't be read ("), std::string::npos);
}

TEST_F(Configuration, AnEndlessFileIsRefusedByItsSize) {
  test_support::WriteText(folder_ / "sparse.toml", "rig = 'rig.yml'\n");
  fs::resize_file(folder_ / "sparse.toml", std::uintmax_t{10} << 30U);
  EXPECT_NE(ErrorOf(folder_ / "sparse.toml").find("is larger than 4 MiB"), std::string::npos);
  test_support::WriteText(folder_ / "largest.toml", std::string(kLargestConfigurationBytes, '#'));
  EXPECT_EQ(ReadConfiguration(folder_ / "largest.toml", "it", "trial file").size(),
            kLargestConfigurationBytes);
}

}  // namespace
}  // namespace elbowroom::core
