// What the experimenter looks at: a camera's picture with parts, standard views, sections, measurements.
#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMouseEvent>
#include <QSettings>
#include <QTest>
#include <QToolButton>
#include <cmath>
#include <filesystem>

#include "recon/appearance/orbit_camera.h"
#include "tests/app/console/window_fixture.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

class TrialSightsTest : public WindowFixture {
 protected:
  TrialSightsTest() : WindowFixture("trial.db", QSize(1280, 800)) {
    QObject::connect(&window_.view(), &OperatorView::PictureShown, &window_, [this] { ++pictures_; });
    Action("start_demo").trigger();
    EXPECT_TRUE(WaitUntil([&] { return pictures_ > 0; }));
  }
  ~TrialSightsTest() override {
    if (!IsIdle()) StopAndWait();
    QSettings().remove("section");  // each test begins with the first planes
  }

  // The review page has planes of its own.
  template <typename Widget>
  Widget* FindHere(const QString& name) {
    auto* widget = window_.sights().findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name.toStdString();
    return widget;
  }
  [[nodiscard]] bool IsShown(const char* text) {
    const auto& dimensions = window_.sights().measure().dimensions();
    return std::ranges::any_of(dimensions, [&](const auto& dimension) { return dimension.text == text; });
  }
  // Where the operator sees the point.
  void ClickOn(const Eigen::Vector3d& x_in_world) {
    OperatorView& view = window_.view();
    const auto pixel = recon::ViewFrom(*view.camera(), view.width(), view.height()).Project(x_in_world);
    ASSERT_TRUE(pixel);
    QTest::mouseClick(&view, Qt::LeftButton, {}, QPointF(pixel->x(), pixel->y()).toPoint());
  }

  // With the left button, by so many pixels.
  void DragHandle(PlaneHandle handle, const QPoint& by) {
    OperatorView& view = window_.view();
    const auto grip = window_.sights().section().GripOf(handle);
    ASSERT_TRUE(grip);
    const QPoint from = grip->toPoint();
    QTest::mousePress(&view, Qt::LeftButton, {}, from);
    for (const QPoint& at : {from + by / 2, from + by}) {
      QMouseEvent move(QEvent::MouseMove, at, view.mapToGlobal(at), Qt::NoButton, Qt::LeftButton, {});
      QApplication::sendEvent(&view, &move);
    }
    QTest::mouseRelease(&view, Qt::LeftButton, {}, from + by);
  }

  int pictures_ = 0;
};

TEST_F(TrialSightsTest, ADoubleClickShowsACamerasPictureWithThePartsLargeAndEscGoesBack) {
  CameraView& large = window_.sights().camera_view();
  const CameraThumbnail& tile = *window_.strip().thumbnails().at(1);
  ASSERT_TRUE(WaitUntil([&] { return !tile.picture().isNull(); }));
  QTest::mouseDClick(window_.strip().thumbnails().at(1), Qt::LeftButton);
  ASSERT_TRUE(WaitUntil([&] { return !large.picture().isNull(); }));
  EXPECT_TRUE(large.isVisible());
  EXPECT_FALSE(window_.view().isVisible());
  EXPECT_GT(large.picture().width(), 2 * tile.picture().width());
  // Without parts the picture is darker where they stand: the cloth is nearly black.
  const auto brightness = [&] {
    qint64 sum = 0;
    for (int y = 0; y < large.picture().height(); y += 4)
      for (int x = 0; x < large.picture().width(); x += 4) sum += qGray(large.picture().pixel(x, y));
    return sum;
  };
  const qint64 with_parts = brightness();
  Action("parts_in_pictures").trigger();
  EXPECT_TRUE(WaitUntil([&] { return brightness() < 9 * with_parts / 10; }));
  QTest::keyClick(&large, Qt::Key_Escape);
  EXPECT_TRUE(window_.view().isVisible());
  EXPECT_FALSE(window_.sights().wishes().enlarged);
}

TEST_F(TrialSightsTest, StandardViewsTurnTheViewAndParallelStays) {
  const double distance_mm = window_.view().camera()->distance_mm;
  Action("view_parallel").trigger();
  Action("view_top").trigger();
  EXPECT_NEAR(window_.view().camera()->elevation_rad, 1.5708, 1e-4);
  EXPECT_TRUE(window_.view().camera()->is_parallel);
  EXPECT_EQ(window_.view().camera()->distance_mm, distance_mm);
  Action("camera_scene:low").trigger();
  const Eigen::Vector3d eye = recon::ViewFrom(*window_.view().camera(), 100, 100).EyeInWorld();
  EXPECT_LT(eye.z(), 400.0);  // it stands low
}

TEST_F(TrialSightsTest, SectionPlanesAreSetByNumbersMovedByDragFlippedUndoneAndKept) {
  Action("section").trigger();
  auto* panel = FindHere<SectionPanel>("section_panel");
  auto* list = FindHere<QListWidget>("section_list");
  ASSERT_EQ(list->count(), 3);
  EXPECT_TRUE(panel->cut().is_none());
  list->setCurrentRow(1);  // across y
  list->item(1)->setCheckState(Qt::Checked);
  FindHere<QDoubleSpinBox>("section_mm")->setValue(12.5);
  ASSERT_EQ(panel->cut().kept.size(), 1U);
  EXPECT_EQ(panel->cut().kept[0], (recon::HalfSpace{{0, -1, 0}, 12.5}));
  FindHere<QToolButton>("section_flip")->click();
  EXPECT_EQ(panel->cut().kept[0], (recon::HalfSpace{{0, 1, 0}, -12.5}));
  panel->Drag({3.0, 10.0, 4.0});
  EXPECT_EQ(panel->cut().kept[0].at_mm, -2.5);
  FindHere<QDoubleSpinBox>("section_elevation")->setValue(45.0);
  const recon::HalfSpace turned = panel->cut().kept[0];
  EXPECT_NEAR((turned.outward - Eigen::Vector3d(0, 1, 1).normalized()).norm(), 0.0, 1e-12);
  auto* name = FindHere<QLineEdit>("section_name");
  name->setText("oblique");
  emit name->editingFinished();
  EXPECT_EQ(list->item(1)->text(), "oblique");
  EXPECT_EQ(window_.view().cut(), panel->cut());
  // The same planes in the next run.
  SectionPanel next;
  EXPECT_EQ(next.sections(), panel->sections());
  for (int step = 0; step < 2; ++step) FindHere<QToolButton>("section_undo")->click();
  EXPECT_EQ(panel->cut().kept[0], (recon::HalfSpace{{0, 1, 0}, -2.5}));
  FindHere<QToolButton>("section_redo")->click();
  EXPECT_EQ(panel->cut().kept[0], turned);
  Action("section").trigger();
  EXPECT_TRUE(panel->cut().is_none());
  EXPECT_TRUE(window_.view().cut().is_none());
}

TEST_F(TrialSightsTest, HandlesInTheViewMoveAndTurnTheChosenPlane) {
  Action("section").trigger();
  auto* panel = FindHere<SectionPanel>("section_panel");
  auto* list = FindHere<QListWidget>("section_list");
  list->setCurrentRow(1);
  list->item(1)->setCheckState(Qt::Checked);
  const int before = pictures_;
  ASSERT_TRUE(WaitUntil([&] { return pictures_ > before; }));
  const recon::OrbitCamera camera = *window_.view().camera();
  const recon::HalfSpace first = panel->cut().kept[0];
  DragHandle(PlaneHandle::kNormal, {40, 25});
  const recon::HalfSpace moved = panel->cut().kept[0];
  EXPECT_EQ(moved.outward, first.outward);
  EXPECT_GT(std::abs(moved.at_mm - first.at_mm), 1.0);
  DragHandle(PlaneHandle::kFirstRing, {15, 60});
  const recon::HalfSpace turned = panel->cut().kept[0];
  EXPECT_LT(turned.outward.dot(moved.outward), 0.999);
  EXPECT_NEAR(turned.outward.x(), 0.0, 1e-9);   // about the level axis, which is x
  EXPECT_EQ(*window_.view().camera(), camera);  // the view stayed
  FindHere<QToolButton>("section_undo")->click();
  EXPECT_EQ(panel->cut().kept[0], moved);
  FindHere<QToolButton>("section_undo")->click();
  EXPECT_EQ(panel->cut().kept[0], first);
}

TEST_F(TrialSightsTest, APlaneIsLaidOnAPickedFace) {
  Action("section").trigger();
  auto* panel = FindHere<SectionPanel>("section_panel");
  FindHere<QToolButton>("section_align")->click();
  EXPECT_TRUE(Find<QLabel>("measure_advice")->text().contains("face"));
  ClickOn({60, -150, 60});  // the front of the PMT's box
  ASSERT_TRUE(WaitUntil([&] { return !panel->cut().is_none(); }));
  EXPECT_EQ(panel->cut().kept[0].outward, Eigen::Vector3d(0, -1, 0));
  EXPECT_NEAR(panel->cut().kept[0].at_mm, 150.0, 2e-3);
  EXPECT_FALSE(FindHere<QToolButton>("section_align")->isChecked());
  EXPECT_TRUE(Find<QLabel>("measure_advice")->text().isEmpty());
}

TEST_F(TrialSightsTest, PlanesOfALayoutsFileAreSavedThere) {
  const std::filesystem::path file = folder_ / "layout.toml";
  test_support::WriteText(file, "unit = \"mm\"  # all\n");
  SectionPanel panel;
  panel.Open({Eigen::Vector3d::Constant(-100), Eigen::Vector3d::Constant(100)}, file,
             {{"lid", {0, 0, 1}, 40.0, true}});
  panel.show();
  QString fault;
  QObject::connect(&panel, &SectionPanel::Failed, &window_, [&](const QString& line) { fault = line; });
  auto* save = panel.findChild<QToolButton*>("section_save");
  EXPECT_FALSE(save->isEnabled());
  panel.findChild<QDoubleSpinBox*>("section_mm")->setValue(50.0);
  panel.findChild<QAction*>("section_add:x")->trigger();
  EXPECT_TRUE(save->isEnabled());
  save->click();
  ASSERT_TRUE(WaitUntil([&] { return panel.findChild<QLabel*>("section_state")->text().isEmpty(); }));
  EXPECT_EQ(fault, "");
  const std::string text = test_support::ReadText(file);
  EXPECT_TRUE(text.starts_with("unit = \"mm\"  # all\n"));
  EXPECT_NE(text.find("name = \"lid\"\nnormal = [0.0, 0.0, 1.0]\noffset_mm = 50.0\non = true"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Across X"), std::string::npos);
  EXPECT_FALSE(SectionPanel().findChild<QListWidget*>("section_list")->count() == 2);  // of that file alone
  test_support::WriteText(file, "[[part");
  panel.findChild<QToolButton*>("section_remove")->click();
  save->click();
  EXPECT_TRUE(WaitUntil([&] { return !fault.isEmpty(); }));
  EXPECT_TRUE(fault.contains("layout.toml:1")) << fault.toStdString();
}

TEST_F(TrialSightsTest, HeatIsShownWhileItIsWantedAndSaysWhatItMeans) {
  OperatorView& view = window_.view();
  EXPECT_TRUE(view.legends().empty());
  Action("heat").trigger();
  // The demo's hand touches the payload; the layer grows with it.
  ASSERT_TRUE(WaitUntil([&] { return !view.legends().empty() && !view.legends()[0].colours.empty(); }));
  EXPECT_EQ(view.legends()[0].title, "Touched for, s");
  EXPECT_EQ(view.legends()[0].labels.front(), "0");
  EXPECT_TRUE(view.accessibleDescription().contains("Touched for, s, from 0 to"));
  const QString scale_end = view.legends()[0].labels.back();
  EXPECT_TRUE(WaitUntil([&] { return view.legends()[0].labels.back() != scale_end; }));
  Action("heat").trigger();
  EXPECT_TRUE(view.legends().empty());
  EXPECT_TRUE(view.accessibleDescription().isEmpty());
  // What was touched before it is shown again is there, also after the trial.
  window_.desk().Stop();
  ASSERT_TRUE(WaitUntil([&] { return window_.desk().state() == DeskState::kIdle; }));
  Action("heat").trigger();
  EXPECT_TRUE(WaitUntil([&] { return !view.legends().empty() && !view.legends()[0].colours.empty(); }));
}

TEST_F(TrialSightsTest, TheHullIsColouredByWhatTheRigKnowsAndTheKeyGoesBack) {
  OperatorView& view = window_.view();
  Action("look_coverage").trigger();
  ASSERT_EQ(view.legends().size(), 1U);
  EXPECT_EQ(view.legends()[0].labels, QStringList({"1", "2", "3", "4"}));
  EXPECT_EQ(view.legends()[0].colours.size(), 4U);
  const int pictures = pictures_;
  EXPECT_TRUE(WaitUntil([&] { return pictures_ > pictures + 3; }));
  Action("look_uncertainty").trigger();
  ASSERT_EQ(view.legends().size(), 1U);
  EXPECT_TRUE(view.legends()[0].title.contains("mm"));
  EXPECT_TRUE(view.legends()[0].note.contains("2 sigma"));
  Action("look_uncertainty").trigger();
  EXPECT_TRUE(view.legends().empty());
  EXPECT_TRUE(Action("look_shaded").isChecked());
}

TEST_F(TrialSightsTest, TwoPickedFacesAreMeasuredAndFollowTheGap) {
  const Eigen::Vector3d front_of_pmt(60, -150, 60), front_of_payload(0, -130, 320);
  Action("measure_faces").trigger();
  EXPECT_FALSE(Find<QLabel>("measure_advice")->text().isEmpty());
  ClickOn(front_of_pmt);
  ASSERT_TRUE(WaitUntil([&] { return Find<QLabel>("measure_advice")->text().contains("second"); }));
  ClickOn(front_of_payload);
  EXPECT_TRUE(WaitUntil([&] { return IsShown("20.00 mm, parallel"); }));
  EXPECT_FALSE(Action("measure_faces").isChecked());
  Action("measure_hull").trigger();
  ClickOn(front_of_pmt);
  EXPECT_TRUE(WaitUntil([&] {
    return std::ranges::any_of(window_.sights().measure().dimensions(), [](const auto& dimension) {
      return !dimension.band && dimension.text.find("–") != std::string::npos;
    });
  }));
  Action("measure_clear").trigger();
  EXPECT_FALSE(IsShown("20.00 mm, parallel"));
}

}  // namespace
}  // namespace elbowroom::console
