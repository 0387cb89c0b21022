#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include "tests/support/text_file.h"

namespace elbowroom::test_support {
namespace {

TEST(TemporaryFolder, IsGoneWithAllThatIsInIt) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder;
    path = folder.path();
    ASSERT_TRUE(std::filesystem::is_empty(path));
    WriteText(folder / "deep/inside/file.txt", "text\n");
    EXPECT_EQ(ReadText(folder / "deep/inside/file.txt"), "text\n");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(TemporaryFolder, NoTwoAreTheSame) {
  const TemporaryFolder a, b;
  EXPECT_NE(a.path(), b.path());
}

TEST(TextFile, AMissingOneIsAnErrorWithItsName) {
  EXPECT_THROW((void)ReadText("/nowhere/file.txt"), std::ios_base::failure);
}

}  // namespace
}  // namespace elbowroom::test_support
