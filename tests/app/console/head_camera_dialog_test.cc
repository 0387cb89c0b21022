// The head camera registered by clicks and keys on a synthetic picture.
#include "app/console/participant/head_camera_dialog.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QPushButton>
#include <QSignalSpy>
#include <QTest>
#include <algorithm>

#include "app/control/head/head_settings.h"
#include "tests/app/demo_frame.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

constexpr int kDrawnWithinMs = 60'000;  // far beyond what a picture takes

class HeadCameraRegistration : public testing::Test {
 protected:
  HeadCameraRegistration() {
    const control::HeadSettings settings;
    head.pose = recon::HeadPose{
        settings.world_from_fixed_head, control::HeadClock::now(), recon::HeadSource::kFixed, {}, {}};
    head.is_lost = false;
    dialog.show();
    dialog.Take(control::DemoFrame(), head, 0);
    EXPECT_TRUE(QTest::qWaitFor([&] { return !dialog.view()->picture_size().isEmpty(); }, kDrawnWithinMs));
  }
  QPushButton* Button(const char* name) { return dialog.findChild<QPushButton*>(name); }
  [[nodiscard]] Eigen::Vector2d PixelBy(const recon::HeadCamera& camera,
                                        const Eigen::Vector3d& x_in_world) const {
    return recon::PixelOf(camera, head.pose->world_from_head.Inverse() * x_in_world);
  }
  void Click(const Eigen::Vector2d& pixel) {
    QTest::mouseClick(dialog.view(), Qt::LeftButton, {},
                      dialog.view()->WidgetPointOf({pixel.x(), pixel.y()}));
  }

  test_support::TemporaryFolder folder;
  control::HeadState head;
  HeadCameraDialog dialog{recon::HeadCamera(), QString::fromStdString((folder / "HEAD.toml").string()),
                          nullptr};
};

// The camera stands 60 mm above the eyes, 30 mm to the right, and is turned by some degrees.
TEST_F(HeadCameraRegistration, AKnownOffsetIsFoundByMarks) {
  constexpr double kWorstPx = 3.0;  // clicks are whole pixels of the screen
  recon::HeadCamera truth;
  truth.head_from_camera = core::FromPositionAndRollPitchYaw({30.0, -60.0, 20.0}, {4.0, -3.0, 2.0});
  truth.focal_px = 640.0;
  // Corners that both pictures have, far from one another.
  std::vector<Eigen::Vector3d> marked;
  const auto corners = control::CornersOf(*control::DemoFrame());
  ASSERT_GT(corners.size(), 8U);
  const recon::HeadCamera start = dialog.camera();
  const auto is_inside = [](const Eigen::Vector2d& pixel) {
    return pixel.x() > 5 && pixel.y() > 5 && pixel.x() < 634 && pixel.y() < 474;
  };
  for (const auto& corner : corners) {
    const Eigen::Vector2d at = PixelBy(start, corner.x_in_world);
    if (!is_inside(at) || !is_inside(PixelBy(truth, corner.x_in_world))) continue;
    const auto caught = control::CornerAt(corners, start, head.pose->world_from_head, at, 3.0);
    if (!caught || caught->x_in_world != corner.x_in_world) continue;  // another one is drawn before it
    if (std::ranges::all_of(marked,
                            [&](const auto& other) { return (PixelBy(start, other) - at).norm() > 25.0; }))
      marked.push_back(corner.x_in_world);
  }
  ASSERT_GE(marked.size(), 6U);
  Button("head_camera_mark")->click();
  for (const auto& corner : marked) {
    Click(PixelBy(start, corner));
    Click(PixelBy(truth, corner));
  }
  EXPECT_EQ(dialog.findChild<QListWidget*>()->count(), static_cast<int>(marked.size()));
  Button("head_camera_fit")->click();
  for (const auto& corner : marked)
    EXPECT_LT((PixelBy(dialog.camera(), corner) - PixelBy(truth, corner)).norm(), kWorstPx);
  // It is in the file, and the figures are told.
  QSignalSpy saved(&dialog, &HeadCameraDialog::Saved);
  Button("head_camera_save")->click();
  ASSERT_EQ(saved.count(), 1);
  const auto read = control::ReadHeadFile(folder / "HEAD.toml").head_camera;
  ASSERT_TRUE(read.has_value());
  for (const auto& corner : marked)
    EXPECT_LT((PixelBy(*read, corner) - PixelBy(dialog.camera(), corner)).norm(), 0.05);
  EXPECT_TRUE(dialog.findChild<QLabel*>("head_camera_figures")->text().contains("px RMS"));
}

TEST_F(HeadCameraRegistration, KeysMoveWhatIsSeen) {
  const Eigen::Vector3d ahead = head.pose->world_from_head * Eigen::Vector3d(0.0, 0.0, 700.0);
  const Eigen::Vector2d before = PixelBy(dialog.camera(), ahead);
  dialog.view()->setFocus();
  QTest::keyClick(dialog.view(), Qt::Key_Right);
  EXPECT_NEAR(PixelBy(dialog.camera(), ahead).x() - before.x(), 5.0, 1e-6);
  QTest::keyClick(dialog.view(), Qt::Key_Up, Qt::AltModifier);
  EXPECT_NEAR(PixelBy(dialog.camera(), ahead).y() - before.y(), -0.5, 1e-3);
  QTest::keyClick(dialog.view(), Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_NEAR(dialog.camera().head_from_camera.translation_mm.norm(), 5.0, 1e-6);
  const double focal_px = dialog.camera().focal_px;
  QTest::keyClick(dialog.view(), Qt::Key_Plus);
  EXPECT_NEAR(dialog.camera().focal_px / focal_px, 1.01, 1e-9);
  // A drag of the picture is a turn, too.
  const Eigen::Vector2d from = PixelBy(dialog.camera(), ahead);
  const QPoint at = dialog.view()->rect().center();
  QTest::mousePress(dialog.view(), Qt::LeftButton, {}, at);
  QTest::mouseMove(dialog.view(), at + QPoint(40, 0));
  QTest::mouseRelease(dialog.view(), Qt::LeftButton, {}, at + QPoint(40, 0));
  EXPECT_GT(PixelBy(dialog.camera(), ahead).x() - from.x(), 10.0);
}

TEST_F(HeadCameraRegistration, EveryControlIsNamed) {
  for (const char* name : {"head_camera_view", "head_camera_take", "head_camera_open", "head_camera_mark",
                           "head_camera_pairs", "head_camera_remove", "head_camera_fit", "head_camera_save",
                           "head_camera_step_px", "head_camera_step_mm"}) {
    const auto* widget = dialog.findChild<QWidget*>(name);
    ASSERT_NE(widget, nullptr) << name;
    EXPECT_FALSE(widget->accessibleName().isEmpty()) << name;
    EXPECT_FALSE(widget->toolTip().isEmpty()) << name;
  }
}

}  // namespace
}  // namespace elbowroom::console
