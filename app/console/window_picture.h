// A picture of the window at work, for the documentation.
#pragma once

#include <QObject>
#include <filesystem>
#include <optional>
#include <string>

#include "app/console/main_window.h"

namespace elbowroom::console {

struct PictureOrder {
  std::filesystem::path png;
  double after_s = 0.0;              // the trial's time
  std::optional<double> spacing_mm;  // set the layout's first spacing to this when the trial begins
  bool wants_contact = false;        // wait on for a frame in which something is touched
};

// Takes the picture as soon as the trial, and the operator's view of it, have come to what was ordered.
// Thread: UI.
class WindowPicture : public QObject {
  Q_OBJECT

 public:
  WindowPicture(PictureOrder order, MainWindow& window);

 signals:
  void Taken(const QString& error);  // "" when the file was written

 private:
  void Look(const control::FrameResult& result);
  void TakeIfDue(qint64 shown_frame);

  PictureOrder order_;
  MainWindow& window_;
  std::optional<qint64> due_frame_;  // the first frame that is as ordered, while frames stay so
};

}  // namespace elbowroom::console
