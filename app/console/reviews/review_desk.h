// A session under review without its widgets: what is open, which frame is shown, what is tried and written.
#pragma once

#include <QObject>
#include <QString>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "app/console/view/bridge.h"
#include "app/control/layers/heat_layer.h"
#include "app/control/reviewing/frame_scrubber.h"
#include "app/control/reviewing/latest_task.h"
#include "app/control/reviewing/listed_findings.h"
#include "app/control/reviewing/needed_gap.h"
#include "app/control/reviewing/reviewed_session.h"
#include "app/control/reviewing/session_timeline.h"
#include "app/control/reviewing/what_if.h"
#include "core/progress.h"

namespace elbowroom::console {

// One session at a time, and one job beside the frames and the what-if: opening, remarks, report, ... Nothing
// here waits; news come as signals. Thread: UI.
class ReviewDesk : public QObject {
  Q_OBJECT

 public:
  explicit ReviewDesk(QObject* parent = nullptr) : QObject(parent) {}
  ~ReviewDesk() override;

  // Gives up any job. The session that is open stays open if the new one can't be opened.
  void Open(const std::filesystem::path& session);
  [[nodiscard]] bool is_open() const { return session_ != nullptr; }
  [[nodiscard]] bool is_busy() const { return is_busy_; }  // with a job

  // All below: is_open() holds.
  [[nodiscard]] const control::ReviewedSession& session() const { return *session_; }
  [[nodiscard]] const std::vector<control::ListedFinding>& findings() const { return findings_; }
  [[nodiscard]] const control::SessionTimeline& timeline() const { return timeline_; }

  void Show(std::size_t position);  // of the session's frames; beyond the last: the last
  [[nodiscard]] std::size_t position() const { return position_; }

  // Judges the frame that is shown at these gaps, then the whole motion. Empty: as it was recorded.
  void Hold(control::HeldGaps held_mm);
  [[nodiscard]] const control::HeldGaps& held_mm() const { return held_mm_; }
  // At the gaps held; nothing: none are, or the motion is being judged.
  [[nodiscard]] const std::optional<control::WhatIf>& what_if() const { return what_if_; }

  // Makes the layer of where parts were touched, in all of the session as it was recorded; HeatFound follows.
  void FindHeat();

  // Jobs. Where another one is under way, they do nothing but say so.
  void Say(const core::FindingId& finding, const core::ReviewRemark& remark);
  void ImportBcf(const std::filesystem::path& file);
  void ExportBcf(const std::filesystem::path& file);
  void WriteReport();  // into the folder SESSION-report beside the session
  void WriteKeepOut(double edge_mm, const std::filesystem::path& file);
  void FindNeededGap(const std::string& spacing);
  void CancelJob();

 signals:
  void StateChanged();
  void Opened();
  void FrameArrived(const elbowroom::control::ScrubbedFrame& frame);
  void HeatFound(const elbowroom::control::SharedHeatLayer& heat);
  void WhatIfProgressed(qint64 done, qint64 total);
  void WhatIfArrived();  // what_if() has changed
  void FindingsChanged();
  void NeededGapFound(const QString& spacing, const elbowroom::control::NeededGap& needed);
  void Progressed(qint64 done, qint64 total, const QString& what);  // of the job; total <= 0: not known
  void ReportWritten(const QString& html_file);
  void Noted(const QString& line);
  void Failed(const QString& line);

 private:
  using Work = std::function<void(const core::Progress& progress, const std::stop_token& stop)>;
  void RunJob(Work work, std::function<void()> on_done);
  void TryJob(Work work, std::function<void()> on_done);
  void FinishJob(std::int64_t job, const std::exception_ptr& failure, const std::function<void()>& on_done);
  void TakeSession(std::shared_ptr<control::ReviewedSession> session);
  void TakeFindings();
  void AskForFrame();
  void JudgeMotion();

  std::shared_ptr<control::ReviewedSession> session_;  // null: none is open
  std::vector<control::ListedFinding> findings_;
  control::SessionTimeline timeline_;
  std::size_t position_ = 0;
  control::HeldGaps held_mm_;
  std::optional<control::WhatIf> what_if_;
  control::SharedHeatLayer heat_;  // null: nobody asked for it yet
  std::int64_t asked_ = 0;         // counts the what-ifs: answers to earlier ones are dropped
  std::int64_t jobs_ = 0;          // counts jobs, likewise
  bool is_busy_ = false;
  std::stop_source job_stop_;  // of the job under way, also of one that hasn't begun
  Bridge bridge_;              // before the threads that post to it
  std::shared_ptr<control::FrameScrubber> scrubber_;
  control::LatestTask motion_thread_;
  control::LatestTask job_thread_;
  control::LatestTask heat_thread_;
};

}  // namespace elbowroom::console
