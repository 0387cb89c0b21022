#include "app/console/silhouette_picture.h"

#include <bit>
#include <cstdint>
#include <vector>

#include "app/console/palette.h"
#include "core/error.h"

namespace elbowroom::console {
namespace {

constexpr int kWordBits = 64;

// The smallest power of two (so that no block straddles two words) that brings the width below the limit.
int BlockEdge(int width_px, int max_width_px) {
  int edge = 1;
  while (edge < kWordBits && width_px / edge > max_width_px) edge *= 2;
  return edge;
}

QRgb Mixed(int share, int whole) {
  const auto mix = [&](int background, int object) {
    return background + (object - background) * share / whole;
  };
  return qRgb(mix(kSilhouetteBackground.red(), kSilhouetteObject.red()),
              mix(kSilhouetteBackground.green(), kSilhouetteObject.green()),
              mix(kSilhouetteBackground.blue(), kSilhouetteObject.blue()));
}

// Adds the object pixels of mask row `y` to the counts of the blocks that the row crosses.
void CountRow(const core::BitMask& mask, int y, int edge, std::vector<int>* counts) {
  const std::uint64_t block_bits = edge == kWordBits ? ~std::uint64_t{0} : (std::uint64_t{1} << edge) - 1U;
  const auto row = mask.words().subspan(static_cast<std::size_t>(y) * mask.words_per_row());
  for (std::size_t i = 0; i < counts->size(); ++i) {
    const std::size_t x = i * static_cast<std::size_t>(edge);
    (*counts)[i] += std::popcount((row[x / kWordBits] >> (x % kWordBits)) & block_bits);
  }
}

}  // namespace

QImage SilhouettePicture(const core::BitMask& mask, int max_width_px) {
  core::Require(max_width_px > 0, "a picture is at least a pixel wide");
  if (mask.width_px() == 0 || mask.height_px() == 0) return {};
  const int edge = BlockEdge(mask.width_px(), max_width_px);
  QImage picture(mask.width_px() / edge, mask.height_px() / edge, QImage::Format_RGB32);
  std::vector<int> counts(static_cast<std::size_t>(picture.width()));
  for (int row = 0; row < picture.height(); ++row) {
    counts.assign(counts.size(), 0);
    for (int y = row * edge; y < (row + 1) * edge; ++y) CountRow(mask, y, edge, &counts);
    auto* pixels = reinterpret_cast<QRgb*>(picture.scanLine(row));
    for (const int count : counts) *pixels++ = Mixed(count, edge * edge);
  }
  return picture;
}

}  // namespace elbowroom::console
