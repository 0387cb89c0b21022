// Makes detail levels beside the drawing, one mesh after the other.
#pragma once

#include <cstddef>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "recon/gl/scene/detail_levels.h"

namespace elbowroom::recon::gl {

struct MadeLevels {
  core::SharedMesh mesh;
  std::vector<DetailLevel> levels;
};

// A mesh that nobody else keeps any more when its turn comes is passed over. The destructor waits for the
// level that is being made. Thread: one calls; the work is done on another.
class LevelMaker {
 public:
  explicit LevelMaker(double crease_rad) : crease_rad_(crease_rad) {}  // as PrepareSurface
  ~LevelMaker() { stop_.request_stop(); }
  LevelMaker(const LevelMaker&) = delete;
  LevelMaker& operator=(const LevelMaker&) = delete;

  void Ask(const core::SharedMesh& mesh);
  // What was finished since the last call, if anything was; never waits.
  [[nodiscard]] std::optional<MadeLevels> Take();
  // Waits for the next levels that were asked for; nothing if all were taken.
  [[nodiscard]] std::optional<MadeLevels> Await();

 private:
  void BeginNext();

  double crease_rad_;
  std::deque<std::weak_ptr<const core::TriangleMesh>> waiting_;
  std::stop_source stop_;
  std::future<MadeLevels> making_;  // last: its destructor waits
};

}  // namespace elbowroom::recon::gl
