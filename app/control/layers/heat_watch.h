// The heat of a running trial as a layer, made beside it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "app/control/layers/heat_layer.h"

namespace elbowroom::control {

// While somebody looks, the trial hands over the maps of parts whose heat has changed, at most once in
// kApart. The latest of each part wins; nobody waits. While nobody looks, nothing is handed over and nothing
// is made. Thread: any; `on_layer` comes on a thread of its own and must not block.
class HeatWatch {
 public:
  static constexpr std::chrono::milliseconds kApart{500};
  using OnLayer = std::function<void(const SharedHeatLayer&)>;
  using Clock = std::chrono::steady_clock;

  // One mesh a part of the layout.
  HeatWatch(std::vector<core::SharedMesh> part_meshes, OnLayer on_layer,
            std::function<Clock::time_point()> now = &Clock::now);
  HeatWatch(const HeatWatch&) = delete;
  HeatWatch& operator=(const HeatWatch&) = delete;

  // From here on somebody looks, and gets a layer at once; or nobody does any more.
  void Want(bool is_wanted);

  // Whether it is time to hand over maps; if so, the next time is kApart later.
  [[nodiscard]] bool TakesMaps();
  // A map may come out of turn, too, as at a trial's end. It is kept until somebody looks.
  void Put(std::vector<core::HeatMap> maps);

 private:
  void Run(const std::stop_token& stop);

  OnLayer on_layer_;
  std::function<Clock::time_point()> now_;
  HeatLayerMaker maker_;  // the thread's
  std::mutex mutex_;      // for the next four
  bool is_wanted_ = false;
  bool is_asked_ = false;  // for a layer, even if nothing has changed
  std::map<core::PartIndex, core::HeatMap> waiting_;
  std::optional<Clock::time_point> next_;
  std::condition_variable_any wakes_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace elbowroom::control
