// Values between threads, at most `capacity` of them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "core/error.h"

namespace elbowroom::core {

enum class WhenFull {
  kBlock,       // the producer waits: nothing is lost (session writer)
  kDropOldest,  // the producer never waits: the latest wins (console)
};

// Thread: any number of producers and consumers.
template <typename T>
class BoundedQueue {
 public:
  BoundedQueue(std::size_t capacity, WhenFull when_full) : capacity_(capacity), when_full_(when_full) {
    Require(capacity > 0, "a queue holds at least one value");
  }

  // False if the queue is closed (the value is dropped). kBlock: waits for room or for Close().
  bool Push(T value) {
    std::unique_lock lock(mutex_);
    if (when_full_ == WhenFull::kBlock) {
      has_room_.wait(lock, [&] { return closed_ || values_.size() < capacity_; });
    }
    if (closed_) return false;
    if (values_.size() == capacity_) {
      values_.pop_front();
      ++dropped_;
    }
    values_.push_back(std::move(value));
    lock.unlock();
    has_value_.notify_one();
    return true;
  }

  // Adds the value only if no other value waits. False: it was not added.
  bool PushIfEmpty(T value) {
    {
      const std::lock_guard lock(mutex_);
      if (closed_ || !values_.empty()) return false;
      values_.push_back(std::move(value));
    }
    has_value_.notify_one();
    return true;
  }

  // Adds the value only if there is room for it; never waits. False: it was not added.
  bool PushIfRoom(T value) {
    {
      const std::lock_guard lock(mutex_);
      if (closed_ || values_.size() >= capacity_) return false;
      values_.push_back(std::move(value));
    }
    has_value_.notify_one();
    return true;
  }

  // Waits for a value. Nothing: the queue is closed and empty.
  [[nodiscard]] std::optional<T> Pop() {
    std::unique_lock lock(mutex_);
    has_value_.wait(lock, [&] { return closed_ || !values_.empty(); });
    return TakeFront(lock);
  }

  // The same, but waits no longer than until `deadline`. Nothing: no value came in time, or the queue is
  // closed and empty.
  [[nodiscard]] std::optional<T> PopUntil(std::chrono::steady_clock::time_point deadline) {
    std::unique_lock lock(mutex_);
    has_value_.wait_until(lock, deadline, [&] { return closed_ || !values_.empty(); });
    return TakeFront(lock);
  }

  [[nodiscard]] std::optional<T> TryPop() {
    std::unique_lock lock(mutex_);
    return TakeFront(lock);
  }

  // No more values come in; those inside can still be taken.
  void Close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    has_value_.notify_all();
    has_room_.notify_all();
  }

  [[nodiscard]] bool is_closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

  [[nodiscard]] std::size_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  [[nodiscard]] std::optional<T> TakeFront(std::unique_lock<std::mutex>& lock) {
    if (values_.empty()) return std::nullopt;
    std::optional<T> value(std::move(values_.front()));
    values_.pop_front();
    lock.unlock();
    has_room_.notify_one();
    return value;
  }

  const std::size_t capacity_;
  const WhenFull when_full_;
  mutable std::mutex mutex_;
  std::condition_variable has_value_;
  std::condition_variable has_room_;
  std::deque<T> values_;
  std::size_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace elbowroom::core
