// The window's lower edge: where the trial is, how long each frame took, and what was skipped.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QStatusBar>
#include <filesystem>

#include "app/console/frame_rate.h"
#include "app/control/frame_result.h"
#include "app/control/frame_time_tally.h"
#include "app/control/trial_runner.h"

namespace elbowroom::console {

// Thread: UI.
class StatusLine : public QStatusBar {
 public:
  explicit StatusLine(QWidget* parent = nullptr);

  void Open(const std::filesystem::path& session);
  void ShowFrame(const control::FrameResult& result, const control::RecordedFrames& recorded);
  void ShowPicture(double drawing_ms, const QString& driver);
  void ShowAge(double age_ms);  // of the operator's picture when it was painted; live cameras only
  void ShowProgress(qint64 done, qint64 total, const QString& what);  // total <= 0: not known, not shown
  void HideProgress() { SetProgressVisible(false); }
  // A field at the right edge that somebody else fills, shows and hides.
  void AddGuest(QWidget* guest);
  [[nodiscard]] const control::FrameTimeTally& ages() const { return ages_; }
  [[nodiscard]] QSize minimumSizeHint() const override;  // it gives way to the window, which may be small

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  // Shows as many fields as there is room for, the most important first.
  void FitFields();
  void SetProgressVisible(bool is_visible);
  QLabel* AddField(const QString& name, int stretch);

  QLabel* frame_ = nullptr;
  QLabel* recorded_ = nullptr;
  QLabel* times_ = nullptr;
  QLabel* age_ = nullptr;
  QLabel* skipped_ = nullptr;
  QLabel* session_ = nullptr;
  QLabel* driver_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QWidget* guest_ = nullptr;
  double picture_ms_ = 0.0;
  FrameRate rate_;
  control::FrameTimeTally ages_;  // of this trial's pictures
};

}  // namespace elbowroom::console
