#include "recon/swept_volume/kuhn_cell.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace elbowroom::recon {
namespace {

using Tetrahedron = std::array<unsigned, 4>;  // corners of the cell

// Each goes from corner 0 to corner 7 along the three axes in one of their six orders. It is right-handed
// (its edges from the first corner have a positive determinant) if the order is an even permutation; the
// others have two corners swapped.
constexpr std::array<Tetrahedron, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}}};

EdgePoint Between(unsigned a, unsigned b) {
  const auto [low, high] = std::minmax(a, b);
  return {static_cast<std::uint8_t>(low), static_cast<std::uint8_t>(high)};
}

// The same tetrahedron, right-handed too, with the corners that are inside first.
Tetrahedron InsideFirst(Tetrahedron corners, unsigned inside) {
  bool is_odd = false;
  const auto swap = [&](std::size_t i, std::size_t j) {
    std::swap(corners[i], corners[j]);
    is_odd = !is_odd;
  };
  std::size_t first = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if ((inside >> corners[i] & 1U) == 0) continue;
    if (i != first) swap(i, first);
    ++first;
  }
  // The first two or the last two are alike, so they may be swapped.
  if (is_odd) first >= 2 ? swap(0, 1) : swap(2, 3);
  return corners;
}

// Seen from a right-handed tetrahedron's first corner the others go counter-clockwise round from outside.
void AddTriangles(const Tetrahedron& corners, unsigned inside, std::vector<CellTriangle>* triangles) {
  const auto [a, b, c, d] = InsideFirst(corners, inside);
  const auto count =
      std::ranges::count_if(corners, [&](unsigned corner) { return (inside >> corner & 1U) != 0; });
  if (count == 1) triangles->push_back({Between(a, b), Between(a, c), Between(a, d)});
  if (count == 2) {
    triangles->push_back({Between(a, c), Between(a, d), Between(b, d)});
    triangles->push_back({Between(a, c), Between(b, d), Between(b, c)});
  }
  if (count == 3) triangles->push_back({Between(a, d), Between(b, d), Between(c, d)});
}

std::array<std::vector<CellTriangle>, 256> MakeTable() {
  std::array<std::vector<CellTriangle>, 256> table;
  for (unsigned inside = 0; inside < 256; ++inside)
    for (const Tetrahedron& corners : kTetrahedra) AddTriangles(corners, inside, &table[inside]);
  return table;
}

}  // namespace

std::span<const CellTriangle> CellTriangles(unsigned inside) {
  static const std::array<std::vector<CellTriangle>, 256> kTable = MakeTable();
  return kTable[inside];
}

}  // namespace elbowroom::recon
