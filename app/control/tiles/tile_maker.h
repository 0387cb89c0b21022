// The camera strip's tiles, made beside the trial.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/tiles/camera_tally.h"
#include "app/control/tiles/frame_overlays.h"
#include "app/control/tiles/thumbnail.h"
#include "recon/footage/frame_set.h"
#include "recon/images/image.h"
#include "recon/light/light_report.h"

namespace elbowroom::control {

// One camera, as the strip shows it.
struct CameraTile {
  std::string name;
  recon::Image picture;   // with the silhouette's outline; of the last frame that had one; empty: none yet
  recon::Image enlarged;  // the same as large as was asked for; empty: of another camera, or none
  std::int64_t object_px = 0;  // of the silhouette, at full size
  bool is_missing = false;     // the last frame lacks its picture
  std::string gone;            // why nothing comes from it, one line; "": it is there
  CameraFigures figures;
};

using SharedTiles = std::shared_ptr<const std::vector<CameraTile>>;

// What the tiles show, and how large.
struct TileWishes {
  ThumbnailRoom room;                         // of one camera's picture; empty, as at first: nobody looks
  bool shows_parts = true;                    // the layout's parts, hidden by what is real before them
  std::optional<core::CameraIndex> enlarged;  // the camera whose picture is shown large
  ThumbnailRoom enlarged_room;

  [[nodiscard]] bool HasRoom() const { return !room.is_empty() || (enlarged && !enlarged_room.is_empty()); }
};

// Makes tiles of the latest frame at most once in kApart, and only if there is room for them; looks as often
// whether a camera has gone, also while no frame comes. Nobody waits for it. Thread: any; `on_tiles` comes on
// a thread of its own and must not block.
class TileMaker {
 public:
  static constexpr std::chrono::milliseconds kApart{66};
  // Thin lines, which leave something of a small picture.
  static constexpr OverlayLook kTileOverlay{.line_width_px = 1.0, .face_opacity = 0.45};
  using OnTiles = std::function<void(const SharedTiles&)>;

  // The source tells which cameras have gone; it isn't kept alive.
  TileMaker(const std::shared_ptr<const recon::FrameSetSource>& source, OnTiles on_tiles);
  TileMaker(const TileMaker&) = delete;
  TileMaker& operator=(const TileMaker&) = delete;

  void Wish(const TileWishes& wishes);        // holds from the next frame on
  void Add(const SharedFrameResult& result);  // every frame
  void AddLight(const recon::LightReport& report);

 private:
  void Run(const std::stop_token& stop);
  void MakePictures(const FrameResult& result, const TileWishes& wishes);
  [[nodiscard]] bool FindGone();
  [[nodiscard]] SharedTiles TilesNow() const;

  std::weak_ptr<const recon::FrameSetSource> source_;
  OnTiles on_tiles_;
  CameraTally tally_;
  std::vector<CameraTile> tiles_;         // this and the next two: of the maker's thread
  FrameOverlays overlays_{kTileOverlay};  // of the small pictures
  FrameOverlays enlarged_overlay_;
  std::mutex mutex_;  // for the next two
  TileWishes wishes_;
  SharedFrameResult latest_;  // null: it was looked at
  std::condition_variable_any wakes_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace elbowroom::control
