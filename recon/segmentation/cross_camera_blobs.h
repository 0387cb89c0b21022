// Blobs that no other camera confirms: something that moved outside of the workspace, a reflection.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bit_mask.h"
#include "core/rig.h"
#include "recon/segmentation/mask_regions.h"

namespace elbowroom::recon {

// The blobs of one camera's mask, and which of them the hull may need.
struct ConfirmedBlobs {
  Regions blobs;                   // ObjectRegions of the mask
  std::vector<bool> is_confirmed;  // one a region
  bool is_told_apart = true;       // false: no cell was confirmed, so all regions count as confirmed
};

// Which blobs of a rig's masks can't be part of the hull. The workspace is cut into cells, and each cell
// knows the rectangle of 16 x 16 pixel tiles that it can project into in every camera (certified, from the
// ball around it). A cell is confirmed when every camera that can rule it out shows object in its rectangle;
// a blob that lies in no confirmed cell's rectangle has no point in the hull, so the hull is the same without
// it (tests/recon/segmentation/cross_camera_blobs_test.cc). Immutable. Thread: any.
class CrossCameraBlobs {
 public:
  explicit CrossCameraBlobs(const core::Rig& rig);

  // One a camera. If no cell is confirmed, all blobs count as confirmed, since they can't be told apart.
  // Throws: PreconditionError unless there is one mask a camera, of its size.
  [[nodiscard]] std::vector<ConfirmedBlobs> Confirm(std::span<const core::BitMask* const> masks) const;

  // Which cameras may have dropped too small a blob, one a camera: such a camera rules out a cell in which
  // all others show object, and two of them at least a blob that is confirmed nowhere. Of many cameras a
  // quarter may do so at once. `confirmed`: of these masks. Throws: likewise.
  [[nodiscard]] std::vector<bool> MayOverlook(std::span<const core::BitMask* const> masks,
                                              std::span<const ConfirmedBlobs> confirmed) const;

 private:
  // Tiles [x0, x1) x [y0, y1); empty where the camera sees nothing of the cell.
  struct TileBox {
    std::int16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool has_say = true;  // if it shows no object in these tiles, the camera rules the cell out
  };
  struct Picture {
    int width_px = 0, height_px = 0;
  };
  void RequireOneMaskACamera(std::span<const core::BitMask* const> masks) const;
  [[nodiscard]] static TileBox BoxOf(const core::CameraModel& camera, const Eigen::Vector3d& center_in_world,
                                     double radius_mm);

  std::vector<Picture> pictures_;
  std::vector<TileBox> boxes_;  // cell by cell, one a camera
};

}  // namespace elbowroom::recon
