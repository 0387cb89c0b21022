// The participant's window: a real tracker's packets to the picture, the sign when it is lost, the choices.
#include <gtest/gtest.h>

#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTest>
#include <algorithm>
#include <cmath>

#include "app/console/participant/participant_desk.h"
#include "app/control/head/udp_port.h"
#include "tests/app/demo_frame.h"
#include "tests/openxr_runtime/mock_headset.h"

namespace elbowroom::console {
namespace {

constexpr int kLongMs = 60'000;  // far beyond what a picture takes

int FreePort() { return control::UdpPort("127.0.0.1", 0).port(); }

// The desk before an operator's window that is never shown.
class ParticipantWindow : public testing::Test {
 protected:
  ParticipantWindow() {
    QSettings().clear();
    ParticipantChoices choices;
    choices.fills_display = false;
    RememberChoices(choices);
  }
  void Make(const ParticipantChoices& choices) {
    RememberChoices(choices);
    desk = std::make_unique<ParticipantDesk>(&window);
    desk->ShowFrame(control::DemoFrame());
  }
  [[nodiscard]] bool HasPicture() const { return desk->is_open() && !desk->view()->picture().isNull(); }
  // Packets of a head that moves slowly, until `done`.
  template <typename Done>
  bool SendUntil(int port, const Done& done) {
    for (int i = 0; i < 3000 && !done(); ++i) {
      reading.position_mm.x() += 0.2;
      control::SendDatagram("127.0.0.1", port, control::OpenTrackPacket(reading));
      QTest::qWait(10);
    }
    return done();
  }

  QWidget window;
  std::unique_ptr<ParticipantDesk> desk;
  control::TrackerReading reading{{0.0, -650.0, 450.0}, 0.0, -25.0, 0.0};
};

TEST_F(ParticipantWindow, ShowsTheSceneFromAFixedPoint) {
  ParticipantChoices choices = RememberedChoices();
  Make(choices);
  QSignalSpy failed(desk.get(), &ParticipantDesk::Failed);
  EXPECT_FALSE(desk->is_open());
  desk->Open();
  ASSERT_TRUE(QTest::qWaitFor([&] { return HasPicture(); }, kLongMs));
  EXPECT_FALSE(desk->view()->is_lost());
  EXPECT_TRUE(failed.isEmpty());
  QTest::keyClick(desk->view(), Qt::Key_Escape);
  EXPECT_FALSE(desk->is_open());
  desk->Open();  // and again
  ASSERT_TRUE(QTest::qWaitFor([&] { return HasPicture(); }, kLongMs));
  desk->Close();
}

TEST_F(ParticipantWindow, FollowsPacketsAndStaysWhenTheyEnd) {
  ParticipantChoices choices = RememberedChoices();
  choices.source = recon::HeadSource::kOpenTrack;
  choices.port = FreePort();
  Make(choices);
  desk->Open();
  QSignalSpy seen(desk->view(), &ParticipantView::PictureSeen);
  EXPECT_TRUE(QTest::qWaitFor([&] { return desk->view()->is_lost(); }, kLongMs));  // nobody sends yet
  ASSERT_TRUE(SendUntil(choices.port, [&] { return seen.count() >= 5 && !desk->view()->is_lost(); }));
  EXPECT_TRUE(desk->ages().MedianMs().has_value());
  ASSERT_TRUE(QTest::qWaitFor([&] { return desk->view()->is_lost(); }, kLongMs));
  const QImage before = desk->view()->picture();
  ASSERT_FALSE(before.isNull());
  // Nonsense doesn't move it.
  const auto refused = desk->tracker()->counts().all_refused();
  for (int i = 0; i < 20; ++i)
    control::SendDatagram("127.0.0.1", choices.port,
                          std::vector<std::byte>(static_cast<std::size_t>(40 + i)));
  ASSERT_TRUE(
      QTest::qWaitFor([&] { return desk->tracker()->counts().all_refused() >= refused + 20; }, kLongMs));
  EXPECT_EQ(desk->view()->picture(), before);
  desk->Close();
}

// Both eyes' pictures go to the headset; when its runtime crashes, the window stays and says so.
TEST_F(ParticipantWindow, ShowsStereoInAnOpenXrHeadset) {
  test_support::MockHeadset mock;
  Eigen::Vector3d place(0.0, 0.5, 0.6);                                              // m, y up, z back
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitX()));  // looks down
  ParticipantChoices choices = RememberedChoices();
  choices.source = recon::HeadSource::kOpenXr;
  choices.eyes.mode = control::ViewMode::kStereo;
  Make(choices);
  desk->Open();
  const auto until = [&](const auto& done) {
    for (int i = 0; i < 6000 && !done(); ++i) {
      place.x() += 1e-5;
      mock.Put(place, turn);
      QTest::qWait(10);
    }
    return done();
  };
  ASSERT_TRUE(until([&] { return mock.control().frames_with_pictures > 10 && HasPicture(); }));
  mock.control().keeps_pictures = 0;
  const auto shown = mock.Pictures();
  // What the left eye sees of the parts is further to the right.
  const auto middle_of_parts = [](const test_support::MockPicture& picture) {
    double sum = 0.0, columns = 0.0;
    for (int i = 0; i < picture.width_px * picture.height_px; ++i) {
      const auto* pixel = picture.rgb.data() + 3 * static_cast<std::ptrdiff_t>(i);
      if (std::max({pixel[0], pixel[1], pixel[2]}) - std::min({pixel[0], pixel[1], pixel[2]}) < 40) continue;
      const double left = std::tan(picture.fov[0]), right = std::tan(picture.fov[1]);
      sum += left + (right - left) * (i % picture.width_px + 0.5) / picture.width_px;
      columns += 1.0;
    }
    EXPECT_GT(columns, 500.0);
    return sum / columns;
  };
  EXPECT_GT(middle_of_parts(shown[0]), middle_of_parts(shown[1]) + 0.02);
  EXPECT_EQ(mock.control().misuse, 0) << mock.control().what_misuse.data();
  mock.control().crashes = 1;
  ASSERT_TRUE(until([&] { return desk->view()->is_lost(); }));
  EXPECT_TRUE(desk->is_open());
  EXPECT_TRUE(HasPicture());
  ASSERT_TRUE(until([&] { return desk->status()->toolTip().contains("crashed"); }))
      << desk->status()->toolTip().toStdString();
}

TEST_F(ParticipantWindow, TellsWhyATrackerCannotBe) {
  const control::UdpPort taken("0.0.0.0", 0);
  ParticipantChoices choices = RememberedChoices();
  choices.source = recon::HeadSource::kFreeD;
  choices.port = taken.port();
  Make(choices);
  QSignalSpy failed(desk.get(), &ParticipantDesk::Failed);
  desk->Open();
  ASSERT_EQ(failed.count(), 1);
  EXPECT_TRUE(failed[0][0].toString().contains(QString::number(taken.port())));
  EXPECT_TRUE(desk->is_open());
}

TEST_F(ParticipantWindow, ChoicesAreKept) {
  Make(RememberedChoices());
  desk->ShowChoices();
  auto* dialog = window.findChild<ParticipantDialog*>();
  ASSERT_NE(dialog, nullptr);
  auto* source = dialog->findChild<QComboBox*>("participant_source");
  source->setCurrentIndex(source->findData(static_cast<int>(recon::HeadSource::kFreeD)));
  EXPECT_EQ(dialog->findChild<QSpinBox*>("participant_port")->value(), control::kFreeDPort);
  dialog->findChild<QDoubleSpinBox*>("participant_ipd")->setValue(58.0);
  auto* mode = dialog->findChild<QComboBox*>("participant_mode");
  mode->setCurrentIndex(mode->findData(static_cast<int>(control::ViewMode::kStereo)));
  const ParticipantChoices kept = RememberedChoices();
  EXPECT_EQ(kept.source, recon::HeadSource::kFreeD);
  EXPECT_EQ(kept.port, control::kFreeDPort);
  EXPECT_EQ(kept.eyes.mode, control::ViewMode::kStereo);
  EXPECT_EQ(kept.eyes.ipd_mm, 58.0);
}

TEST_F(ParticipantWindow, DamagedSettingsAreTheDefaults) {
  QSettings settings;
  settings.setValue("participant/source", "nose");
  settings.setValue("participant/ipd_mm", "nan");
  settings.setValue("participant/vertical_fov_rad", 1e9);
  settings.setValue("participant/port", -5);
  settings.setValue("participant/mode", 7);
  const ParticipantChoices choices = RememberedChoices();
  EXPECT_EQ(choices.source, recon::HeadSource::kFixed);
  EXPECT_EQ(choices.port, 1);
  choices.eyes.Validate();
}

// What a user works has a name for scripts, one for screen readers, and a tip.
TEST_F(ParticipantWindow, EveryChoiceIsNamed) {
  Make(RememberedChoices());
  desk->ShowChoices();
  const auto* dialog = window.findChild<ParticipantDialog*>();
  for (const char* name :
       {"participant_mode", "participant_camera", "participant_display", "participant_fills",
        "participant_fov", "participant_ipd", "participant_convergence", "participant_source",
        "participant_port", "participant_head_file", "participant_browse", "participant_open"}) {
    const auto* widget = dialog->findChild<QWidget*>(name);
    ASSERT_NE(widget, nullptr) << name;
    EXPECT_FALSE(widget->accessibleName().isEmpty()) << name;
    EXPECT_FALSE(widget->toolTip().isEmpty()) << name;
  }
}

}  // namespace
}  // namespace elbowroom::console
