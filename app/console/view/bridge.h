// The one way from worker threads to the UI thread.
#pragma once

#include <QObject>
#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>

namespace elbowroom::console {

// What is posted runs later on the thread that the bridge lives on, and not at all once the bridge is gone.
// The owner of a bridge ends the threads that post to it first. Thread: any may post; nothing ever waits.
class Bridge : public QObject {
 public:
  using Delivery = std::function<void()>;  // must not throw

  // A stream keeps only its latest delivery, so that they don't pile up when the UI is slow.
  enum class Stream { kHull, kFrame, kPicture, kTiles, kHeat, kProgress };

  explicit Bridge(QObject* parent = nullptr) : QObject(parent) {}

  // Every delivery arrives, in order.
  void Post(Delivery delivery);

  // Takes the place of the stream's delivery that hasn't run yet, if there is one.
  void PostLatest(Stream stream, Delivery delivery);

 protected:
  bool event(QEvent* event) override;

 private:
  static constexpr std::size_t kStreams = 6;
  void DeliverLatest(Stream stream);

  std::mutex mutex_;
  std::deque<Delivery> waiting_;  // an event is on the way for each
  std::array<Delivery, kStreams> latest_;
};

}  // namespace elbowroom::console
