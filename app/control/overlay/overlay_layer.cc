#include "app/control/overlay/overlay_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/control/overlay/projected_edge.h"
#include "app/control/overlay/sight_line.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using Parts = std::span<const std::shared_ptr<const PartPicture>>;

OverlayLayer EmptyLayer(const ViewPixels& view) {
  OverlayLayer layer;
  layer.width_px = view.rays().width_px();
  layer.height_px = view.rays().height_px();
  const auto pixels = static_cast<std::size_t>(layer.width_px) * static_cast<std::size_t>(layer.height_px);
  layer.face_depth_mm.resize(pixels);
  layer.face_part.resize(pixels);
  layer.face_shade.resize(pixels);
  layer.line_share.resize(pixels);
  layer.line_depth_mm.resize(pixels);
  layer.line_part.resize(pixels);
  return layer;
}

void Extend(int x, int y, recon::PixelBox* box) {
  if (box->right <= box->x) {
    *box = {x, y, x + 1, y + 1};
    return;
  }
  *box = {std::min(box->x, x), std::min(box->y, y), std::max(box->right, x + 1),
          std::max(box->bottom, y + 1)};
}

void AddFaces(const PartFaces& faces, std::uint16_t part, OverlayLayer* layer) {
  for (int y = faces.box.y; y < faces.box.bottom; ++y) {
    for (int x = faces.box.x; x < faces.box.right; ++x) {
      const float depth_mm = faces.depth_mm[faces.At(x, y)];
      const std::size_t at = layer->At(x, y);
      if (depth_mm <= 0.0F || (layer->face_depth_mm[at] > 0.0F && layer->face_depth_mm[at] <= depth_mm))
        continue;
      layer->face_depth_mm[at] = depth_mm;
      layer->face_part[at] = part;
      layer->face_shade[at] = faces.shade[faces.At(x, y)];
      Extend(x, y, &layer->box);
    }
  }
}

// A part that covers none of the pixels around a place is taken not to hide it.
bool MayHide(const PartFaces& faces, const Eigen::Vector2d& pixel) {
  return pixel.x() >= faces.box.x - 1 && pixel.x() <= faces.box.right && pixel.y() >= faces.box.y - 1 &&
         pixel.y() <= faces.box.bottom;
}

bool IsHiddenByOthers(Parts parts, std::size_t own, const LinePiece& piece) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i == own || !MayHide(parts[i]->faces, 0.5 * (piece.from_px + piece.to_px))) continue;
    const core::RigidTransform part_from_cam = parts[i]->cam_from_part.Inverse();
    if (IsHidden(parts[i]->mesh->tree(), part_from_cam.translation_mm, part_from_cam * piece.middle_in_cam,
                 kOverlayNearMm / piece.depth_mm))
      return true;
  }
  return false;
}

double DistanceToPiece(const Eigen::Vector2d& x, const LinePiece& piece) {
  const Eigen::Vector2d along = piece.to_px - piece.from_px;
  const double squared = along.squaredNorm();
  const double s = squared > 0.0 ? std::clamp((x - piece.from_px).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (x - piece.from_px - s * along).norm();
}

void AddLine(const OverlayLine& line, double width_px, OverlayLayer* layer) {
  const double reach_px = 0.5 * width_px + 0.5;
  const Eigen::Vector2d least = line.piece.from_px.cwiseMin(line.piece.to_px).array() - reach_px,
                        most = line.piece.from_px.cwiseMax(line.piece.to_px).array() + reach_px;
  const int left = std::max(0, static_cast<int>(std::ceil(least.x()))),
            right = std::min(layer->width_px - 1, static_cast<int>(std::floor(most.x())));
  const int top = std::max(0, static_cast<int>(std::ceil(least.y()))),
            bottom = std::min(layer->height_px - 1, static_cast<int>(std::floor(most.y())));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double share = std::clamp(reach_px - DistanceToPiece({x, y}, line.piece), 0.0, 1.0);
      const auto of_255 = static_cast<std::uint8_t>(std::lround(255.0 * share));
      const std::size_t at = layer->At(x, y);
      if (of_255 <= layer->line_share[at]) continue;
      layer->line_share[at] = of_255;
      layer->line_depth_mm[at] = static_cast<float>(line.piece.depth_mm);
      layer->line_part[at] = line.part;
      Extend(x, y, &layer->box);
    }
  }
}

}  // namespace

OverlayLayer ComposeLayer(const ViewPixels& view, Parts parts, double line_width_px) {
  core::Require(parts.size() <= std::numeric_limits<std::uint16_t>::max(),
                "an overlay has at most 65535 parts");
  OverlayLayer layer = EmptyLayer(view);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    AddFaces(parts[i]->faces, static_cast<std::uint16_t>(i), &layer);
    for (const LinePiece& piece : parts[i]->lines.pieces)
      if (!IsHiddenByOthers(parts, i, piece)) layer.lines.push_back({piece, static_cast<std::uint16_t>(i)});
  }
  for (const OverlayLine& line : layer.lines) AddLine(line, line_width_px, &layer);
  return layer;
}

}  // namespace elbowroom::control
