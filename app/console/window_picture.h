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
  bool wants_contact = false;        // wait for a frame with a contact
};

// Takes the picture as soon as the operator's view shows a frame that is as ordered.
// Thread: UI.
class WindowPicture : public QObject {
  Q_OBJECT

 public:
  WindowPicture(PictureOrder order, MainWindow& window);

 signals:
  void Taken(const QString& error);  // once; "" when the file was written

 private:
  void Look(const control::FrameResult& result);
  void TakeIfDue(qint64 shown_frame);
  void Finish(const QString& error);

  PictureOrder order_;
  MainWindow& window_;
  std::optional<qint64> due_frame_;  // the first frame of the present run of frames that are as ordered
};

}  // namespace elbowroom::console
