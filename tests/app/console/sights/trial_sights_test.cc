// What the experimenter looks at: a camera's picture with parts, standard views, sections, measurements.
#include <gtest/gtest.h>

#include <QAction>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QSettings>
#include <QTest>
#include <QToolButton>

#include "app/console/main_window.h"
#include "recon/appearance/orbit_camera.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::console {
namespace {

constexpr int kPatienceMs = 120'000;  // far beyond what any step takes on a loaded machine

class TrialSightsTest : public testing::Test {
 protected:
  TrialSightsTest() : window_(folder_ / "trial.db") {
    window_.resize(1280, 800);
    window_.show();
    QObject::connect(&window_.desk(), &TrialDesk::FrameArrived, &window_,
                     [this](const FrameNews& news) { last_frame_ = news.result; });
    QObject::connect(&window_.view(), &OperatorView::PictureShown, &window_, [this] { ++pictures_; });
    Action("start_demo").trigger();
    EXPECT_TRUE(WaitUntil([&] { return pictures_ > 0; }));
  }
  ~TrialSightsTest() override {
    window_.desk().Stop();
    WaitUntil([&] { return window_.desk().state() == DeskState::kIdle; });
  }

  template <typename Condition>
  static bool WaitUntil(Condition condition) {
    return QTest::qWaitFor(condition, kPatienceMs);
  }
  template <typename Widget>
  Widget* Find(const QString& name) {
    auto* widget = window_.findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name.toStdString();
    return widget;
  }
  // The review page has planes of its own.
  template <typename Widget>
  Widget* FindHere(const QString& name) {
    auto* widget = window_.sights().findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name.toStdString();
    return widget;
  }
  QAction& Action(const char* name) { return *Find<QAction>(name); }
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

  test_support::TemporaryFolder folder_;
  MainWindow window_;
  control::SharedFrameResult last_frame_;
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
