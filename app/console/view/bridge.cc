#include "app/console/view/bridge.h"

#include <utility>

namespace elbowroom::console {

void Bridge::Post(Delivery delivery) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(delivery));
  }
  QMetaObject::invokeMethod(
      this, [this] { DeliverNext(); }, Qt::QueuedConnection);
}

void Bridge::DeliverNext() {
  Delivery delivery;
  {
    const std::lock_guard lock(mutex_);
    delivery = std::move(waiting_.front());
    waiting_.pop_front();
  }
  delivery();
}

void Bridge::PostLatest(Stream stream, Delivery delivery) {
  Delivery replaced;  // destroyed after the lock is released: freeing its content may take time
  {
    const std::lock_guard lock(mutex_);
    replaced = std::exchange(latest_[static_cast<std::size_t>(stream)], std::move(delivery));
  }
  if (replaced) return;  // its event is still on the way
  QMetaObject::invokeMethod(
      this, [this, stream] { DeliverLatest(stream); }, Qt::QueuedConnection);
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
