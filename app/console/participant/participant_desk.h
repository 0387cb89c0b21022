// The participant's view as a whole: window, choices, tracker and the thread that draws.
#pragma once

#include <QAction>
#include <QElapsedTimer>
#include <QLabel>
#include <QMenu>
#include <QObject>
#include <QTimer>
#include <array>
#include <memory>
#include <optional>

#include "app/console/participant/head_camera_dialog.h"
#include "app/console/participant/participant_dialog.h"
#include "app/console/participant/participant_view.h"
#include "app/console/view/bridge.h"
#include "app/control/frame_time_tally.h"
#include "app/control/head/head_tracker.h"
#include "app/control/head/headset_screen.h"
#include "app/control/participant/participant_pictures.h"
#include "core/rig.h"

namespace elbowroom::console {

// Nothing runs until the window is opened, and nothing any more when it is closed. Thread: UI.
class ParticipantDesk : public QObject {
  Q_OBJECT

 public:
  explicit ParticipantDesk(QWidget* window);
  ~ParticipantDesk() override;

  [[nodiscard]] QMenu* menu() { return menu_; }
  // For the operator's status: which tracker, how old pictures are, how much was refused.
  [[nodiscard]] QLabel* status() { return status_; }

  void OpenTrial(const core::Rig& rig);  // the cameras that see a cap
  void ShowFrame(control::SharedFrameResult result);
  void SetLook(const control::SceneLook& look);

  void Open();
  void Close();
  void ShowChoices();
  void RegisterHeadCamera();  // opens the dialog for it

  [[nodiscard]] bool is_open() const { return view_ != nullptr; }
  [[nodiscard]] ParticipantView* view() { return view_.get(); }
  [[nodiscard]] const control::HeadTracker* tracker() const { return tracker_.get(); }
  // Of all pictures since the window was opened: from the pose to the screen.
  [[nodiscard]] const control::FrameTimeTally& ages() const { return ages_; }

 signals:
  void Failed(const QString& line);

 private:
  void TakeChoices();
  void TakeInstant();
  [[nodiscard]] recon::HeadCamera SavedHeadCamera();
  [[nodiscard]] control::HeadSettings FixedHead() const;
  void StartTracker();
  void AskForPictures();
  void ShowPicture(const control::ParticipantPicture& picture);
  void ShowState();
  [[nodiscard]] QString StateText() const;
  [[nodiscard]] bool ShowsInHeadset() const;

  QWidget* window_;
  ParticipantChoices choices_;
  QMenu* menu_;     // owned by Qt, as these
  QAction* shows_;  // checked while the window is open
  QLabel* status_;
  ParticipantDialog* dialog_ = nullptr;
  HeadCameraDialog* registering_ = nullptr;
  recon::HeadCamera head_camera_;  // of the head file
  QTimer watch_;                   // of tracking
  std::optional<core::Rig> rig_;
  control::SharedFrameResult result_;
  control::SceneLook look_;
  control::FrameTimeTally ages_;
  std::optional<double> age_ms_;  // of the picture painted last
  std::int64_t accepted_before_ = 0;
  double poses_per_s_ = 0.0;
  QElapsedTimer since_count_;
  std::unique_ptr<ParticipantView> view_;
  std::shared_ptr<control::HeadsetScreen> headset_ = std::make_shared<control::HeadsetScreen>();
  std::array<int, 2> headset_px_{};  // an eye's picture, as it was asked for
  Bridge bridge_;                    // before the threads that post to it
  std::unique_ptr<control::ParticipantPictures> pictures_;
  std::unique_ptr<control::HeadTracker> tracker_;  // posts to pictures_
};

}  // namespace elbowroom::console
