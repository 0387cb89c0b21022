// What the experimenter looks at: a camera's picture with parts, standard views, sections, measurements.
#include <gtest/gtest.h>

#include <QAction>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QSettings>
#include <QTest>
#include <QToolButton>

#include "recon/appearance/orbit_camera.h"
#include "tests/app/console/window_fixture.h"

namespace elbowroom::console {
namespace {

class TrialSightsTest : public WindowFixture {
 protected:
  TrialSightsTest() : WindowFixture("trial.db", QSize(1280, 800)) {
    QObject::connect(&window_.view(), &OperatorView::PictureShown, &window_, [this] { ++pictures_; });
    Action("start_demo").trigger();
    EXPECT_TRUE(WaitUntil([&] { return pictures_ > 0; }));
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

TEST_F(TrialSightsTest, SectionPlanesAreSetByNumberMovedByDragFlippedAndKept) {
  Action("section").trigger();
  FindHere<QCheckBox>("section_on:y")->setChecked(true);
  FindHere<QDoubleSpinBox>("section_mm:y")->setValue(12.5);
  auto* panel = FindHere<SectionPanel>("section_panel");
  ASSERT_TRUE(panel->cut().planes[1]);
  EXPECT_EQ(panel->cut().planes[1]->at_mm, 12.5);
  const bool keeps_above = panel->cut().planes[1]->keeps_above;
  FindHere<QToolButton>("section_flip:y")->click();
  EXPECT_EQ(panel->cut().planes[1]->keeps_above, !keeps_above);
  panel->Drag({3.0, 10.0, 4.0});
  EXPECT_EQ(panel->cut().planes[1]->at_mm, 22.5);
  EXPECT_EQ(SectionPanel().findChild<QDoubleSpinBox*>("section_mm:y")->value(), 22.5);
  Action("section").trigger();
  EXPECT_TRUE(panel->cut().is_none());
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
