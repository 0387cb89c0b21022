#include "app/control/layers/heat_watch.h"

#include <utility>

namespace elbowroom::control {

HeatWatch::HeatWatch(std::vector<core::SharedMesh> part_meshes, OnLayer on_layer,
                     std::function<Clock::time_point()> now)
    : on_layer_(std::move(on_layer)),
      now_(std::move(now)),
      maker_(std::move(part_meshes)),
      thread_([this](const std::stop_token& stop) { Run(stop); }) {}

void HeatWatch::Want(bool is_wanted) {
  const std::lock_guard lock(mutex_);
  is_asked_ = is_wanted;
  is_wanted_ = is_wanted;
  next_.reset();
  wakes_.notify_one();
}

bool HeatWatch::TakesMaps() {
  const Clock::time_point now = now_();
  const std::lock_guard lock(mutex_);
  if (!is_wanted_ || (next_ && now < *next_)) return false;
  next_ = now + kApart;
  return true;
}

void HeatWatch::Put(std::vector<core::HeatMap> maps) {
  const std::lock_guard lock(mutex_);
  for (core::HeatMap& map : maps) {
    const core::PartIndex part = map.part;
    waiting_[part] = std::move(map);
  }
  wakes_.notify_one();
}

void HeatWatch::Run(const std::stop_token& stop) {
  while (true) {
    std::map<core::PartIndex, core::HeatMap> maps;
    {
      std::unique_lock lock(mutex_);
      const bool is_more =
          wakes_.wait(lock, stop, [this] { return is_wanted_ && (is_asked_ || !waiting_.empty()); });
      if (!is_more) return;
      is_asked_ = false;
      maps = std::exchange(waiting_, {});
    }
    for (auto& [part, map] : maps) maker_.Take(std::move(map));
    on_layer_(maker_.Make());
  }
}

}  // namespace elbowroom::control
