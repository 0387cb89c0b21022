#include "app/console/window_picture.h"

#include <QPixmap>
#include <QTimer>
#include <algorithm>
#include <chrono>
#include <utility>

namespace elbowroom::console {
namespace {

// The operator's view follows the lists by as long as a picture takes to draw; the window is taken once it
// has caught up.
constexpr std::chrono::milliseconds kViewCatchesUp(600);

bool HasContact(const control::FrameResult& result) {
  return std::any_of(result.contacts.begin(), result.contacts.end(), [](const core::PartContact& contact) {
    return contact.verdict == core::Verdict::kContact;
  });
}

}  // namespace

WindowPicture::WindowPicture(PictureOrder order, TrialDesk& desk, QWidget* window)
    : QObject(window), order_(std::move(order)), desk_(desk), window_(window) {
  connect(&desk, &TrialDesk::FrameArrived, this, [this](const FrameNews& news) { Look(*news.result); });
}

void WindowPicture::Look(const control::FrameResult& result) {
  const auto& spacings = result.layout->spacings;
  if (order_.spacing_mm && !spacings.empty()) {
    desk_.SetSpacing(spacings.front().name, *std::exchange(order_.spacing_mm, std::nullopt));
  }
  if (is_due_ || result.time_s < order_.after_s || (order_.wants_contact && !HasContact(result))) return;
  is_due_ = true;
  QTimer::singleShot(kViewCatchesUp, this, &WindowPicture::Take);
}

void WindowPicture::Take() {
  const QString path = QString::fromStdString(order_.png.string());
  const bool is_written = window_->grab().save(path, "PNG");
  emit Taken(is_written ? QString() : path + ": can't be written; choose another file for the picture");
}

}  // namespace elbowroom::console
