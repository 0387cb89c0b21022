// Changes that another run left unsaved: what this run saves or keeps doesn't take their place.
#include <gtest/gtest.h>

#include <QTest>

#include "app/console/layouts/layout_desk.h"
#include "app/control/layout_editing/autosave.h"
#include "tests/app/layouts/box_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

constexpr int kPatienceMs = 120'000;  // far beyond what any step takes on a loaded machine
constexpr const char* kLayout = "[[part]]\nname = \"box\"\nfile = \"box.glb\"\n";

void Rename(cad_import::LayoutText& text, const std::string& name) { text.Set("part", 0, {"name", name}); }

class KeptChanges : public testing::Test {
 protected:
  KeptChanges() {
    test_support::WriteBox(folder_ / "box.glb", {100.0, 80.0, 60.0});
    test_support::WriteText(file_, kLayout);
    control::LayoutDocument before = control::LayoutDocument::Open(file_);
    before.Apply("Rename", [](cad_import::LayoutText& text) { Rename(text, "offered"); });
    before.Autosave();
  }
  // Reads it, and changes it while the other changes are offered.
  void OpenAndChange(LayoutDesk& desk) {
    desk.Open(file_);
    ASSERT_TRUE(QTest::qWaitFor([&] { return desk.document().has_file(); }, kPatienceMs));
    ASSERT_TRUE(desk.can_recover());
    ASSERT_EQ(desk.Apply("Rename", [](cad_import::LayoutText& text) { Rename(text, "now"); }), "");
  }
  [[nodiscard]] std::string Recovered(LayoutDesk& desk) {
    desk.Recover();
    EXPECT_TRUE(QTest::qWaitFor([&] { return !desk.is_reading(); }, kPatienceMs));
    return desk.document().layout().parts.front().name;
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "layout.toml";
};

TEST_F(KeptChanges, ASaveKeepsWhatIsOffered) {
  LayoutDesk desk(folder_ / "unsaved");
  OpenAndChange(desk);
  EXPECT_TRUE(desk.Save());
  EXPECT_TRUE(desk.can_recover());
  EXPECT_NE(test_support::ReadText(file_).find("now"), std::string::npos);
  EXPECT_EQ(Recovered(desk), "offered");
}

TEST_F(KeptChanges, ASaveUnderAnotherNameKeepsWhatIsOffered) {
  LayoutDesk desk(folder_ / "unsaved");
  OpenAndChange(desk);
  EXPECT_TRUE(desk.SaveAs(folder_ / "other.toml"));
  EXPECT_FALSE(desk.can_recover());  // it is of the other file
  EXPECT_TRUE(control::FindAutosave(file_));
}

// The program is ended from outside while it is offered: both are offered then, one after the other.
TEST_F(KeptChanges, AnEndKeepsWhatIsOfferedAndWhatWasChangedSince) {
  {
    LayoutDesk desk(folder_ / "unsaved");
    OpenAndChange(desk);
    desk.Keep();
    EXPECT_FALSE(desk.is_unsaved());
  }
  {
    LayoutDesk desk(folder_ / "unsaved");
    desk.Open(file_);
    ASSERT_TRUE(QTest::qWaitFor([&] { return desk.document().has_file(); }, kPatienceMs));
    EXPECT_EQ(Recovered(desk), "offered");
    EXPECT_TRUE(desk.Save());
    EXPECT_TRUE(desk.can_recover());
    EXPECT_EQ(Recovered(desk), "now");
    desk.Forget();
  }
  EXPECT_FALSE(control::FindAutosave(file_));
}

TEST_F(KeptChanges, ADiscardedOneIsFollowedByTheNext) {
  LayoutDesk desk(folder_ / "unsaved");
  OpenAndChange(desk);
  desk.Keep();
  desk.DiscardRecovery();
  EXPECT_TRUE(desk.can_recover());
  EXPECT_EQ(control::FindAutosave(file_)->TextsOf("part", 0, "name"), std::vector<std::string>{"now"});
  desk.DiscardRecovery();
  EXPECT_FALSE(desk.can_recover());
  EXPECT_FALSE(control::FindAutosave(file_));
}

}  // namespace
}  // namespace elbowroom::console
