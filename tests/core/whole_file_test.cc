#include "core/system/whole_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.h"
#include "core/size_text.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::core {
namespace {

namespace fs = std::filesystem;
using test_support::ReadText;
using test_support::WriteText;

std::ptrdiff_t CountFiles(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(WriteWholeFile, ALinkStaysAndWhatItPointsToIsReplaced) {
  const test_support::TemporaryFolder folder;
  fs::create_directory(folder / "there");
  WriteText(folder / "there/real.txt", "before");
  fs::create_symlink("there/real.txt", folder / "link.txt");
  WriteWholeFile(folder / "link.txt", "after");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(ReadText(folder / "there/real.txt"), "after");
  EXPECT_EQ(CountFiles(folder / "there"), 1);
}

TEST(WriteWholeFile, PermissionsStay) {
  const test_support::TemporaryFolder folder;
  WriteText(folder / "a.txt", "before");
  fs::permissions(folder / "a.txt", fs::perms::owner_read | fs::perms::owner_write);
  WriteWholeFile(folder / "a.txt", "after");
  EXPECT_EQ(fs::status(folder / "a.txt").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(WriteWholeFile, AProtectedFileStaysWhatItIs) {
  if (geteuid() == 0) GTEST_SKIP() << "NOT TESTED: nothing is protected from root";
  const test_support::TemporaryFolder folder;
  WriteText(folder / "a.txt", "before");
  fs::permissions(folder / "a.txt", fs::perms::owner_read);
  EXPECT_THROW(WriteWholeFile(folder / "a.txt", "after"), Error);
  EXPECT_EQ(ReadText(folder / "a.txt"), "before");
}

TEST(WriteWholeFile, AFolderIsNoFile) {
  const test_support::TemporaryFolder folder;
  EXPECT_THROW(WriteWholeFile(folder.path(), "text"), Error);
  EXPECT_EQ(CountFiles(folder.path()), 0);
}

TEST(SizeText, HasFourDigitsAndNoExponent) {
  EXPECT_EQ(SizeText({203.2, 0.25, 12904.4}), "203.2 x 0.25 x 12904");
  EXPECT_EQ(SizeText({20000.0, 999.96, 1e6}), "20000 x 1000 x 1000000");
}

}  // namespace
}  // namespace elbowroom::core
