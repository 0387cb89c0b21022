#include "recon/segmentation/cross_camera_blobs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr int kTilePx = 16;
constexpr int kCellsAlongLongestSide = 32;
constexpr double kRoundingPx = 0.01;  // far above what projecting a cell's centre can be off

int TilesIn(int length_px) { return (length_px + kTilePx - 1) / kTilePx; }

// Whether a picture's tiles hold object, as sums: any rectangle takes four look-ups.
class TileSums {
 public:
  TileSums() = default;
  explicit TileSums(const core::BitMask& mask)
      : across_(TilesIn(mask.width_px()) + 1),
        sums_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(TilesIn(mask.height_px()) + 1),
              0) {
    std::vector<std::uint64_t> any(mask.words_per_row());
    for (int tile_y = 0; tile_y < TilesIn(mask.height_px()); ++tile_y) {
      std::ranges::fill(any, 0);
      for (int y = tile_y * kTilePx; y < std::min((tile_y + 1) * kTilePx, mask.height_px()); ++y) {
        const auto row = mask.words().subspan(static_cast<std::size_t>(y) * any.size(), any.size());
        for (std::size_t i = 0; i < any.size(); ++i) any[i] |= row[i];
      }
      std::uint32_t in_row = 0;
      for (int tile_x = 0; tile_x + 1 < across_; ++tile_x) {
        const std::uint64_t bits = any[static_cast<std::size_t>(tile_x / 4)] >> (tile_x % 4 * kTilePx);
        in_row += (bits & 0xffffU) != 0 ? 1U : 0U;
        sums_[Index(tile_x + 1, tile_y + 1)] = sums_[Index(tile_x + 1, tile_y)] + in_row;
      }
    }
  }

  // Tiles with object.
  [[nodiscard]] std::uint32_t all() const { return sums_.back(); }

  [[nodiscard]] bool AnyIn(int x0, int y0, int x1, int y1) const {
    return sums_[Index(x1, y1)] - sums_[Index(x0, y1)] - sums_[Index(x1, y0)] + sums_[Index(x0, y0)] != 0;
  }

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(x);
  }
  int across_ = 0;
  std::vector<std::uint32_t> sums_;
};

// Which of a picture's tiles are covered by some of many rectangles. Add() marks a rectangle's corners; Sum()
// turns the marks into counts a tile.
class TileCover {
 public:
  TileCover(int width_px, int height_px)
      : across_(TilesIn(width_px) + 1),
        counts_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(TilesIn(height_px) + 1), 0) {}

  // Tiles [x0, x1) x [y0, y1).
  void Add(int x0, int y0, int x1, int y1) {
    ++counts_[Index(x0, y0)], --counts_[Index(x1, y0)];
    --counts_[Index(x0, y1)], ++counts_[Index(x1, y1)];
  }

  // Called once, after all rectangles are added.
  void Sum() {
    const auto across = static_cast<std::size_t>(across_);
    for (std::size_t row = 0; row < counts_.size(); row += across)
      for (std::size_t x = 1; x < across; ++x) counts_[row + x] += counts_[row + x - 1];
    for (std::size_t i = across; i < counts_.size(); ++i) counts_[i] += counts_[i - across];
  }

  [[nodiscard]] bool AnyIn(int y, int x0, int x1) const {
    const std::int32_t* const row = &counts_[Index(0, y)];
    return std::any_of(row + x0, row + x1, [](std::int32_t count) { return count != 0; });
  }

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(x);
  }
  int across_;
  std::vector<std::int32_t> counts_;
};

}  // namespace

CrossCameraBlobs::TileBox CrossCameraBlobs::BoxOf(const core::CameraModel& camera,
                                                  const Eigen::Vector3d& center_in_world, double radius_mm) {
  const TileBox everywhere{0, 0, static_cast<std::int16_t>(TilesIn(camera.width_px())),
                           static_cast<std::int16_t>(TilesIn(camera.height_px())), false};
  const Eigen::Vector3d x_in_cam = camera.cam_from_world() * center_in_world;
  const double z = x_in_cam.z(), rho = camera.max_radius();
  if (z <= -radius_mm) return {};
  // The ball lies outside of the cone that the lens sees.
  const double beside = x_in_cam.head<2>().norm() - rho * z;
  if (beside > radius_mm * std::sqrt(1.0 + rho * rho)) return {};
  const auto pixel = camera.ProjectInCam(x_in_cam);
  if (!pixel || z <= radius_mm) return everywhere;
  // In the normalised plane every point of the ball falls within `spread` of its centre (derived for
  // RadiusOfReach in recon/hull/camera_query.cc), and the lens stretches that by PixelStretch at most.
  const double spread = radius_mm * x_in_cam.norm() / (z * (z - radius_mm));
  const double spread_px = camera.PixelStretch(x_in_cam.head<2>().norm() / z + spread) * spread + kRoundingPx;
  // Pixel x covers [x - 1/2, x + 1/2). The cell's pixels are x0 to x1 and y0 to y1.
  const auto pixel_of = [](double position_px, int length_px) {
    return static_cast<int>(std::clamp(std::floor(position_px + 0.5), -1.0, static_cast<double>(length_px)));
  };
  const int x0 = pixel_of(pixel->x() - spread_px, camera.width_px());
  const int x1 = pixel_of(pixel->x() + spread_px, camera.width_px());
  const int y0 = pixel_of(pixel->y() - spread_px, camera.height_px());
  const int y1 = pixel_of(pixel->y() + spread_px, camera.height_px());
  if (x1 < 0 || x0 >= camera.width_px() || y1 < 0 || y0 >= camera.height_px()) return {};
  const bool is_seen_whole = x0 >= 0 && x1 < camera.width_px() && y0 >= 0 && y1 < camera.height_px() &&
                             x_in_cam.head<2>().norm() / z + spread < rho;
  const auto tile = [](int pixel_index, int length_px) {
    return static_cast<std::int16_t>(std::clamp(pixel_index, 0, length_px - 1) / kTilePx);
  };
  return {tile(x0, camera.width_px()), tile(y0, camera.height_px()),
          static_cast<std::int16_t>(tile(x1, camera.width_px()) + 1),
          static_cast<std::int16_t>(tile(y1, camera.height_px()) + 1), is_seen_whole};
}

CrossCameraBlobs::CrossCameraBlobs(const core::Rig& rig) {
  rig.Validate();
  const bool unseen_is_outside = rig.unseen == core::UnseenPolicy::kOutside;
  for (const core::CameraModel& camera : rig.cameras)
    pictures_.push_back({camera.width_px(), camera.height_px()});
  const Eigen::Vector3d size = rig.workspace_mm.sizes();
  const double edge_mm = size.maxCoeff() / kCellsAlongLongestSide;
  const Eigen::Vector3i cells = (size / edge_mm).array().ceil().max(1.0).cast<int>();
  const Eigen::Vector3d cell = size.cwiseQuotient(cells.cast<double>());
  std::vector<TileBox> boxes(rig.cameras.size());
  for (int i = 0; i < cells.prod(); ++i) {
    const Eigen::Vector3i index(i % cells.x(), i / cells.x() % cells.y(), i / (cells.x() * cells.y()));
    const Eigen::Vector3d center =
        rig.workspace_mm.min() + (index.cast<double>() + Eigen::Vector3d::Constant(0.5)).cwiseProduct(cell);
    for (std::size_t c = 0; c < boxes.size(); ++c) {
      boxes[c] = BoxOf(rig.cameras[c], center, 0.5 * cell.norm());
      boxes[c].has_say = unseen_is_outside || (boxes[c].has_say && boxes[c].x0 < boxes[c].x1);
    }
    const auto is_unseen = [](const TileBox& box) { return box.x0 == box.x1; };
    const bool can_confirm =
        unseen_is_outside ? std::ranges::none_of(boxes, is_unseen) : !std::ranges::all_of(boxes, is_unseen);
    if (can_confirm) boxes_.insert(boxes_.end(), boxes.begin(), boxes.end());
  }
}

void CrossCameraBlobs::RequireOneMaskACamera(std::span<const core::BitMask* const> masks) const {
  core::Require(masks.size() == pictures_.size(), "one mask a camera");
  for (std::size_t c = 0; c < masks.size(); ++c) {
    core::Require(
        masks[c]->width_px() == pictures_[c].width_px && masks[c]->height_px() == pictures_[c].height_px,
        "a mask is of its camera's size");
  }
}

std::vector<ConfirmedBlobs> CrossCameraBlobs::Confirm(std::span<const core::BitMask* const> masks) const {
  RequireOneMaskACamera(masks);
  const std::size_t cameras = pictures_.size();
  std::vector<TileSums> sums(cameras);
  std::vector<ConfirmedBlobs> result(cameras);
  tbb::parallel_for(std::size_t{0}, cameras, [&](std::size_t c) {
    sums[c] = TileSums(*masks[c]);
    result[c].blobs = ObjectRegions(*masks[c]);
  });
  // The camera that shows the least object rules out the most cells.
  std::vector<std::size_t> order(cameras);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t c) { return sums[c].all(); });
  std::vector<TileCover> confirmed;
  for (const Picture& picture : pictures_) confirmed.emplace_back(picture.width_px, picture.height_px);
  bool any = false;
  for (std::size_t cell = 0; cell < boxes_.size(); cell += cameras) {
    const bool is_confirmed = std::ranges::all_of(order, [&](std::size_t c) {
      const TileBox& box = boxes_[cell + c];
      return !box.has_say || sums[c].AnyIn(box.x0, box.y0, box.x1, box.y1);
    });
    if (!is_confirmed) continue;
    any = true;
    for (std::size_t c = 0; c < cameras; ++c) {
      const TileBox& box = boxes_[cell + c];
      confirmed[c].Add(box.x0, box.y0, box.x1, box.y1);
    }
  }
  for (std::size_t c = 0; c < cameras; ++c) {
    std::vector<bool>& is_confirmed = result[c].is_confirmed;
    is_confirmed.assign(result[c].blobs.area_px.size(), !any);
    result[c].is_told_apart = any;
    if (!any) continue;
    confirmed[c].Sum();
    for (const Run& run : result[c].blobs.runs) {
      if (!is_confirmed[run.region] &&
          confirmed[c].AnyIn(run.y / kTilePx, run.x0 / kTilePx, (run.x1 - 1) / kTilePx + 1))
        is_confirmed[run.region] = true;
    }
  }
  return result;
}

std::vector<bool> CrossCameraBlobs::MayOverlook(std::span<const core::BitMask* const> masks,
                                                std::span<const ConfirmedBlobs> confirmed) const {
  constexpr std::size_t kLeastWitnesses = 2;
  RequireOneMaskACamera(masks);
  const std::size_t cameras = pictures_.size();
  core::Require(confirmed.size() == cameras, "what is confirmed is of these masks");
  std::vector<bool> may_overlook(cameras, false);
  std::vector<std::size_t> witnesses;  // cameras with a blob that is confirmed nowhere
  std::vector<TileSums> unconfirmed(cameras);
  for (std::size_t c = 0; c < cameras; ++c) {
    const ConfirmedBlobs& blobs = confirmed[c];
    std::vector<bool> keep(blobs.is_confirmed.size(), true);
    if (blobs.is_told_apart) keep.assign(blobs.is_confirmed.begin(), blobs.is_confirmed.end()), keep.flip();
    if (std::ranges::find(keep, true) == keep.end()) continue;
    core::BitMask rest = *masks[c];
    ClearRegions(rest, blobs.blobs, keep);
    unconfirmed[c] = TileSums(rest);
    witnesses.push_back(c);
  }
  if (witnesses.size() < kLeastWitnesses) return may_overlook;
  std::vector<TileSums> sums(cameras);
  for (std::size_t c = 0; c < cameras; ++c) sums[c] = TileSums(*masks[c]);
  const std::size_t most_deniers = std::max<std::size_t>(1, cameras / 2);
  std::vector<std::size_t> deniers;
  for (std::size_t cell = 0; cell < boxes_.size(); cell += cameras) {
    const auto shows = [&](const std::vector<TileSums>& what, std::size_t c) {
      const TileBox& box = boxes_[cell + c];
      return what[c].AnyIn(box.x0, box.y0, box.x1, box.y1);
    };
    const auto seen = std::ranges::count_if(witnesses, [&](std::size_t c) { return shows(unconfirmed, c); });
    if (static_cast<std::size_t>(seen) < kLeastWitnesses) continue;
    deniers.clear();
    for (std::size_t c = 0; c < cameras && deniers.size() <= most_deniers; ++c)
      if (boxes_[cell + c].has_say && !shows(sums, c)) deniers.push_back(c);
    if (deniers.size() > most_deniers) continue;
    for (const std::size_t c : deniers) may_overlook[c] = true;
  }
  return may_overlook;
}

}  // namespace elbowroom::recon
