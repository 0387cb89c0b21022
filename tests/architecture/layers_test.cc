// The tree keeps to tests/architecture/layers.txt, and a wrong include does not go unnoticed.
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/architecture/layer_checker.h"
#include "tests/architecture/layers_file.h"
#include "tests/architecture/link_checker.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::architecture {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryFolder;
using test_support::WriteText;

const fs::path kRoot = test_support::SourceFolder();
const fs::path kLayersInTree = "tests/architecture/layers.txt";

std::string Lines(const std::vector<Violation>& violations) {
  std::string text;
  for (const Violation& violation : violations) text += ToString(violation) + "\n";
  return text;
}

// A tree with the real rules and every real room, empty but for what a test plants.
class PlantedTree : public testing::Test {
 protected:
  PlantedTree() {
    fs::create_directories(root_ / kLayersInTree.parent_path());
    fs::copy_file(kRoot / kLayersInTree, root_ / kLayersInTree);
    for (const Room& room : ReadLayers(root_ / kLayersInTree).rooms)
      fs::create_directories(root_ / room.folder);
  }

  void Plant(const std::string& file, const std::string& text) { WriteText(root_ / file, text); }
  [[nodiscard]] std::vector<Violation> Check() const {
    return CheckTree(root_.path(), ReadLayers(root_ / kLayersInTree));
  }
  void ExpectOne(const std::string& file, int line, const std::string& message) const {
    const std::vector<Violation> expected{{file, line, message}};
    EXPECT_EQ(Lines(Check()), Lines(expected));
  }

  const TemporaryFolder root_;
};

TEST(Layers, TheTreeKeepsToThem) {
  const std::vector<std::string> files = SourceFilesOf(kRoot);
  ASSERT_GT(files.size(), 20U) << "the checker looked in the wrong place";
  const Layers layers = ReadLayers(kRoot / kLayersInTree);
  EXPECT_EQ(Lines(CheckTree(kRoot, layers)), "");
  EXPECT_EQ(Lines(CheckDoors(kRoot, layers)), "");
}

TEST(Links, AreThoseOfTheIncludes) { EXPECT_EQ(Lines(CheckLinks(kRoot)), ""); }

TEST_F(PlantedTree, ARoomThatIsIncludedAndNotLinkedIsFound) {
  Plant("core/a.cc", "#include \"core/a.h\"\n");
  Plant("core/a.h", "#pragma once\n");
  Plant("core/CMakeLists.txt", "elbowroom_room(a SOURCES a.cc)  # elbowroom_room(no SOURCES b.cc)\n");
  Plant("sessions/b.cc", "#include <vector>\n#include \"core/a.h\"\n");
  const auto link = [&](const std::string& how) {
    Plant("sessions/CMakeLists.txt",
          "elbowroom_rooms(all a)\nelbowroom_room(b\n  SOURCES b.cc\n" + how + ")\n");
    return Lines(CheckLinks(root_.path()));
  };
  for (const char* how : {"USES elbowroom_a", "HIDES fmt::fmt elbowroom_a", "USES elbowroom_all"})
    EXPECT_EQ(link(how), "") << how;
  EXPECT_EQ(link("USES fmt::fmt"),
            "sessions/b.cc:2: elbowroom_b includes \"core/a.h\" and neither USES nor HIDES elbowroom_a\n");
}

TEST_F(PlantedTree, IsCleanBeforeAnythingIsPlanted) {
  Plant("core/a.h", "#pragma once\n#include <Eigen/Core>\n#include <vector>\n#include \"core/error.h\"\n");
  Plant("sessions/a.cc", "#include <sqlite3.h>\n#include <unistd.h>\n#include \"core/session.h\"\n");
  Plant("app/console/a.h",
        "#include <QWidget>\n#include \"app/control/trial_thread.h\"\n#include \"core/contact.h\"\n");
  EXPECT_EQ(Lines(Check()), "");
}

TEST_F(PlantedTree, CoreMayNotIncludeARoomAboveIt) {
  Plant("core/a.h", "#pragma once\n\n#include <vector>\n#include \"recon/footage/frame_set.h\"\n");
  ExpectOne("core/a.h", 4, "core must not include recon/footage (\"recon/footage/frame_set.h\")");
}

TEST_F(PlantedTree, RoomsSideBySideMayNotIncludeEachOther) {
  Plant("sessions/a.cc", "#include \"review/part_review.h\"\n");
  ExpectOne("sessions/a.cc", 1, "sessions must not include review (\"review/part_review.h\")");
}

TEST_F(PlantedTree, AFolderInsideARoomIsARoomOfItsOwn) {
  Plant("sessions/a.cc", "#include \"sessions/report/report.h\"\n");
  Plant("review/b.cc", "#include \"recon/gl/scene/scene.h\"\n");
  const std::vector<Violation> expected{
      {"review/b.cc", 1, "review must not include recon/gl/scene (\"recon/gl/scene/scene.h\")"},
      {"sessions/a.cc", 1, "sessions must not include sessions/report (\"sessions/report/report.h\")"}};
  EXPECT_EQ(Lines(Check()), Lines(expected));
}

TEST_F(PlantedTree, TheConsoleSeesOnlyTheOperatorsCameraOfRecon) {
  Plant("app/console/a.cc",
        "#include \"recon/appearance/orbit_camera.h\"\n#include \"recon/hull/visual_hull.h\"\n");
  ExpectOne("app/console/a.cc", 2, "app/console must not include recon/hull (\"recon/hull/visual_hull.h\")");
}

TEST_F(PlantedTree, OnlyTheDoorsOfARoomAreOpen) {
  Plant("app/control/a.cc", "#include \"recon/gl/scene/scene.h\"\n#include \"recon/gl/scene/lighting.h\"\n");
  Plant("recon/hull/b.h",
        "#include \"recon/contours/contour_map.h\"\n#include \"recon/contours/contour_cells.h\"\n");
  Plant("recon/hull_mesh/c.cc", "#include \"recon/hull_mesh/cube_table.h\"\n");
  Plant("tests/d_test.cc", "#include \"recon/hull_mesh/cube_table.h\"\n");
  const auto inner = [](const std::string& header, const std::string& room) {
    return "\"" + header + "\" is inner to " + room + ": include one of its doors (layers.txt)";
  };
  const std::vector<Violation> expected{
      {"app/control/a.cc", 2, inner("recon/gl/scene/lighting.h", "recon/gl/scene")},
      {"recon/hull/b.h", 2, inner("recon/contours/contour_cells.h", "recon/contours")}};
  EXPECT_EQ(Lines(Check()), Lines(expected));
}

TEST_F(PlantedTree, ADoorThatIsNoHeaderIsFound) {
  const Layers layers = ReadLayers(root_ / kLayersInTree);
  std::size_t doors = 0;
  for (const Room& room : layers.rooms) doors += room.doors.size();
  EXPECT_EQ(CheckDoors(root_.path(), layers).size(), doors) << "none is planted";
}

TEST_F(PlantedTree, QtStaysInTheConsole) {
  Plant("app/control/a.h", "#include <QObject>\n");
  ExpectOne("app/control/a.h", 1, "app/control must not include Qt (<QObject>)");
}

TEST_F(PlantedTree, SqliteStaysOutOfHeaders) {
  Plant("sessions/a.h", "#pragma once\n# include <SQLiteCpp/Database.h>\n");
  ExpectOne("sessions/a.h", 2,
            "SQLite belongs in .cc files of sessions, not in a header (<SQLiteCpp/Database.h>)");
}

TEST_F(PlantedTree, OpenGlStaysInItsFolder) {
  Plant("recon/hull/a.cc", "#include <epoxy/gl.h>\n");
  ExpectOne("recon/hull/a.cc", 1, "recon/hull must not include OpenGL (<epoxy/gl.h>)");
}

TEST_F(PlantedTree, OpenCvStaysOutOfCore) {
  Plant("core/a.cc", "#if 0\n#include <opencv2/core.hpp>\n#endif\n");
  ExpectOne("core/a.cc", 2, "core must not include OpenCV (<opencv2/core.hpp>)");
}

TEST_F(PlantedTree, AnUnknownLibraryNeedsLeaveFirst) {
  Plant("core/a.cc", "#include <boost/any.hpp>\n");
  ExpectOne("core/a.cc", 1,
            "<boost/any.hpp> belongs to no library of layers.txt; own headers are included from the root");
}

TEST_F(PlantedTree, AnIncludeThatIsNotFromTheRootIsFound) {
  Plant("core/a.cc", "#include \"error.h\"\n");
  ExpectOne("core/a.cc", 1,
            "<error.h> belongs to no library of layers.txt; own headers are included from the root");
}

TEST_F(PlantedTree, AFolderThatIsNoRoomIsFound) {
  Plant("utils/a.h", "#pragma once\n");
  ExpectOne("utils/a.h", 1, "lies in no room of layers.txt");
}

TEST_F(PlantedTree, AFileBesideTheRoomsInsideIsFound) {
  Plant("recon/a.h", "#pragma once\n");
  ExpectOne("recon/a.h", 1, "lies in no room of layers.txt");
}

TEST_F(PlantedTree, ARoomWithoutAFolderIsFound) {
  fs::remove_all(root_ / "app/console/desktop");
  const std::vector<Violation> found = Check();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].file, kLayersInTree.generic_string());
  EXPECT_EQ(found[0].message, "room 'app/console/desktop' is no folder of the tree");
}

TEST_F(PlantedTree, BuildsAndHiddenFoldersAreNotPartOfTheTree) {
  Plant("build/dev/generated.cc", "#include <QWidget>\n");
  Plant(".cache/a.cc", "#include <QWidget>\n");
  EXPECT_EQ(Lines(Check()), "");
}

struct BadLine {
  std::string name;
  std::string text;
  std::string message;
};

void PrintTo(const BadLine& line, std::ostream* out) { *out << line.text; }

class BadLayersFile : public testing::TestWithParam<BadLine> {};

TEST_P(BadLayersFile, IsAnErrorThatNamesTheLine) {
  const TemporaryFolder folder;
  const fs::path file = folder / "layers.txt";
  WriteText(file, "# rules\nroom core :\nlibrary Eigen : Eigen/*\n" + GetParam().text + "\n");
  try {
    (void)ReadLayers(file);
    FAIL() << "accepted";
  } catch (const core::Error& error) {
    EXPECT_EQ(error.kind(), core::ErrorKind::kFormat);
    EXPECT_EQ(error.what(), file.string() + ":4: " + GetParam().message);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Layers, BadLayersFile,
    testing::Values(
        BadLine{"UnknownRoomToLeanOn", "room recon : core cellar",
                "room 'cellar' is not declared above; a room leans only on rooms above it"},
        BadLine{"UnknownRoomThatUses", "use cellar : Eigen", "room 'cellar' is not declared above"},
        BadLine{"UnknownLibrary", "use core : Egien", "library 'Egien' is not declared above"},
        BadLine{"RoomTwice", "room core :", "room 'core' is declared twice"},
        BadLine{"LibraryTwice", "library Eigen : e", "library 'Eigen' is declared twice"},
        BadLine{"UnknownKind", "hall core :", "'hall' is none of room, doors, library, use"},
        BadLine{"DoorsOfAnUnknownRoom", "doors cellar : a.h", "room 'cellar' is not declared above"},
        BadLine{"ADoorThatIsNoHeader", "doors core : a.cc", "'a.cc' is no header"},
        BadLine{"NoColon", "room recon core", "expected 'room|doors|library|use NAME : ...'"}),
    [](const auto& param_info) { return param_info.param.name; });

TEST(Layers, AMissingFileIsAnError) { EXPECT_THROW((void)ReadLayers("/nowhere/layers.txt"), core::Error); }

}  // namespace
}  // namespace elbowroom::architecture
