// A layout that is edited: nothing is lost, and every step can be taken back.
#include "app/control/layout_editing/layout_document.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "app/control/layout_editing/autosave.h"
#include "app/control/layout_editing/folder_lock.h"
#include "app/control/layout_editing/layout_edit.h"
#include "cad_import/layout/layout_file.h"
#include "core/error.h"
#include "tests/app/layouts/box_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;
using test_support::ReadText;
using test_support::WriteBox;
using test_support::WriteText;

constexpr const char* kWritten = R"(# The bench, as measured on Monday.
[[part]]
name = "box"
file = "cad/box.glb"

# Guessed.
[[part]]
name = "lid"
file = "cad/lid.glb"
position_mm = [0.0, 0.0, 240]  # above
)";

class LayoutDocumentTest : public ::testing::Test {
 protected:
  LayoutDocumentTest() : file_(folder_ / "layout.toml") {
    WriteBox(folder_ / "cad/box.glb", {100.0, 80.0, 60.0});
    WriteBox(folder_ / "cad/lid.glb", {100.0, 80.0, 10.0});
    WriteText(file_, kWritten);
  }
  static void Move(LayoutDocument& document, const std::string& part, double z_mm,
                   const std::string& key = {}) {
    document.Apply(
        "Move " + part,
        [&](cad_import::LayoutText& text) {
          PartEdit edit;
          edit.name = part;
          edit.position_mm = Vector3d(0.0, 0.0, z_mm);
          MovePart(text, edit);
        },
        key);
  }
  static double HeightOf(const LayoutDocument& document, const std::string& part) {
    const core::Layout& layout = document.layout();
    return layout.parts[layout.FindPart(part).value()].world_from_part.translation_mm.z();
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path file_;
};

TEST_F(LayoutDocumentTest, ChangesAreSavedInPlaceWithComments) {
  LayoutDocument document = LayoutDocument::Open(file_);
  EXPECT_FALSE(document.is_changed());
  Move(document, "lid", 300.0);
  EXPECT_TRUE(document.is_changed());
  EXPECT_EQ(ReadText(file_), kWritten);
  document.Save();
  EXPECT_FALSE(document.is_changed());
  std::string expected = kWritten;
  expected.replace(expected.find("240"), 3, "300");
  EXPECT_EQ(ReadText(file_), expected);
  EXPECT_DOUBLE_EQ(HeightOf(LayoutDocument::Open(file_), "lid"), 300.0);
}

TEST_F(LayoutDocumentTest, EveryChangeHasANameAndCanBeTakenBack) {
  LayoutDocument document = LayoutDocument::Open(file_);
  EXPECT_FALSE(document.CanUndo());
  Move(document, "lid", 300.0);
  document.Apply("Remove box", [](cad_import::LayoutText& text) { RemoveWithUsers(text, "box"); });
  EXPECT_EQ(document.UndoName(), "Remove box");
  document.Undo();
  EXPECT_EQ(document.UndoName(), "Move lid");
  EXPECT_EQ(document.RedoName(), "Remove box");
  document.Undo();
  EXPECT_EQ(document.text().text(), kWritten);
  EXPECT_FALSE(document.is_changed());
  document.Redo();
  document.Redo();
  EXPECT_EQ(document.layout().parts.size(), 1U);
  EXPECT_FALSE(document.CanRedo());
}

TEST_F(LayoutDocumentTest, ChangesWithOneKeyAreOneStepBack) {
  LayoutDocument document = LayoutDocument::Open(file_);
  for (const double z_mm : {250.0, 260.0, 270.0}) Move(document, "lid", z_mm, "position lid");
  Move(document, "box", 5.0, "position box");
  document.Undo();
  EXPECT_DOUBLE_EQ(HeightOf(document, "lid"), 270.0);
  document.Undo();
  EXPECT_DOUBLE_EQ(HeightOf(document, "lid"), 240.0);
  EXPECT_FALSE(document.CanUndo());
}

TEST_F(LayoutDocumentTest, ASaveOrAnUndoEndsTheStep) {
  LayoutDocument document = LayoutDocument::Open(file_);
  Move(document, "lid", 250.0, "position lid");
  document.Save();
  Move(document, "lid", 260.0, "position lid");
  document.Undo();
  EXPECT_DOUBLE_EQ(HeightOf(document, "lid"), 250.0);
}

TEST_F(LayoutDocumentTest, ARefusedChangeChangesNothing) {
  LayoutDocument document = LayoutDocument::Open(file_);
  const core::Spacing circle{"gap", "lid", "lid", core::Axis::kZ, 0.0, 100.0, 10.0};
  const auto put = [&](cad_import::LayoutText& text) {
    PutSpacing(text, {"gap", circle.moving, circle.reference, "z", 0.0, 100.0, 10.0});
  };
  EXPECT_THROW(document.Apply("Add gap", put), core::Error);
  EXPECT_THROW(Move(document, "nothing", 1.0), core::Error);
  EXPECT_EQ(document.text().text(), kWritten);
  EXPECT_FALSE(document.CanUndo());
}

TEST_F(LayoutDocumentTest, MeshesStayTheSameObjectsWhileThingsMove) {
  LayoutDocument document = LayoutDocument::Open(file_);
  const core::SharedMesh mesh = document.layout().parts[1].mesh;
  std::filesystem::remove_all(folder_ / "cad");  // nothing is read again
  Move(document, "lid", 300.0);
  EXPECT_EQ(document.layout().parts[1].mesh, mesh);
  document.Undo();
  EXPECT_EQ(document.layout().parts[1].mesh, mesh);
}

TEST_F(LayoutDocumentTest, FromNothingByTakingParts) {
  LayoutDocument document(folder_.path());
  EXPECT_FALSE(document.has_file());
  EXPECT_FALSE(document.is_changed());
  const PartPreview box = PreviewPart(folder_ / "cad/box.glb");
  EXPECT_EQ(document.AddParts(box, {""}), std::vector<std::string>{"box"});
  EXPECT_EQ(document.AddParts(box, {""}), std::vector<std::string>{"box_2"});
  EXPECT_EQ(document.UndoName(), "Add box_2");
  document.SaveAs(folder_ / "made.toml");
  EXPECT_TRUE(document.has_file());
  EXPECT_EQ(LayoutDocument::Open(folder_ / "made.toml").layout().parts.size(), 2U);
}

TEST_F(LayoutDocumentTest, SavedElsewhereThePartsFilesAreStillFound) {
  LayoutDocument document = LayoutDocument::Open(file_);
  Move(document, "lid", 300.0);
  std::filesystem::create_directories(folder_ / "other/deep");
  document.SaveAs(folder_ / "other/deep/copy.toml");
  EXPECT_EQ(ReadText(file_), kWritten);  // the old file stays what it was
  const std::string text = ReadText(folder_ / "other/deep/copy.toml");
  EXPECT_NE(text.find(R"(file = "../../cad/box.glb")"), std::string::npos) << text;
  EXPECT_NE(text.find("# Guessed."), std::string::npos);
  const cad_import::ImportedLayout read = cad_import::ImportLayoutFile(folder_ / "other/deep/copy.toml");
  EXPECT_EQ(read.layout.parts.size(), 2U);
  document.Undo();  // into a state of before: its files are found from here, too
  document.Save();
  EXPECT_DOUBLE_EQ(HeightOf(LayoutDocument::Open(folder_ / "other/deep/copy.toml"), "lid"), 240.0);
}

TEST_F(LayoutDocumentTest, DoesNotWriteOverWhatAnotherProgramWrote) {
  LayoutDocument document = LayoutDocument::Open(file_);
  Move(document, "lid", 300.0);
  const std::string others = std::string(kWritten) + "# mine\n";
  WriteText(file_, others);
  EXPECT_THROW(document.Save(), core::Error);
  EXPECT_EQ(ReadText(file_), others);
  EXPECT_TRUE(document.is_changed());
}

TEST_F(LayoutDocumentTest, DoesNotWaitForAProgramThatChangesTheFolder) {
  LayoutDocument document = LayoutDocument::Open(file_);
  Move(document, "lid", 300.0);
  const FolderLock lock(file_);
  EXPECT_THROW(document.Save(), core::Error);
  EXPECT_EQ(ReadText(file_), kWritten);
}

TEST_F(LayoutDocumentTest, WhatWasNotSavedIsRecovered) {
  {
    LayoutDocument document = LayoutDocument::Open(file_);
    Move(document, "lid", 300.0);
    document.Autosave();
  }  // the program ends
  EXPECT_EQ(ReadText(file_), kWritten);
  ASSERT_TRUE(FindAutosave(file_));
  LayoutDocument document = LayoutDocument::Recover(file_);
  EXPECT_TRUE(document.is_changed());
  EXPECT_DOUBLE_EQ(HeightOf(document, "lid"), 300.0);
  document.Save();
  EXPECT_FALSE(std::filesystem::exists(AutosaveOf(file_)));
  EXPECT_THROW((void)LayoutDocument::Recover(file_), core::Error);
}

TEST_F(LayoutDocumentTest, ALayoutThatWasNeverSavedIsRecovered) {
  {
    LayoutDocument document(folder_.path());
    document.AddParts(PreviewPart(folder_ / "cad/box.glb"), {""});
    document.Autosave();
  }
  LayoutDocument document = LayoutDocument::Recover(LayoutDocument::UntitledFile(folder_.path()));
  EXPECT_FALSE(document.has_file());
  EXPECT_EQ(document.layout().parts.size(), 1U);
  document.SaveAs(folder_ / "kept.toml");
  EXPECT_FALSE(std::filesystem::exists(AutosaveOf(LayoutDocument::UntitledFile(folder_.path()))));
}

TEST_F(LayoutDocumentTest, AnAutosaveThatSaysWhatTheFileSaysOrIsDamagedIsNone) {
  WriteText(AutosaveOf(file_), kWritten);
  EXPECT_FALSE(FindAutosave(file_));
  WriteText(AutosaveOf(file_), "[[part");
  EXPECT_FALSE(FindAutosave(file_));
}

TEST_F(LayoutDocumentTest, RemovingAPartTakesItsRulesAlong) {
  LayoutDocument document = LayoutDocument::Open(file_);
  document.Apply("Rules", [](cad_import::LayoutText& text) {
    PutSpacing(text, {"gap", "lid", "box", "z", 0.0, 300.0, 180.0});
    PutPair(text, {"lid", "box", 5.0, {}, {}});
    PutGroup(text, {"both", {"box", "lid"}});
    PutGroup(text, {"lids", {"lid"}});
  });
  document.Apply("Remove lid", [](cad_import::LayoutText& text) { RemoveWithUsers(text, "lid"); });
  EXPECT_TRUE(document.layout().spacings.empty());
  EXPECT_TRUE(document.layout().pair_rules.empty());
  ASSERT_EQ(document.layout().groups.size(), 1U);
  EXPECT_EQ(document.layout().groups[0].parts, std::vector<std::string>{"box"});
}

TEST_F(LayoutDocumentTest, ARenamedPartIsNamedSoInItsRules) {
  LayoutDocument document = LayoutDocument::Open(file_);
  document.Apply("Rules", [](cad_import::LayoutText& text) {
    PutSpacing(text, {"gap", "lid", "box", "z", 0.0, 300.0, 180.0});
    PutPair(text, {"lid", "box", 5.0, {}, {}});
    PutGroup(text, {"both", {"box", "lid"}});
  });
  const auto rename = [](const char* to) {
    return [to](cad_import::LayoutText& text) { RenamePart(text, "lid", to); };
  };
  EXPECT_THROW(document.Apply("Rename", rename("box")), core::Error);
  EXPECT_THROW(document.Apply("Rename", rename("both")), core::Error);
  document.Apply("Rename", rename("cover"));
  const core::Layout& layout = document.layout();
  EXPECT_EQ(layout.parts[1].name, "cover");
  EXPECT_EQ(layout.spacings[0].moving, "cover");
  EXPECT_EQ(layout.pair_rules[0].a, "cover");
  EXPECT_EQ(layout.groups[0].parts, (std::vector<std::string>{"box", "cover"}));
  EXPECT_EQ(layout.parts[1].file, "cad/lid.glb");
  EXPECT_NE(document.text().text().find("# Guessed."), std::string::npos);
}

// Any sequence of changes: back to the first text and forward to the last, step by step the same.
TEST_F(LayoutDocumentTest, AnySequenceGoesBackAndForthBitEqual) {
  std::mt19937 random(7);
  for (int run = 0; run < 20; ++run) {
    LayoutDocument document = LayoutDocument::Open(file_);
    std::vector<std::string> texts{document.text().text()};
    for (int step = 0; step < 12; ++step) {
      const std::string part = random() % 2 ? "lid" : "box";
      const double value = 0.5 * static_cast<double>(random() % 1000);
      if (random() % 3) {
        Move(document, part, value);
      } else {
        document.Apply("Rule", [&](cad_import::LayoutText& text) {
          PutPair(text, {"lid", "box", value, {}, {}});
        });
      }
      if (document.text().text() != texts.back()) texts.push_back(document.text().text());
    }
    for (std::size_t i = texts.size() - 1; i-- > 0;) {
      document.Undo();
      EXPECT_EQ(document.text().text(), texts[i]);
    }
    EXPECT_FALSE(document.CanUndo());
    for (std::size_t i = 1; i < texts.size(); ++i) {
      document.Redo();
      EXPECT_EQ(document.text().text(), texts[i]);
    }
  }
}

}  // namespace
}  // namespace elbowroom::control
