// Where a trial is started, watched, stopped and reported on: the console without its widgets.
#pragma once

#include <QObject>
#include <QString>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/control/episode_tally.h"
#include "app/control/frame_result.h"
#include "app/control/layers/heat_watch.h"
#include "app/control/tiles/tile_maker.h"
#include "app/control/trial_setup.h"
#include "app/control/trial_thread.h"

namespace elbowroom::console {

enum class DeskState { kIdle, kReading, kRunning, kReporting };

struct FrameNews {
  control::SharedFrameResult result;
  std::vector<control::PartTally> tallies;  // over every frame so far, shown or not
  control::RecordedFrames recorded;         // so far
};

// One trial at a time. Nothing here waits: long work runs on threads of its own, whose news arrive as
// signals. Thread: UI.
class TrialDesk : public QObject {
  Q_OBJECT

 public:
  using SetupReader =
      std::function<control::TrialSetup(const std::stop_token&)>;  // runs on a worker; may throw

  explicit TrialDesk(QObject* parent = nullptr) : QObject(parent) {}
  ~TrialDesk() override;

  [[nodiscard]] DeskState state() const { return state_; }
  [[nodiscard]] bool is_stopping() const { return is_stopping_; }
  [[nodiscard]] bool can_report() const { return state_ == DeskState::kIdle && recorded_.has_value(); }

  // The session of the running trial, or else of the last one that recorded a frame.
  [[nodiscard]] const std::filesystem::path& session() const { return session_; }

  // The TRIAL.toml of the trial that was started last; empty: it has none.
  [[nodiscard]] const std::filesystem::path& trial_file() const { return trial_file_; }

  // Somebody else has the cameras: no trial should be started.
  [[nodiscard]] bool are_cameras_taken() const { return are_cameras_taken_; }
  void SetCamerasTaken(bool are_taken);

  // Reads a trial, then runs it at the pace at which its frames were taken, recording into `session`.
  // The desk is idle.
  void Start(SetupReader read_setup, const std::filesystem::path& session,
             const std::filesystem::path& trial_file = {});

  // The last trial's report, into the folder SESSION-report beside the session. can_report() holds.
  void WriteReport();

  // Ends what is under way in order: a trial's session is complete up to there, a report is given up.
  void Stop();

  // Take effect with the trial's next frame; without a trial, they do nothing.
  void SetSpacing(const std::string& spacing, double to_mm);
  void MarkTool(const std::string& tool, bool in_use);
  void AddNote(const QString& note);
  void BeginStep(const std::string& step);  // ends the one under way; empty: begins none
  void SetBookmark(const std::string& name);

  // Whether somebody looks at where parts were touched: in the trial under way, or in the last one.
  void SetHeatWanted(bool is_wanted);

  // What the cameras' tiles show, and how large.
  void SetTileWishes(const control::TileWishes& wishes);

 signals:
  void StateChanged();
  void TrialOpened(const elbowroom::control::TrialSetup& setup);
  void HullArrived(const elbowroom::control::SharedHull& hull);  // of a frame that is being judged
  void FrameArrived(const elbowroom::console::FrameNews& news);
  void HeatArrived(const elbowroom::control::SharedHeatLayer& heat);  // while it is wanted
  void TilesArrived(const elbowroom::control::SharedTiles& tiles);
  // The place where frames are recorded has changed; is_well: they go into the session file.
  void RecordingChanged(bool is_well, const QString& line);
  // A camera was turned or moved while the trial runs; the line says which, and what to do.
  void CameraKnocked(const QString& line);
  void TrialEnded(const QString& note);
  void ReportWritten(const QString& html_file);
  void Progressed(qint64 done, qint64 total, const QString& what);  // total <= 0: not known
  void Failed(const QString& line);

 private:
  void Run(control::TrialSetup setup, const std::filesystem::path& session);
  void FinishTrial(const control::TrialThread::Ended& ended);
  void FinishReport(const std::string& error, const QString& html_file);
  void EnterState(DeskState state);
  [[nodiscard]] core::Progress ProgressToHere();

  DeskState state_ = DeskState::kIdle;
  bool is_stopping_ = false;
  bool are_cameras_taken_ = false;
  std::filesystem::path session_, trial_file_;
  control::TileWishes tile_wishes_;
  bool is_heat_wanted_ = false;
  std::atomic<bool> has_frames_ = false;           // of the trial under way, or the last one
  std::optional<std::filesystem::path> recorded_;  // can be reported on
  Bridge bridge_;                                  // before the threads that post to it
  std::unique_ptr<BackgroundJob> job_;
  std::unique_ptr<control::TileMaker> tiles_;  // before the trial that hands it frames
  std::unique_ptr<control::HeatWatch> heat_;   // likewise; of the last trial, when none runs
  std::unique_ptr<control::TrialThread> trial_;
};

}  // namespace elbowroom::console
