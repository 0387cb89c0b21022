// Distances along one row of cells, many cells at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace elbowroom::recon {

// The most cells that are read beyond either end of a row.
inline constexpr std::size_t kRowMargin = 128;

// nearest[x] = min over dx of squares[x + dx] + dx^2, capped at near^2; near is at most 11. Each of `squares`
// is at most near^2, and is near^2 in the kRowMargin cells before the first and after the last. Writes up to
// 64 items more than `width`.
void NearSquaresInRow(const std::uint8_t* squares, std::size_t width, std::uint8_t near,
                      std::uint8_t* nearest);

// nearest[x] = min over dx of squares[x + dx] + gap(dx)^2; gap(dx) = block (|dx| - 1) + 1 between blocks, 0
// in one. `squares` is infinite in the width + kRowMargin blocks before the first and after the last. Writes
// up to kRowMargin items more than `width`.
void NearestBlocksInRow(const float* squares, std::size_t width, int block, float* nearest);

}  // namespace elbowroom::recon
