// The console with live cameras: the strip, the preflight panel and the background, through its widgets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableWidget>
#include <QTest>
#include <algorithm>
#include <filesystem>

#include "app/console/background_dialog.h"
#include "app/console/main_window.h"
#include "recon/capture/live_rig.h"
#include "recon/synthetic/rig_presets.h"
#include "recon/synthetic/synthetic_rig.h"
#include "tests/app/live_demo.h"
#include "tests/recon/capture/served_rig.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::console {
namespace {

using control::DemoFootage;
using recon::testing::ServedRig;
namespace fs = std::filesystem;

// Far beyond what any step takes on a loaded machine; a test that waits so long has failed.
constexpr int kPatienceMs = 120'000;
constexpr double kCheckS = 1.0;

const DemoFootage& Demo() {
  static const DemoFootage footage = control::RenderDemo();
  return footage;
}

// The table without anybody, with the cameras' noise.
std::vector<recon::FrameSet> EmptyScene() {
  recon::SyntheticRig simulated(recon::FourCameraRig(),
                                [](double) { return std::vector<recon::SyntheticObject>(); }, {});
  std::vector<recon::FrameSet> sets;
  constexpr core::FrameIndex kEmptySets = 20;
  for (core::FrameIndex i = 0; i < kEmptySets; ++i) sets.push_back(simulated.Read(i));
  return sets;
}

class LiveWindowTest : public testing::Test {
 protected:
  explicit LiveWindowTest(std::vector<recon::FrameSet> sets = Demo().sets)
      : served_(std::move(sets), control::kRateHz),
        rig_path_(folder_ / "RIG.yml"),
        window_(folder_ / "live.db") {
    recon::WriteRigFile(control::LiveRigFile(Demo(), served_, folder_.path()), rig_path_);
    window_.resize(1280, 720);
    window_.show();
  }
  ~LiveWindowTest() override {
    window_.desk().Stop();
    window_.preflight().Cancel();
    WaitUntil(
        [&] { return window_.desk().state() == DeskState::kIdle && !window_.desk().are_cameras_taken(); });
  }

  template <typename Condition>
  static bool WaitUntil(Condition condition) {
    return QTest::qWaitFor(condition, kPatienceMs);
  }
  template <typename Widget>
  Widget& Find(const char* name) {
    return *window_.findChild<Widget*>(name);
  }
  QAction& Action(const char* name) { return Find<QAction>(name); }

  void StartTrial() {
    window_.desk().Start(
        [path = rig_path_](const std::stop_token& stop) {
          control::TrialSetup setup = Demo().setup;
          setup.source = std::make_shared<recon::LiveRig>(recon::ReadRigFile(path), recon::LiveTaps(), stop);
          return setup;
        },
        folder_ / "live.db");
  }
  const TileText& Text(std::size_t camera) { return window_.strip().thumbnails().at(camera)->text(); }
  [[nodiscard]] bool HasTiles() {
    return window_.strip().thumbnails().size() == control::kCameras && !Text(0).rate.isEmpty();
  }
  // A first set can lack a camera's picture.
  [[nodiscard]] bool HasPictures() {
    return HasTiles() && std::ranges::none_of(
                             window_.strip().thumbnails(),
                             [](const CameraThumbnail* thumbnail) { return thumbnail->picture().isNull(); });
  }
  void OpenRig() {
    window_.preflight().Open(rig_path_);
    ASSERT_TRUE(WaitUntil([&] { return window_.preflight().CanCheck(); }));
  }
  QString Headline() { return Find<QLabel>("preflight_headline").text(); }

  test_support::TemporaryFolder folder_;
  ServedRig served_;
  fs::path rig_path_;
  MainWindow window_;
};

TEST_F(LiveWindowTest, TheStripShowsPicturesFiguresAndACameraThatGoes) {
  QSignalSpy ages(&window_.view(), &OperatorView::PictureSeen);
  StartTrial();
  ASSERT_TRUE(WaitUntil([&] { return HasPictures() && Text(0).rate.endsWith(" Hz"); }));
  for (std::size_t i = 0; i < control::kCameras; ++i) {
    const CameraThumbnail& thumbnail = *window_.strip().thumbnails()[i];
    EXPECT_LE(thumbnail.picture().width(), thumbnail.PictureRoom().width());
    EXPECT_LE(thumbnail.picture().height(), thumbnail.PictureRoom().height());
    EXPECT_TRUE(Text(i).lost.startsWith("lost ")) << Text(i).lost.toStdString();
    EXPECT_TRUE(Text(i).trouble.isEmpty() || Text(i).trouble == "no picture");
  }
  ASSERT_TRUE(WaitUntil([&] { return Text(3).light.startsWith("light "); }));
  ASSERT_TRUE(WaitUntil([&] { return !ages.isEmpty(); }));
  EXPECT_GT(ages.front().at(1).toDouble(), 0.0);
  EXPECT_TRUE(Find<QLabel>("status_age").text().startsWith("picture "));

  served_.Switch(2, false);
  ASSERT_TRUE(WaitUntil([&] { return Text(2).trouble.startsWith("gone: "); }));
  EXPECT_EQ(window_.strip().thumbnails()[2]->picture().format(), QImage::Format_Grayscale8);
  EXPECT_FALSE(Text(1).trouble.startsWith("gone"));
  served_.Switch(2, true);
  ASSERT_TRUE(WaitUntil([&] { return !Text(2).trouble.startsWith("gone"); }));
  EXPECT_EQ(window_.strip().thumbnails()[2]->picture().format(), QImage::Format_RGB32);
}

TEST_F(LiveWindowTest, WhileATrialRunsItsCamerasAreLeftAlone) {
  OpenRig();
  EXPECT_TRUE(Action("take_background").isEnabled());
  StartTrial();
  EXPECT_FALSE(window_.preflight().CanCheck());
  EXPECT_FALSE(Find<QPushButton>("preflight_check").isEnabled());
  EXPECT_FALSE(Action("take_background").isEnabled());
  EXPECT_TRUE(Action("take_background").toolTip().contains("stop it first"));
  ASSERT_TRUE(WaitUntil([&] { return HasTiles(); }));
  Action("stop").trigger();
  ASSERT_TRUE(WaitUntil([&] { return window_.preflight().CanCheck(); }));
  EXPECT_TRUE(Action("take_background").isEnabled());
}

TEST_F(LiveWindowTest, APreflightShowsARowForEachCameraAndForTheRig) {
  OpenRig();
  EXPECT_EQ(window_.preflight().rows().size(), 3U);
  EXPECT_TRUE(Headline().contains("aren't checked")) << Headline().toStdString();
  QSignalSpy checked(&window_.preflight(), &PreflightPanel::Checked);
  window_.preflight().Check(kCheckS);
  EXPECT_FALSE(Action("open_trial").isEnabled());
  EXPECT_TRUE(Find<QPushButton>("preflight_cancel").isVisibleTo(&window_.preflight()));
  ASSERT_TRUE(WaitUntil([&] { return !checked.isEmpty(); }));
  EXPECT_TRUE(checked.front().front().toBool()) << Headline().toStdString();
  EXPECT_TRUE(Action("open_trial").isEnabled());
  const auto& table = Find<QTableWidget>("preflight_rows");
  ASSERT_EQ(table.rowCount(), 3 + control::kCameras + 1);
  for (int row = 0; row < table.rowCount(); ++row) {
    const control::PreflightRow& found = window_.preflight().rows().at(static_cast<std::size_t>(row));
    EXPECT_EQ(table.item(row, 1)->text().toStdString(), found.subject);
    EXPECT_EQ(table.item(row, 0)->text() == "✔ well", found.state == control::PreflightState::kWell);
    EXPECT_EQ(table.item(row, 2)->text().contains("→"), !found.advice.empty());
  }
  EXPECT_FALSE(Headline().contains("aren't checked"));
}

TEST_F(LiveWindowTest, ARigOfRecordedFilesHasNoLiveCamerasToCheck) {
  recon::RigFile recorded = recon::ReadRigFile(rig_path_);
  for (recon::CameraSources& sources : recorded.sources) sources.frames = (folder_ / "video.avi").string();
  recon::WriteRigFile(recorded, folder_ / "recorded.yml");
  window_.preflight().Open(folder_ / "recorded.yml");
  ASSERT_TRUE(WaitUntil([&] { return window_.preflight().rig().has_value(); }));
  EXPECT_TRUE(Headline().contains("no live cameras")) << Headline().toStdString();
  EXPECT_FALSE(window_.preflight().CanCheck());
  EXPECT_FALSE(Action("take_background").isEnabled());
  EXPECT_TRUE(Action("take_background").toolTip().contains("recorded"));

  window_.preflight().Open(folder_ / "nowhere.yml");
  ASSERT_TRUE(WaitUntil([&] { return Headline().startsWith("✖"); }));
  EXPECT_TRUE(Headline().contains("nowhere.yml"));
  EXPECT_TRUE(window_.preflight().rows().empty());
}

TEST_F(LiveWindowTest, ACancelledPreflightKeepsWhatWasKnown) {
  OpenRig();
  QSignalSpy checked(&window_.preflight(), &PreflightPanel::Checked);
  constexpr double kForeverS = 3600.0;
  window_.preflight().Check(kForeverS);
  Find<QPushButton>("preflight_cancel").click();
  ASSERT_TRUE(WaitUntil([&] { return !checked.isEmpty(); }));
  EXPECT_FALSE(checked.front().front().toBool());
  EXPECT_EQ(window_.preflight().rows().size(), 3U);
  EXPECT_TRUE(window_.preflight().CanCheck());
}

TEST_F(LiveWindowTest, ABackgroundWithSomebodyInItIsRefused) {
  OpenRig();
  BackgroundDialog dialog(window_.preflight().rig()->rig_file, folder_ / "empty");
  QSignalSpy ended(&dialog, &BackgroundDialog::Ended);
  dialog.findChild<QDoubleSpinBox*>("background_countdown")->setValue(0.0);
  dialog.Start();
  ASSERT_TRUE(WaitUntil([&] { return !ended.isEmpty(); }));
  EXPECT_FALSE(ended.front().front().toBool());
  const QString headline = dialog.findChild<QLabel*>("background_headline")->text();
  EXPECT_TRUE(headline.contains("nothing was written")) << headline.toStdString();
  EXPECT_FALSE(fs::exists(folder_ / "empty"));
}

class EmptyWindowTest : public LiveWindowTest {
 protected:
  EmptyWindowTest() : LiveWindowTest(EmptyScene()) {}
};

TEST_F(EmptyWindowTest, ABackgroundIsTakenAfterACountdownAndThePanelShowsItsRig) {
  OpenRig();
  Action("take_background").trigger();
  auto* dialog = window_.findChild<BackgroundDialog*>();
  ASSERT_NE(dialog, nullptr);
  EXPECT_EQ(fs::path(dialog->findChild<QLineEdit*>("background_folder")->text().toStdString()).parent_path(),
            folder_.path());
  dialog->findChild<QLineEdit*>("background_folder")
      ->setText(QString::fromStdString((folder_ / "empty").string()));
  dialog->findChild<QDoubleSpinBox*>("background_countdown")->setValue(2.0);
  auto* headline = dialog->findChild<QLabel*>("background_headline");
  QSignalSpy taken(dialog, &BackgroundDialog::Taken);
  dialog->findChild<QPushButton*>("background_start")->click();
  EXPECT_FALSE(Action("take_background").isEnabled());
  EXPECT_FALSE(window_.preflight().CanCheck());
  ASSERT_TRUE(WaitUntil([&] { return headline->text().startsWith("Leave the cameras' view"); }));
  ASSERT_TRUE(WaitUntil([&] { return !taken.isEmpty() || headline->text().startsWith("✖"); }));
  ASSERT_FALSE(taken.isEmpty()) << headline->text().toStdString();
  EXPECT_EQ(taken.front().front().toString().toStdString(), (folder_ / "empty" / "RIG.yml").string());
  ASSERT_TRUE(WaitUntil([&] { return window_.preflight().CanCheck(); }));
  EXPECT_EQ(window_.preflight().rig()->path, folder_ / "empty" / "RIG.yml");
  EXPECT_EQ(window_.preflight().rows().front().state, control::PreflightState::kWell);
  EXPECT_TRUE(Action("take_background").isEnabled());
}

TEST_F(LiveWindowTest, ClosingTheDialogGivesTheCamerasBack) {
  OpenRig();
  Action("take_background").trigger();
  auto* dialog = window_.findChild<BackgroundDialog*>();
  dialog->Start();
  EXPECT_TRUE(window_.desk().are_cameras_taken());
  dialog->close();
  ASSERT_TRUE(WaitUntil([&] { return !window_.desk().are_cameras_taken(); }));
  EXPECT_TRUE(window_.preflight().CanCheck());
}

}  // namespace
}  // namespace elbowroom::console
