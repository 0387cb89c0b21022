#include "recon/gl/scene/level_maker.h"

#include <chrono>
#include <utility>

namespace elbowroom::recon::gl {

void LevelMaker::Ask(const core::SharedMesh& mesh) {
  waiting_.push_back(mesh);
  BeginNext();
}

std::optional<MadeLevels> LevelMaker::Take() {
  if (!making_.valid() || making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return std::nullopt;
  return Await();
}

std::optional<MadeLevels> LevelMaker::Await() {
  if (!making_.valid()) return std::nullopt;
  MadeLevels made = making_.get();
  BeginNext();
  return made;
}

void LevelMaker::BeginNext() {
  while (!making_.valid() && !waiting_.empty()) {
    core::SharedMesh mesh = waiting_.front().lock();
    waiting_.pop_front();
    if (mesh == nullptr) continue;
    making_ = std::async(std::launch::async,
                         [mesh = std::move(mesh), crease_rad = crease_rad_, stop = stop_.get_token()] {
                           const SurfaceMesh whole = PrepareSurface(*mesh, crease_rad);
                           return MadeLevels{mesh, MakeDetailLevels(*mesh, whole, stop)};
                         });
  }
}

}  // namespace elbowroom::recon::gl
