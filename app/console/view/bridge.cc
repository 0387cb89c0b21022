#include "app/console/view/bridge.h"

#include <QCoreApplication>
#include <QEvent>
#include <utility>

namespace elbowroom::console {
namespace {

constexpr QEvent::Type kDelivery = QEvent::User;

}  // namespace

// The event carries nothing: what is handed over goes through the lock, which ThreadSanitizer can follow
// where it can't look into Qt.
void Bridge::Post(Delivery delivery) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(delivery));
  }
  QCoreApplication::postEvent(this, new QEvent(kDelivery));
}

void Bridge::PostLatest(Stream stream, Delivery delivery) {
  Delivery replaced;  // destroyed after the lock is released: freeing its content may take time
  {
    const std::lock_guard lock(mutex_);
    replaced = std::exchange(latest_[static_cast<std::size_t>(stream)], std::move(delivery));
  }
  if (replaced) return;  // its event is still on the way
  Post([this, stream] { DeliverLatest(stream); });
}

bool Bridge::event(QEvent* event) {
  if (event->type() != kDelivery) return QObject::event(event);
  Delivery delivery;
  {
    const std::lock_guard lock(mutex_);
    delivery = std::move(waiting_.front());
    waiting_.pop_front();
  }
  delivery();
  return true;
}

void Bridge::DeliverLatest(Stream stream) {
  Delivery delivery;
  {
    const std::lock_guard lock(mutex_);
    delivery = std::exchange(latest_[static_cast<std::size_t>(stream)], nullptr);
  }
  if (delivery) delivery();
}

}  // namespace elbowroom::console
