// A picture of the window at work, for the documentation.
#pragma once

#include <QObject>
#include <QWidget>
#include <filesystem>
#include <optional>
#include <string>

#include "app/console/trial_desk.h"

namespace elbowroom::console {

struct PictureOrder {
  std::filesystem::path png;
  double after_s = 0.0;              // the trial's time
  std::optional<double> spacing_mm;  // set the layout's first spacing to this when the trial begins
  bool wants_contact = false;        // wait on for a frame in which something is touched
};

// Takes the picture as soon as the trial has come to what was ordered, then ends the trial. Thread: UI.
class WindowPicture : public QObject {
  Q_OBJECT

 public:
  WindowPicture(PictureOrder order, TrialDesk& desk, QWidget* window);

 signals:
  void Taken(const QString& error);  // "" when the file was written

 private:
  void Look(const control::FrameResult& result);
  void Take();

  PictureOrder order_;
  TrialDesk& desk_;
  QWidget* window_;
  bool is_due_ = false;
};

}  // namespace elbowroom::console
