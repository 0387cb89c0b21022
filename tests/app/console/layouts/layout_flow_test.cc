// From an empty folder to a trial in the window, by mouse and keys alone.
#include <gtest/gtest.h>

#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QToolButton>
#include <fstream>

#include "app/console/desktop/session_place.h"
#include "app/console/desktop/theme.h"
#include "app/console/layouts/import_dialog.h"
#include "app/console/layouts/rule_dialogs.h"
#include "app/console/layouts/trial_dialog.h"
#include "app/console/main_window.h"
#include "cad_import/layout/layout_file.h"
#include "sessions/session_reader.h"
#include "tests/app/console/layouts/user_actions.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::console {
namespace {

const std::filesystem::path kData = ELBOWROOM_SHARED_DATA_DIR;
const std::filesystem::path kAssemblyFile = kData / "cad/step/ap203_ap214/as1-oc-214.stp";
const std::filesystem::path kRig = kData / "four_cameras/rig.yml";

class LayoutFlow : public testing::Test {
 protected:
  LayoutFlow() {
    SetSessionsFolder(folder_ / "sessions");
    if (qEnvironmentVariableIsSet("ELBOWROOM_SCREENSHOTS_DARK")) SetTheme(Theme::kDark);
    window_.resize(1280, 720);
    window_.show();
    window_.activateWindow();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&window_));
  }
  ~LayoutFlow() override {
    window_.desk().Stop();
    (void)WaitUntil([&] { return window_.desk().state() == DeskState::kIdle; });
  }
  template <typename Widget>
  Widget* Find(const char* name) {
    auto* widget = window_.findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name;
    return widget;
  }
  [[nodiscard]] std::string Message() { return Find<QLabel>("message")->text().toStdString(); }
  // Keeps a picture of the widget, or of the window, where ELBOWROOM_SCREENSHOTS names a folder.
  void Keep(const char* name, QWidget* widget = nullptr) {
    const QString folder = qEnvironmentVariable("ELBOWROOM_SCREENSHOTS");
    if (folder.isEmpty()) return;
    QTest::qWait(1500);  // until the picture is drawn in full
    (widget == nullptr ? &window_ : widget)->grab().save(QString("%1/%2.png").arg(folder, name));
  }

  test_support::TemporaryFolder folder_;
  MainWindow window_;
};

TEST_F(LayoutFlow, FromAnEmptyFolderToATrialOnFourCameras) {
  QTest::keyClick(&window_, Qt::Key_1, Qt::ControlModifier);
  ASSERT_EQ(window_.pages().page(), Page::kLayout);
  Keep("1_empty");

  TypeIntoNextFileDialog(QString::fromStdString(kAssemblyFile.string()));
  Click(Find<QToolButton>("layout_import_button"));
  auto* import = Find<ImportDialog>("import_dialog");
  ASSERT_TRUE(WaitUntil([&] { return !import->is_reading(); }));
  auto* tree = Find<QTreeWidget>("import_tree");
  ASSERT_TRUE(TickItem(tree, "plate_1"));
  ASSERT_TRUE(TickItem(tree, "rod-assembly_1"));
  Keep("2_import", import);
  Click(Find<QPushButton>("import_take"));
  LayoutPage& page = window_.layout_page();
  ASSERT_EQ(page.desk().document().layout().parts.size(), 2U) << Message();
  ASSERT_TRUE(WaitUntil([&] { return !page.view().picture().isNull(); }));
  Keep("3_parts");

  auto* list = Find<QTreeWidget>("parts");
  QTest::mouseClick(list->viewport(), Qt::LeftButton, {},
                    list->visualItemRect(list->topLevelItem(0)).center());
  QTest::mouseClick(list->viewport(), Qt::LeftButton, Qt::ControlModifier,
                    list->visualItemRect(list->topLevelItem(1)).center());
  ASSERT_EQ(page.chosen().size(), 2);
  Click(Find<QPushButton>("add_spacing"));
  auto* spacing = Find<SpacingDialog>("spacing_dialog");
  TypeInto(spacing->findChild<QLineEdit*>("spacing_name"), "gap");
  TypeInto(spacing->findChild<QDoubleSpinBox*>("spacing_initial"), "20");
  Keep("4_spacing", spacing);
  Click(spacing->findChild<QPushButton*>("rule_ok"));
  Click(Find<QPushButton>("add_pair"));
  auto* pair = Find<PairDialog>("pair_dialog");
  TypeInto(pair->findChild<QDoubleSpinBox*>("pair_clearance"), "10");
  Keep("4_pair", pair);
  Click(pair->findChild<QPushButton*>("rule_ok"));
  ASSERT_EQ(Find<QListWidget>("rules")->count(), 2) << Message();
  Keep("5_rules");

  const std::filesystem::path layout = folder_ / "layout.toml";
  TypeIntoNextFileDialog(QString::fromStdString(layout.string()));
  QTest::keyClick(&page.view(), Qt::Key_S, Qt::ControlModifier);
  const cad_import::ImportedLayout saved = cad_import::ImportLayoutFile(layout);
  EXPECT_EQ(saved.layout.spacings.at(0).initial_mm, 20.0);
  EXPECT_EQ(saved.layout.pair_rules.at(0).required_clearance_mm, 10.0);

  Click(Find<QToolButton>("layout_trial_button"));
  auto* trial = Find<TrialDialog>("trial_dialog");
  TypeInto(trial->findChild<QLineEdit*>("trial_rig"), QString::fromStdString(kRig.string()));
  TypeInto(trial->findChild<QLineEdit*>("trial_participant"), "P07");
  TypeInto(trial->findChild<QDoubleSpinBox*>("trial_estimate"), "18");
  TypeInto(trial->findChild<QLineEdit*>("trial_tools"), "tongs, pipe");
  Keep("6_trial", trial);
  int frames = 0;
  QObject::connect(&window_.desk(), &TrialDesk::FrameArrived, &window_, [&] { ++frames; });
  Click(trial->findChild<QPushButton*>("trial_start"));
  ASSERT_TRUE(WaitUntil([&] { return frames >= 3; })) << Message();
  EXPECT_EQ(window_.pages().page(), Page::kTrial);
  Keep("7_trial_runs");
  window_.findChild<QAction*>("stop")->trigger();
  ASSERT_TRUE(WaitUntil([&] { return window_.desk().state() == DeskState::kIdle; }));

  const sessions::SessionReader session(window_.desk().session());
  EXPECT_EQ(session.header().trial.participant, "P07");
  EXPECT_EQ(session.header().layout.spacings.at(0).name, "gap");
}

TEST_F(LayoutFlow, AFileIsOpenedWhereItBelongs) {
  const std::filesystem::path layout = folder_ / "empty_layout.toml";
  std::ofstream(layout) << "unit = \"mm\"\n";
  window_.OpenFile(QString::fromStdString(layout.string()));
  EXPECT_EQ(window_.pages().page(), Page::kLayout);
  ASSERT_TRUE(WaitUntil([&] { return window_.layout_page().desk().document().has_file(); })) << Message();
}

}  // namespace
}  // namespace elbowroom::console
