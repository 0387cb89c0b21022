// Which page a file that is opened in the window goes to.
#include <gtest/gtest.h>

#include <QLabel>
#include <fstream>

#include "app/console/main_window.h"
#include "tests/app/console/user_actions.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::console {
namespace {

TEST(OpenedFile, ALayoutIsOnTheLayoutPage) {
  const test_support::TemporaryFolder folder;
  MainWindow window;
  window.show();
  const std::filesystem::path layout = folder / "empty_layout.toml";
  std::ofstream(layout) << "unit = \"mm\"\n";
  window.OpenFile(QString::fromStdString(layout.string()));
  EXPECT_EQ(window.pages().page(), Page::kLayout);
  ASSERT_TRUE(WaitUntil([&] { return window.layout_page().desk().document().has_file(); }))
      << window.findChild<QLabel*>("message")->text().toStdString();
}

}  // namespace
}  // namespace elbowroom::console
