// Distances along one row of cells, many cells at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace elbowroom::recon {

// Cells that a row is read beyond its ends, at most.
inline constexpr std::size_t kRowMargin = 128;

// nearest[x] = min over dx of squares[x + dx] + dx^2, capped at near^2; near is at most 11. `squares`: at
// most near^2 each, and that in kRowMargin cells before the first and after the last. Writes up to 64 more.
void NearSquaresInRow(const std::uint8_t* squares, std::size_t width, std::uint8_t near,
                      std::uint8_t* nearest);

// nearest[x] = min over dx of squares[x + dx] + gap(dx)^2; gap(dx) = block (|dx| - 1) + 1 between blocks, 0
// in one. `squares`: infinite in width + kRowMargin blocks before the first and after the last. Writes up to
// kRowMargin more.
void NearestBlocksInRow(const float* squares, std::size_t width, int block, float* nearest);

}  // namespace elbowroom::recon
