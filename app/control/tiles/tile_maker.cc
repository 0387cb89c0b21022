#include "app/control/tiles/tile_maker.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace elbowroom::control {

TileMaker::TileMaker(const std::shared_ptr<const recon::FrameSetSource>& source, OnTiles on_tiles)
    : source_(source),
      on_tiles_(std::move(on_tiles)),
      tally_(source->rig().cameras.size()),
      tiles_(source->rig().cameras.size()) {
  for (std::size_t i = 0; i < tiles_.size(); ++i) tiles_[i].name = source->rig().cameras[i].name();
  thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
}

void TileMaker::Wish(const TileWishes& wishes) {
  const std::lock_guard lock(mutex_);
  wishes_ = wishes;
}

void TileMaker::Add(const SharedFrameResult& result) {
  tally_.Add(result->record, result->camera_frames && result->camera_frames->taken_at);
  SharedFrameResult replaced;  // let go of after the lock
  const std::lock_guard lock(mutex_);
  replaced = std::exchange(latest_, result);
}

void TileMaker::AddLight(const recon::LightReport& report) {
  const auto found = std::ranges::find(tiles_, report.camera, &CameraTile::name);
  if (found != tiles_.end()) tally_.AddLight(static_cast<std::size_t>(found - tiles_.begin()), report);
}

void TileMaker::Run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto begin = std::chrono::steady_clock::now();
    SharedFrameResult result;
    TileWishes wishes;
    {
      const std::lock_guard lock(mutex_);
      wishes = wishes_;
      if (wishes.HasRoom()) result = std::exchange(latest_, nullptr);
    }
    if (wishes.HasRoom()) {
      const bool is_new = result != nullptr;
      try {
        if (is_new) MakePictures(*std::exchange(result, nullptr), wishes);
      } catch (const std::exception& error) {  // the worker's outermost loop: the tiles keep their pictures
        spdlog::warn("no pictures for the camera strip: {}", error.what());
      }
      if (FindGone() || is_new) on_tiles_(TilesNow());
    }
    std::unique_lock lock(mutex_);
    wakes_.wait_until(lock, stop, begin + kApart, [] { return false; });
  }
}

// A camera whose picture is missing keeps its last one.
void TileMaker::MakePictures(const FrameResult& result, const TileWishes& wishes) {
  const core::FrameRecord& record = result.record;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    CameraTile& tile = tiles_[i];
    tile.is_missing = i < record.stamps.size() && !record.stamps[i];
    if (wishes.enlarged != i) tile.enlarged = {};
    if (tile.is_missing) continue;
    const core::BitMask& mask = (*record.masks)[i].mask;
    const cv::Mat none;
    const cv::Mat& image_bgr = result.camera_frames ? result.camera_frames->cameras[i].image_bgr : none;
    tile.picture = ThumbnailOf(image_bgr, mask, wishes.room);
    tile.enlarged =
        ThumbnailOf(image_bgr, mask, wishes.enlarged == i ? wishes.enlarged_room : ThumbnailRoom());
    if (wishes.shows_parts) {
      overlays_.PaintOn(&tile.picture, result, i);
      enlarged_overlay_.PaintOn(&tile.enlarged, result, i);
    }
    tile.object_px = static_cast<std::int64_t>(mask.CountObjectPixels());
  }
}

// True: it isn't as it was.
bool TileMaker::FindGone() {
  const std::shared_ptr<const recon::FrameSetSource> source = source_.lock();
  if (!source) return false;
  const std::vector<std::string> troubles = source->CameraTroubles();
  bool is_changed = false;
  for (std::size_t i = 0; i < std::min(troubles.size(), tiles_.size()); ++i) {
    is_changed = is_changed || tiles_[i].gone != troubles[i];
    tiles_[i].gone = troubles[i];
  }
  return is_changed;
}

SharedTiles TileMaker::TilesNow() const {
  auto tiles = std::make_shared<std::vector<CameraTile>>(tiles_);
  std::vector<CameraFigures> figures = tally_.Figures();
  for (std::size_t i = 0; i < tiles->size(); ++i) (*tiles)[i].figures = std::move(figures[i]);
  return tiles;
}

}  // namespace elbowroom::control
