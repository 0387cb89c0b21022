#include "app/console/window_picture.h"

#include <QPixmap>
#include <algorithm>
#include <utility>

namespace elbowroom::console {
namespace {

bool HasContact(const control::FrameResult& result) {
  return std::any_of(
      result.record.contacts.begin(), result.record.contacts.end(),
      [](const core::PartContact& contact) { return contact.verdict == core::Verdict::kContact; });
}

}  // namespace

WindowPicture::WindowPicture(PictureOrder order, MainWindow& window)
    : QObject(&window), order_(std::move(order)), window_(window) {
  connect(&window.desk(), &TrialDesk::FrameArrived, this,
          [this](const FrameNews& news) { Look(*news.result); });
  connect(&window.view(), &OperatorView::PictureShown, this, &WindowPicture::TakeIfDue);
  // Without a trial there is no picture to wait for.
  connect(&window.desk(), &TrialDesk::Failed, this, &WindowPicture::Finish);
  connect(&window.desk(), &TrialDesk::TrialEnded, this, [this] {
    Finish(tr("The trial ended before a frame was as ordered: ask for an earlier picture"));
  });
}

void WindowPicture::Look(const control::FrameResult& result) {
  const auto& spacings = result.layout->spacings;
  if (order_.spacing_mm && !spacings.empty()) {
    window_.desk().SetSpacing(spacings.front().name, *std::exchange(order_.spacing_mm, std::nullopt));
    return;  // this frame was judged before the gap is set
  }
  const bool is_as_ordered =
      result.record.time_s >= order_.after_s && (!order_.wants_contact || HasContact(result));
  if (!is_as_ordered) {
    due_frame_.reset();
  } else if (!due_frame_) {
    due_frame_ = result.record.frame;
  }
}

void WindowPicture::TakeIfDue(qint64 shown_frame) {
  if (!due_frame_ || shown_frame < *due_frame_) return;
  const QString path = QString::fromStdString(order_.png.string());
  const bool is_written = window_.grab().save(path, "PNG");
  Finish(is_written ? QString() : path + ": can't be written; choose another file for the picture");
}

void WindowPicture::Finish(const QString& error) {
  disconnect(&window_.view(), nullptr, this, nullptr);  // one picture
  disconnect(&window_.desk(), nullptr, this, nullptr);
  emit Taken(error);
}

}  // namespace elbowroom::console
