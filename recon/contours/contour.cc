#include "recon/contours/contour.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Words = std::vector<std::uint64_t>;

// One row of the lattice with a position of the exterior before and after it: bit i is pixel i - 1.
struct LatticeRow {
  Words bits;
  Words changes;                      // bit i: bits i and i + 1 differ (the last has no next)
  std::vector<std::uint8_t> levels;   // by bit; of boundary pixels only
  std::vector<std::uint32_t> across;  // vertices on the row, from the left
};

// Vertices and edges come out row by row, from the left.
class Tracer {
  static constexpr std::size_t kUsualVertices = 2048;  // room for them, before it grows

 public:
  Tracer(const core::SoftMask& silhouette, bool exterior_is_object, const UndistortedPlane& plane)
      : soft_(silhouette),
        plane_(plane),
        exterior_(exterior_is_object ? ~std::uint64_t{0} : 0),
        boundary_(silhouette.levels.empty() ? core::BitMask() : core::BoundaryPixels(silhouette.mask)),
        bits_(static_cast<std::size_t>(silhouette.mask.width_px()) + 2) {
    core::Require(soft_.levels.size() == (soft_.levels.empty() ? 0 : boundary_.CountObjectPixels()),
                  "a soft mask has one level a boundary pixel");
  }

  Contour Trace() {
    pixels_.reserve(kUsualVertices);
    contour_.edges.reserve(kUsualVertices);
    LatticeRow above, below;
    const auto [first, end] = Rows();
    FindWords(first, end);
    for (LatticeRow* row : {&above, &below}) {
      row->bits.assign(LatticeWords(), exterior_);
      row->changes.assign(LatticeWords(), 0);
    }
    ReadRow(first - 1, &above);
    for (int y = first - 1; y < end; ++y) {
      ReadRow(y + 1, &below);
      TraceCells(y, above, below);
      std::swap(above, below);
    }
    MoveToPlane();
    contour_.edge_from.resize(contour_.vertices.size());
    contour_.edge_to.resize(contour_.vertices.size());
    for (std::uint32_t i = 0; i < contour_.edges.size(); ++i) {
      contour_.edge_from[contour_.edges[i].from] = i;
      contour_.edge_to[contour_.edges[i].to] = i;
    }
    return std::move(contour_);
  }

 private:
  // The first row that differs from the exterior somewhere, and the one after the last such row; both are the
  // picture's height if there is none. Beyond the rows next to them there are no boundary pixels, and so no
  // levels.
  [[nodiscard]] std::pair<int, int> Rows() const {
    int first = 0, end = soft_.mask.height_px();
    while (first < end && IsExterior(first)) ++first;
    while (first < end && IsExterior(end - 1)) --end;
    return {first, end};
  }
  [[nodiscard]] bool IsExterior(int y) const {
    const std::span<const std::uint64_t> row = MaskRow(y);
    std::uint64_t differs = (row.back() ^ exterior_) << SpareBits();
    for (const std::uint64_t word : row.first(row.size() - 1)) differs |= word ^ exterior_;
    return differs == 0;
  }
  [[nodiscard]] std::span<const std::uint64_t> MaskRow(int y) const {
    const std::size_t words = soft_.mask.words_per_row();
    return {soft_.mask.words().data() + static_cast<std::size_t>(y) * words, words};
  }
  // The bits of a row's last word that are behind the picture.
  [[nodiscard]] std::size_t SpareBits() const {
    return soft_.mask.words_per_row() * 64 - static_cast<std::size_t>(soft_.mask.width_px());
  }

  // Finds the words of the lattice's rows in which labels may change: those of pixels that differ from the
  // exterior, and one more.
  void FindWords(int first, int end) {
    Words differs(soft_.mask.words_per_row(), 0);
    for (int y = first; y < end; ++y) {
      const std::span<const std::uint64_t> row = MaskRow(y);
      for (std::size_t i = 0; i < row.size(); ++i) differs[i] |= row[i] ^ exterior_;
    }
    differs.back() <<= SpareBits();
    const auto is_any = [](std::uint64_t word) { return word != 0; };
    const auto found = std::ranges::find_if(differs, is_any);
    if (found == differs.end()) return;
    const auto last = std::find_if(differs.rbegin(), differs.rend(), is_any).base() - 1;
    // Pixel i is bit i + 1. If it differs from its neighbours, labels change from bit i to i + 1, and from
    // there to i + 2.
    first_word_ = static_cast<std::size_t>(found - differs.begin());
    end_word_ = std::min(static_cast<std::size_t>(last - differs.begin()) + 2, LatticeWords());
  }
  [[nodiscard]] std::size_t LatticeWords() const { return (bits_ + 63) / 64; }

  static bool Bit(const Words& words, std::size_t i) { return ((words[i >> 6U] >> (i & 63U)) & 1U) != 0; }

  // Fills the words from first_word_ to end_word_. All others carry the exterior, in every row.
  void ReadRow(int y, LatticeRow* row) {
    row->across.clear();
    if (y >= 0 && y < soft_.mask.height_px()) {
      FillBits(y, &row->bits);
      if (!soft_.levels.empty()) FillLevels(y, &row->levels);
    } else {
      std::fill(row->bits.begin() + static_cast<std::ptrdiff_t>(first_word_),
                row->bits.begin() + static_cast<std::ptrdiff_t>(end_word_), exterior_);
    }
    AddVerticesAcross(y, row);
  }

  void FillBits(int y, Words* bits) const {
    const std::span<const std::uint64_t> in = MaskRow(y);
    Words& out = *bits;
    for (std::size_t i = first_word_; i < end_word_; ++i) {
      const std::uint64_t before = i > 0 ? in[i - 1] : exterior_;
      out[i] = (i < in.size() ? in[i] << 1U : 0) | before >> 63U;
    }
    if (exterior_ == 0) return;
    for (std::size_t i = bits_ - 1; i < out.size() * 64; ++i) out[i >> 6U] |= std::uint64_t{1} << (i & 63U);
  }

  void FillLevels(int y, std::vector<std::uint8_t>* levels) {
    levels->resize(bits_);
    const std::size_t words = boundary_.words_per_row();
    for (std::size_t i = 0; i < words; ++i) {
      std::uint64_t left = boundary_.words()[static_cast<std::size_t>(y) * words + i];
      for (; left != 0; left &= left - 1)
        (*levels)[i * 64 + static_cast<std::size_t>(std::countr_zero(left)) + 1] =
            soft_.levels[next_level_++];
    }
  }

  // At what share of the way from centre a to centre b the boundary is, by their levels.
  static double Share(std::uint8_t a, std::uint8_t b) {
    return (static_cast<double>(a) - 127.5) / (static_cast<double>(a) - static_cast<double>(b));
  }

  // `pixel`: a position between the centres of two neighbouring pixels.
  std::uint32_t AddVertex(const Eigen::Vector2d& pixel) {
    pixels_.push_back(pixel);
    return static_cast<std::uint32_t>(pixels_.size() - 1);
  }

  // Takes the vertices from the picture to the undistorted plane.
  void MoveToPlane() {
    contour_.vertices.resize(pixels_.size());
    plane_.FromPixels(pixels_, contour_.vertices.data());
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      if (std::isnan(contour_.vertices[i].x())) contour_.vertices[i] = NearestSeen(pixels_[i]);
  }

  // If the lens has no ray for the position (it folds there), the position is moved by halves towards the one
  // of its two pixels that is seen, until it has one.
  [[nodiscard]] Eigen::Vector2d NearestSeen(Eigen::Vector2d pixel) const {
    Eigen::Vector2d seen = pixel.array().floor();
    if (!IsSeen(static_cast<int>(seen.x()), static_cast<int>(seen.y()))) seen = pixel.array().ceil();
    std::optional<Eigen::Vector2d> at;
    for (int halving = 0; !at && halving < 20; ++halving) {
      pixel = 0.5 * (pixel + seen);
      at = plane_.FromPixel(pixel);
    }
    if (!at) at = plane_.FromPixel(seen);
    core::Require(at.has_value(), "one of two pixels with different labels is seen");
    return *at;
  }

  // Adds a vertex between bits i and i + 1 of a row where they differ.
  void AddVerticesAcross(int y, LatticeRow* row) {
    for (std::size_t word = first_word_; word < end_word_; ++word) {
      row->changes[word] = ChangesAlong(row->bits, word);
      for (std::uint64_t left = row->changes[word]; left != 0; left &= left - 1) {
        const std::size_t i = word * 64 + static_cast<std::size_t>(std::countr_zero(left));
        double share = 0.5;
        const bool is_border = i == 0 || i + 2 == bits_;
        if (!is_border && !soft_.levels.empty()) share = Share(row->levels[i], row->levels[i + 1]);
        row->across.push_back(AddVertex({static_cast<double>(i) - 1.0 + share, y}));
      }
    }
  }

  // Whether this is a pixel of the picture, and the lens has a ray for it.
  [[nodiscard]] bool IsSeen(int x, int y) const {
    return x >= 0 && y >= 0 && !(plane_.unseen_pixels() && plane_.unseen_pixels()->At(x, y));
  }

  [[nodiscard]] std::uint64_t ChangesAlong(const Words& bits, std::size_t word) const {
    const std::uint64_t next = word + 1 < bits.size() ? bits[word + 1] << 63U : 0;
    std::uint64_t changes = bits[word] ^ ((bits[word] >> 1U) | next);
    const std::size_t first_invalid = bits_ - 1;
    if (word * 64 + 64 > first_invalid) {
      const std::size_t keep = first_invalid > word * 64 ? first_invalid - word * 64 : 0;
      changes &= keep == 0 ? 0 : ~std::uint64_t{0} >> (64 - keep);
    }
    return changes;
  }

  std::uint32_t AddVertexDown(std::size_t i, int y, const LatticeRow& above, const LatticeRow& below) {
    const bool is_border = y < 0 || y + 1 == soft_.mask.height_px();
    const double share = is_border || soft_.levels.empty() ? 0.5 : Share(above.levels[i], below.levels[i]);
    return AddVertex({static_cast<double>(i) - 1.0, y + share});
  }

  void TraceCells(int y, const LatticeRow& above, const LatticeRow& below) {
    std::size_t next_above = 0, next_below = 0;
    std::uint32_t down = 0;  // the vertex on the cell's left side, if that changes
    for (std::size_t word = first_word_; word < end_word_; ++word) {
      const std::uint64_t top = above.changes[word], bottom = below.changes[word];
      const std::uint64_t differs = above.bits[word] ^ below.bits[word];
      const std::uint64_t carry =
          word + 1 < above.bits.size() ? (above.bits[word + 1] ^ below.bits[word + 1]) << 63U : 0;
      for (std::uint64_t left = top | bottom | differs | (differs >> 1U) | carry; left != 0;
           left &= left - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(left));
        const std::size_t i = word * 64 + bit;
        if (i + 1 >= bits_) break;
        Cell cell;
        if ((top >> bit) & 1U) cell.top = above.across[next_above++];
        if ((bottom >> bit) & 1U) cell.bottom = below.across[next_below++];
        cell.left = down;
        if (Bit(above.bits, i + 1) != Bit(below.bits, i + 1))
          cell.right = down = AddVertexDown(i + 1, y, above, below);
        AddEdges(Corners(above.bits, below.bits, i), cell);
      }
    }
  }

  static unsigned Corners(const Words& above, const Words& below, std::size_t i) {
    return (Bit(above, i) ? 1U : 0U) | (Bit(above, i + 1) ? 2U : 0U) | (Bit(below, i) ? 4U : 0U) |
           (Bit(below, i + 1) ? 8U : 0U);
  }

  struct Cell {
    std::uint32_t top = 0, bottom = 0, left = 0, right = 0;
  };

  // Corners: 1 top left, 2 top right, 4 bottom left, 8 bottom right. In the two saddles, 6 and 9, each
  // background corner is cut off by itself, so the object joins.
  void AddEdges(unsigned corners, const Cell& c) {
    switch (corners) {
      case 1:
        return Add(c.top, c.left);
      case 2:
        return Add(c.right, c.top);
      case 3:
        return Add(c.right, c.left);
      case 4:
        return Add(c.left, c.bottom);
      case 5:
        return Add(c.top, c.bottom);
      case 6:
        Add(c.left, c.top);
        return Add(c.right, c.bottom);
      case 7:
        return Add(c.right, c.bottom);
      case 8:
        return Add(c.bottom, c.right);
      case 9:
        Add(c.top, c.right);
        return Add(c.bottom, c.left);
      case 10:
        return Add(c.bottom, c.top);
      case 11:
        return Add(c.bottom, c.left);
      case 12:
        return Add(c.left, c.right);
      case 13:
        return Add(c.top, c.right);
      case 14:
        return Add(c.left, c.top);
      default:
        return;
    }
  }

  void Add(std::uint32_t from, std::uint32_t to) { contour_.edges.push_back({from, to}); }

  const core::SoftMask& soft_;
  const UndistortedPlane& plane_;
  const std::uint64_t exterior_;
  const core::BitMask boundary_;
  const std::size_t bits_;      // of a lattice row
  std::size_t first_word_ = 0;  // of a lattice row; and past the last
  std::size_t end_word_ = 0;
  std::size_t next_level_ = 0;
  std::vector<Eigen::Vector2d> pixels_;  // the vertices, in the picture
  Contour contour_;
};

// Pixels that the lens doesn't see take the exterior's label. If that changes the mask, the levels are
// dropped, since the new boundary wasn't measured.
core::SoftMask WithoutUnseen(const core::SoftMask& silhouette, bool exterior_is_object,
                             const core::BitMask& unseen) {
  core::SoftMask result{silhouette.mask, {}};
  for (std::size_t i = 0; i < unseen.words().size(); ++i) {
    std::uint64_t& word = result.mask.words()[i];
    word = exterior_is_object ? word | unseen.words()[i] : word & ~unseen.words()[i];
  }
  return result.mask == silhouette.mask ? silhouette : result;
}

}  // namespace

Contour TraceContour(const core::SoftMask& silhouette, bool exterior_is_object,
                     const UndistortedPlane& plane) {
  core::Require(silhouette.mask.width_px() == plane.camera().width_px() &&
                    silhouette.mask.height_px() == plane.camera().height_px(),
                "a silhouette has its camera's size");
  if (!plane.unseen_pixels()) return Tracer(silhouette, exterior_is_object, plane).Trace();
  return Tracer(WithoutUnseen(silhouette, exterior_is_object, *plane.unseen_pixels()), exterior_is_object,
                plane)
      .Trace();
}

bool IsObjectByParity(const Contour& contour, bool exterior_is_object, const Eigen::Vector2d& position) {
  bool is_object = exterior_is_object;
  for (const ContourEdge& edge : contour.edges) {
    const Eigen::Vector2d& a = contour.vertices[edge.from];
    const Eigen::Vector2d& b = contour.vertices[edge.to];
    if ((a.y() > position.y()) == (b.y() > position.y())) continue;
    const double x = a.x() + (position.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (x <= position.x()) is_object = !is_object;
  }
  return is_object;
}

Eigen::Vector2d SmoothTangent(const Contour& contour, std::uint32_t edge) {
  std::uint32_t from = contour.edges[edge].from, to = contour.edges[edge].to;
  for (int i = 0; i < kTangentReach; ++i) {
    from = contour.edges[contour.edge_to[from]].from;
    if (from == to) return Eigen::Vector2d::Zero();
    to = contour.edges[contour.edge_from[to]].to;
    if (from == to) return Eigen::Vector2d::Zero();
  }
  return contour.vertices[to] - contour.vertices[from];
}

Eigen::Vector3d OutwardNormalInCam(const Contour& contour, std::uint32_t edge, double focal_px) {
  const Eigen::Vector2d& from = contour.vertices[contour.edges[edge].from];
  const Eigen::Vector2d& to = contour.vertices[contour.edges[edge].to];
  Eigen::Vector2d tangent = SmoothTangent(contour, edge);
  if (tangent.isZero()) tangent = to - from;
  const Eigen::Vector2d middle = 0.5 * (from + to);
  // Object where cross(tangent, p - middle) > 0, that is where (middle, f) x (tangent, 0) . x > 0.
  const Eigen::Vector3d inward =
      Eigen::Vector3d(middle.x(), middle.y(), focal_px).cross(Eigen::Vector3d(tangent.x(), tangent.y(), 0.0));
  return -inward.normalized();
}

double DistanceToEdge(const Contour& contour, std::uint32_t edge, const Eigen::Vector2d& position) {
  const Eigen::Vector2d& from = contour.vertices[contour.edges[edge].from];
  const Eigen::Vector2d along = contour.vertices[contour.edges[edge].to] - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp(along.dot(position - from) / length2, 0.0, 1.0) : 0.0;
  return (position - from - share * along).norm();
}

}  // namespace elbowroom::recon
