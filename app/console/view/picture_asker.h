// Pictures for a 3-D view: asked for one at a time, as fine as there is time for.
#pragma once

#include <QElapsedTimer>
#include <QImage>
#include <QString>
#include <QTimer>
#include <QWidget>
#include <functional>
#include <optional>

#include "app/console/view/bridge.h"
#include "app/console/view/picture_pace.h"
#include "app/control/render_worker.h"

namespace elbowroom::console {

// The picture's pixels, copied, in the format that Qt paints fastest.
[[nodiscard]] QImage QtImageOf(const recon::Image& image);

// Never waits: what is asked for while a picture is drawn is drawn after it. Pictures are as fine as
// PicturePace allows; when nothing was asked for during a while, the last one is drawn once more in full.
// Thread: UI.
class PictureAsker {
 public:
  struct Answers {
    // What to draw now, in a picture of that size; nothing: there is nothing to draw.
    std::function<std::optional<control::RenderRequest>(const QSize& size, const PictureFineness& fineness)>
        request;
    // False: the picture is of something that is over; another one is asked for.
    std::function<bool(const QImage& picture, const control::RenderRequest& request)> take;
    std::function<void(double drawing_ms)> shown;     // after take() and, maybe, the next request
    std::function<void(const QString& line)> failed;  // one line, told once until a picture succeeds
  };

  // `view`: whose size the pictures have.
  PictureAsker(const QWidget& view, Answers answers);

  void Ask();
  void Forget() { is_outdated_ = false; }  // what was asked for while a picture is drawn
  void BeginPace() { pace_ = PicturePace(); }
  [[nodiscard]] bool is_drawing() const { return drawing_.isValid(); }
  [[nodiscard]] QSize LargestPicture() const;
  [[nodiscard]] control::RenderWorker& worker() { return worker_; }
  [[nodiscard]] const control::RenderWorker& worker() const { return worker_; }

 private:
  void Submit(const PictureFineness& fineness);
  void Take(const QImage& picture, const control::RenderRequest& request);
  void Fail(const QString& line);

  const QWidget& view_;
  Answers answers_;
  PicturePace pace_;
  PictureFineness drawn_with_;  // the picture asked for last
  QElapsedTimer drawing_;       // valid while a picture is asked for
  bool is_outdated_ = false;    // whether the picture that is being drawn is
  QTimer rest_;
  QString last_error_;  // told once, until a picture succeeds
  Bridge bridge_;       // before the thread that posts to it
  control::RenderWorker worker_;
};

}  // namespace elbowroom::console
