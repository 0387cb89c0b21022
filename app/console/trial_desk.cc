#include "app/console/trial_desk.h"

#include <utility>

#include "app/control/report/session_report.h"
#include "app/control/trial_runner.h"
#include "app/control/watch/knock_watch.h"
#include "core/error.h"

namespace elbowroom::console {
namespace {

QString EndNote(const control::TrialOutcome& outcome) {
  QString note = TrialDesk::tr("%1 frames recorded in %2")
                     .arg(outcome.frames)
                     .arg(QString::fromStdString(outcome.session.filename().string()));
  if (!outcome.end_note.empty()) note += ": " + QString::fromStdString(outcome.end_note);
  return note;
}

}  // namespace

TrialDesk::~TrialDesk() = default;

void TrialDesk::Start(SetupReader read_setup, const std::filesystem::path& session,
                      const std::filesystem::path& trial_file) {
  core::Require(state_ == DeskState::kIdle, "a trial starts on an idle desk");
  trial_file_ = trial_file;
  EnterState(DeskState::kReading);
  auto setup = std::make_shared<control::TrialSetup>();
  job_ = std::make_unique<BackgroundJob>(
      bridge_,
      [read_setup = std::move(read_setup), setup](const std::stop_token& stop) { *setup = read_setup(stop); },
      [this, setup, session](const std::string& error) {
        if (error.empty() && !is_stopping_) return Run(std::move(*setup), session);
        const bool was_stopped = is_stopping_;
        EnterState(DeskState::kIdle);
        if (!was_stopped) emit Failed(QString::fromStdString(error));
      });
}

void TrialDesk::Run(control::TrialSetup setup, const std::filesystem::path& session) {
  session_ = session;
  recorded_.reset();
  has_frames_ = false;
  emit TrialOpened(setup);
  control::TrialOptions options;
  options.session = session_;
  options.at_capture_rate = true;
  options.progress = ProgressToHere();
  auto tally = std::make_shared<control::EpisodeTally>(setup.layout.parts.size());
  tiles_ = std::make_unique<control::TileMaker>(setup.source, [this](const control::SharedTiles& tiles) {
    bridge_.PostLatest(Bridge::Stream::kTiles, [this, tiles] { emit TilesArrived(tiles); });
  });
  tiles_->Wish(tile_wishes_);
  std::vector<core::SharedMesh> meshes;
  for (const core::Part& part : setup.layout.parts) meshes.push_back(part.mesh);
  heat_ =
      std::make_unique<control::HeatWatch>(std::move(meshes), [this](const control::SharedHeatLayer& heat) {
        bridge_.PostLatest(Bridge::Stream::kHeat, [this, heat] { emit HeatArrived(heat); });
      });
  heat_->Want(is_heat_wanted_);
  options.heat = heat_.get();
  options.on_light = [tiles = tiles_.get()](const recon::LightReport& report) { tiles->AddLight(report); };
  options.on_frame = [this, tally, tiles = tiles_.get()](const control::SharedFrameResult& result,
                                                         const control::RecordedFrames& recorded) {
    tally->Add(*result);
    tiles->Add(result);
    has_frames_ = true;
    bridge_.PostLatest(Bridge::Stream::kFrame, [this, news = FrameNews{result, tally->Parts(), recorded}] {
      emit FrameArrived(news);
    });
  };
  options.on_recording = [this](const sessions::RecordingNews& news) {
    bridge_.Post([this, is_well = news.state == sessions::RecordingState::kInFile,
                  line = QString::fromStdString(news.line)] { emit RecordingChanged(is_well, line); });
  };
  options.on_knock = [this](const control::KnockReport& report) {
    bridge_.Post([this, line = QString::fromStdString(report.advice)] { emit CameraKnocked(line); });
  };
  options.on_hull = [this](const control::SharedHull& hull) {
    bridge_.PostLatest(Bridge::Stream::kHull, [this, hull] { emit HullArrived(hull); });
  };
  EnterState(DeskState::kRunning);
  trial_ = std::make_unique<control::TrialThread>(std::move(setup), std::move(options),
                                                  [this](const control::TrialThread::Ended& ended) {
                                                    bridge_.Post([this, ended] { FinishTrial(ended); });
                                                  });
}

void TrialDesk::FinishTrial(const control::TrialThread::Ended& ended) {
  trial_.reset();  // its thread has nothing left to do
  tiles_.reset();
  if (ended.outcome) session_ = ended.outcome->session;
  if (has_frames_) recorded_ = session_;  // a trial that failed keeps what it recorded
  EnterState(DeskState::kIdle);
  if (ended.outcome) {
    emit TrialEnded(EndNote(*ended.outcome));
  } else {
    emit Failed(QString::fromStdString(ended.error));
  }
}

void TrialDesk::WriteReport() {
  core::Require(can_report(), "a report needs a recorded session and an idle desk");
  EnterState(DeskState::kReporting);
  auto html_file = std::make_shared<QString>();
  job_ = std::make_unique<BackgroundJob>(
      bridge_,
      [session = *recorded_, progress = ProgressToHere(), html_file](const std::stop_token& stop) {
        const control::ReportFiles files =
            control::WriteSessionReport(session, control::ReportFolderFor(session), progress, stop);
        for (const std::filesystem::path& file : files.written) {
          if (file.extension() == ".html") *html_file = QString::fromStdString(file.string());
        }
      },
      [this, html_file](const std::string& error) { FinishReport(error, *html_file); });
}

void TrialDesk::FinishReport(const std::string& error, const QString& html_file) {
  const bool was_stopped = is_stopping_;
  EnterState(DeskState::kIdle);
  if (error.empty()) {
    emit ReportWritten(html_file);
  } else if (was_stopped) {
    emit TrialEnded(tr("The report was not written: cancelled"));
  } else {
    emit Failed(QString::fromStdString(error));
  }
}

void TrialDesk::Stop() {
  if (state_ == DeskState::kIdle || is_stopping_) return;
  is_stopping_ = true;
  if (trial_) {
    trial_->Stop();
  } else {
    job_->Cancel();
  }
  emit StateChanged();
}

void TrialDesk::SetSpacing(const std::string& spacing, double to_mm) {
  if (trial_) trial_->controls().SetSpacing(spacing, to_mm);
}

void TrialDesk::MarkTool(const std::string& tool, bool in_use) {
  if (trial_) trial_->controls().MarkTool(tool, in_use);
}

void TrialDesk::AddNote(const QString& note) {
  if (trial_) trial_->controls().AddNote(note.toStdString());
}

void TrialDesk::BeginStep(const std::string& step) {
  if (trial_) trial_->controls().BeginStep(step);
}

void TrialDesk::SetBookmark(const std::string& name) {
  if (trial_) trial_->controls().SetBookmark(name);
}

void TrialDesk::SetTileWishes(const control::TileWishes& wishes) {
  tile_wishes_ = wishes;
  if (tiles_) tiles_->Wish(wishes);
}

void TrialDesk::SetHeatWanted(bool is_wanted) {
  is_heat_wanted_ = is_wanted;
  if (heat_) heat_->Want(is_wanted);
}

void TrialDesk::SetCamerasTaken(bool are_taken) {
  are_cameras_taken_ = are_taken;
  emit StateChanged();
}

void TrialDesk::EnterState(DeskState state) {
  state_ = state;
  is_stopping_ = false;
  emit StateChanged();
}

core::Progress TrialDesk::ProgressToHere() {
  return core::Progress([this](std::int64_t done, std::int64_t total, const std::string& what) {
    bridge_.PostLatest(Bridge::Stream::kProgress, [this, done, total, text = QString::fromStdString(what)] {
      emit Progressed(done, total, text);
    });
  });
}

}  // namespace elbowroom::console
