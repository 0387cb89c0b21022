// The trial page before, while and after a trial runs, with its panels and dialogs, looked at.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QListWidget>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSignalSpy>

#include "app/console/background_dialog.h"
#include "app/console/calibration_dialog.h"
#include "app/console/participant/participant_dialog.h"
#include "app/control/demo_trial.h"
#include "recon/rig_files/rig_file.h"
#include "tests/app/console/looks/tour.h"
#include "tests/app/console/procedure_trial.h"
#include "tests/support/places.h"

namespace elbowroom::console {
namespace {

namespace fs = std::filesystem;

const QStringList kNamesInDemo = {"pmt",      "payload_a", "payload_b", "payload_a_gap", "tongs",
                                  "overhead", "low",       "level",     "high"};

class TrialTour : public Tour {
 protected:
  TrialTour() {
    const control::TrialSetup demo = control::MakeDemoTrial(control::DemoPlay::kOnce);
    Know(kNamesInDemo);
    Know({QString::fromStdString(demo.info.task)});
    Know({"stopped by the experimenter"});  // the rooms below say so
  }

  // The last of its panel, which scrolls where there isn't room for all.
  void ExpectAllOfTheNoteLine() {
    const auto* note = Find<QLineEdit>("note");
    EXPECT_EQ(note->visibleRegion().boundingRect().height(), note->height());
  }
  void CloseDialogs() {
    for (auto* dialog : window_.findChildren<QDialog*>()) delete dialog;
  }
};

TEST_P(TrialTour, TheDemoIsAllThere) {
  Look("trial_start");
  Action("start_demo").trigger();
  AwaitFrames(6);
  ASSERT_TRUE(WaitUntil([&] { return last_frame_->pairs != nullptr; }));
  Look("trial_running");
  ExpectAllOfTheNoteLine();
  Action("section").trigger();
  window_.sights().findChild<QListWidget*>("section_list")->item(1)->setCheckState(Qt::Checked);
  constexpr double kLeansDeg = 25.0;
  window_.sights().findChild<QDoubleSpinBox*>("section_elevation")->setValue(kLeansDeg);
  AwaitFrames(3);
  Look("trial_section");
  Action("measure_faces").trigger();
  AwaitFrames(3);
  Look("trial_measure");
  Action("section").trigger();
  Action("measure_faces").trigger();
  Action("heat").trigger();
  AwaitFrames(3);
  Look("trial_heat");
  Action("heat").trigger();
  window_.sights().ShowCamera(1);
  AwaitFrames(3);
  Look("trial_camera");
  window_.sights().ShowScene();
  Action("participant_choices").trigger();
  Look("participant_dialog", *Find<ParticipantDialog>("participant_dialog"));
  window_.participant().Open();
  ASSERT_TRUE(WaitUntil([&] { return !window_.participant().view()->picture().isNull(); })) << Message();
  if (GetParam() == Inspection::kFit) Look("participant_view", *window_.participant().view());
  Look("participant_dialog_open", *Find<ParticipantDialog>("participant_dialog"));
  Look("trial_with_participant");
  window_.participant().Close();
  CloseDialogs();
  StopAndWait();
  Look("trial_stopped");
}

class ProcedureTour : public TrialTour {
 protected:
  ProcedureTour() {
    WriteProcedureTrial(folder_.path());
    Know({kProcedureLayout, kProcedureTrial, kProcedureQuestions, "cam", "closed", "slipped",
          QString::fromStdString(folder_.path().string())});
  }
};

TEST_P(ProcedureTour, IsAllThere) {
  Activate();
  window_.StartTrial(QString::fromStdString((folder_ / "trial.toml").string()));
  ASSERT_TRUE(WaitUntil([&] { return window_.preflight().rig().has_value(); }));
  Look("procedure_start");
  Click(Find<QPushButton>("begin_trial"));
  AwaitFrames(3);
  Find<QLineEdit>("bookmark_name")->setText("tongs slipped");
  Action("bookmark_action").trigger();
  Find<QLineEdit>("preset_name")->setText("closed");
  Click(Find<QPushButton>("save_preset"));
  Find<QDoubleSpinBox>("spacing_box:gap")->setValue(130.0);
  AwaitFrames(3);
  Look("procedure_running");
  ExpectAllOfTheNoteLine();
  Find<QDockWidget>("presets_panel")->raise();
  Look("procedure_presets");
  Action("next_step_action").trigger();
  StopAndWait();
  Look("procedure_after");
  Find<QPlainTextEdit>("after_notes")->setPlainText("slipped");
  Click(Find<QPushButton>("save_answers"));
  ASSERT_TRUE(WaitUntil([&] { return !window_.procedure().HasAnswers(); }));
  Look("procedure_saved");
}

TEST_P(ProcedureTour, PreflightAndBackgroundAreAllThere) {
  Action("show_preflight").trigger();
  Look("preflight_empty");
  recon::RigFile rig = recon::ReadRigFile(folder_ / "rig.yml");
  for (std::size_t i = 0; i < rig.sources.size(); ++i)
    rig.sources[i] = {.frames = fmt::format("v4l2:/dev/video9{}", i), .background = {}, .masks = {}};
  recon::WriteRigFile(rig, folder_ / "live.yml");
  Know({"live", "background", "ball"});
  window_.preflight().Open(folder_ / "live.yml");
  ASSERT_TRUE(WaitUntil([&] { return window_.preflight().CanCheck(); })) << Message();
  Look("preflight_unchecked");
  QSignalSpy checked(&window_.preflight(), &PreflightPanel::Checked);
  window_.preflight().Check(0.5);
  ASSERT_TRUE(WaitUntil([&] { return !checked.isEmpty(); }));
  if (GetParam() == Inspection::kFit) Look("preflight_checked");  // what a room below says
  BackgroundDialog dialog(rig, folder_ / "background", &window_);
  dialog.show();
  Look("background", dialog);
  QSignalSpy ended(&dialog, &BackgroundDialog::Ended);
  dialog.findChild<QDoubleSpinBox*>("background_countdown")->setValue(0.0);
  Click(dialog.findChild<QPushButton*>("background_start"));
  if (GetParam() == Inspection::kFit) Look("background_running", dialog);
  ASSERT_TRUE(WaitUntil([&] { return !ended.isEmpty(); }));
  if (GetParam() == Inspection::kFit) Look("background_failed", dialog);
}

TEST_P(TrialTour, TheCalibrationIsAllThere) {
  fs::copy(test_support::SourceFolder() / "docs/examples/first_rig", folder_.path(),
           fs::copy_options::recursive);
  Know({"CALIB.toml", "cam", "plumb_bob"});
  CalibrationDialog dialog(folder_ / "CALIB.toml", folder_ / "rig.yml", &window_);
  QSignalSpy ended(&dialog, &CalibrationDialog::Ended);
  dialog.show();
  ASSERT_TRUE(WaitUntil([&] { return !ended.isEmpty(); }));
  Look("calibration", dialog);
}

INSTANTIATE_TEST_SUITE_P(Looks, TrialTour, testing::Values(Inspection::kFit, Inspection::kWords),
                         InspectionName);
INSTANTIATE_TEST_SUITE_P(Looks, ProcedureTour, testing::Values(Inspection::kFit, Inspection::kWords),
                         InspectionName);

}  // namespace
}  // namespace elbowroom::console
