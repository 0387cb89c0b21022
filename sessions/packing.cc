#include "sessions/packing.h"

#include <fmt/format.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "sessions/database/damage.h"

namespace elbowroom::sessions {
namespace {

using core::Error;

static_assert(std::endian::native == std::endian::little,
              "session files are little-endian, as is every machine in use");
static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double), "vertices are packed without gaps");

// Fast enough for the writer thread; silhouettes pack about 30 : 1 at any level.
constexpr int kCompressionLevel = 1;

// Beyond any mesh that can be imported.
constexpr std::size_t kLargestUnpacked = std::size_t{1} << 32U;

// Called before anything is allocated: a damaged size must not take all memory.
void RequireUnpacksTo(std::span<const std::byte> packed, std::size_t size, const std::string& where) {
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != size)
    FailAsDamaged(where, "the packed data has another size than belongs there");
  if (size > kLargestUnpacked || !IsPlausible(packed.size(), size))
    FailAsDamaged(where, fmt::format("the packed data claims {} bytes", size));
}

void DecompressInto(std::span<const std::byte> packed, std::span<std::byte> bytes, const std::string& where) {
  RequireUnpacksTo(packed, bytes.size(), where);
  const std::size_t unpacked = ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  if (ZSTD_isError(unpacked) != 0U) FailAsDamaged(where, ZSTD_getErrorName(unpacked));
  if (unpacked != bytes.size()) FailAsDamaged(where, "the packed data is shorter than it claims");
}

template <typename Value>
std::vector<Value> DecompressAs(std::span<const std::byte> packed, std::size_t count,
                                const std::string& where) {
  if (count > kLargestUnpacked / sizeof(Value))
    FailAsDamaged(where, fmt::format("it claims {} values", count));
  RequireUnpacksTo(packed, count * sizeof(Value), where);
  std::vector<Value> values(count);
  DecompressInto(packed, std::as_writable_bytes(std::span(values)), where);
  return values;
}

void RequireEmptyPadding(const core::BitMask& mask, const std::string& where) {
  const unsigned used = static_cast<unsigned>(mask.width_px()) % 64U;
  if (used == 0) return;
  for (std::size_t i = mask.words_per_row() - 1; i < mask.words().size(); i += mask.words_per_row())
    if (mask.words()[i] >> used != 0) FailAsDamaged(where, "it has pixels beyond its picture");
}

std::vector<double> CountedNumbersFromJson(const std::string& json, std::size_t count,
                                           const std::string& where) {
  std::vector<double> numbers = NumbersFromJson(json, where);
  if (numbers.size() != count)
    FailAsDamaged(where, fmt::format("{} numbers where {} belong", numbers.size(), count));
  return numbers;
}

template <typename Value>
std::vector<Value> ArrayFromJson(const std::string& json, const std::string& where) {
  try {
    return nlohmann::json::parse(json).get<std::vector<Value>>();
  } catch (const nlohmann::json::exception& exception) {
    FailAsDamaged(where, Quotable(exception.what()));
  }
}

}  // namespace

bool IsPlausible(std::size_t packed_bytes, std::size_t unpacked_bytes) {
  constexpr std::size_t kAlways = std::size_t{64} << 20U, kMostPerByte = 1024;
  return unpacked_bytes <= kAlways || unpacked_bytes / kMostPerByte <= packed_bytes;
}

Compressor::Compressor() : context_(ZSTD_createCCtx(), ZSTD_freeCCtx) {}

Bytes Compressor::Compress(std::span<const std::byte> bytes) {
  Bytes packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compressCCtx(context_.get(), packed.data(), packed.size(), bytes.data(),
                                             bytes.size(), kCompressionLevel);
  core::Require(ZSTD_isError(size) == 0U, "a buffer of the compressor's own bound is large enough");
  packed.resize(size);
  return packed;
}

Bytes Decompress(std::span<const std::byte> packed, std::size_t size, const std::string& where) {
  RequireUnpacksTo(packed, size, where);
  Bytes bytes(size);
  DecompressInto(packed, bytes, where);
  return bytes;
}

PackedMesh Pack(const core::TriangleMesh& mesh, Compressor& compressor) {
  return {compressor.Compress(std::as_bytes(std::span(mesh.vertices_mm))),
          compressor.Compress(std::as_bytes(std::span(mesh.triangles)))};
}

core::TriangleMesh UnpackMesh(std::span<const std::byte> vertices_mm_zstd, std::size_t vertex_count,
                              std::span<const std::byte> triangles_zstd, std::size_t triangle_count,
                              const std::string& where) {
  core::TriangleMesh mesh;
  mesh.vertices_mm = DecompressAs<Eigen::Vector3d>(vertices_mm_zstd, vertex_count, where);
  mesh.triangles = DecompressAs<std::array<std::int32_t, 3>>(triangles_zstd, triangle_count, where);
  try {
    core::ValidateMesh(mesh, where);
  } catch (const Error& error) {
    FailAsDamaged(where, "its mesh is none: an index or a vertex is out of range");
  }
  return mesh;
}

MaskHash HashOf(const core::SoftMask& mask) {
  const auto size = static_cast<XXH64_hash_t>(mask.mask.width_px()) << 32U |
                    static_cast<XXH64_hash_t>(mask.mask.height_px());
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  XXH3_128bits_reset_withSeed(state.get(), size);
  const std::span<const std::uint64_t> words = mask.mask.words();
  XXH3_128bits_update(state.get(), words.data(), words.size_bytes());
  XXH3_128bits_update(state.get(), mask.levels.data(), mask.levels.size());
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state.get()));
  return std::bit_cast<MaskHash>(canonical);
}

PackedMask Pack(const core::SoftMask& mask, Compressor& compressor) {
  PackedMask packed{compressor.Compress(std::as_bytes(mask.mask.words())), std::nullopt};
  if (!mask.levels.empty()) packed.levels_zstd = compressor.Compress(std::as_bytes(std::span(mask.levels)));
  return packed;
}

core::SoftMask UnpackMask(std::span<const std::byte> words_zstd,
                          std::optional<std::span<const std::byte>> levels_zstd, int width_px, int height_px,
                          std::span<const std::byte> content_hash, const std::string& where) {
  const auto words_per_row = (static_cast<std::size_t>(width_px) + 63U) / 64U;
  RequireUnpacksTo(words_zstd, words_per_row * static_cast<std::size_t>(height_px) * 8U, where);
  core::SoftMask soft{core::BitMask(width_px, height_px), {}};
  DecompressInto(words_zstd, std::as_writable_bytes(soft.mask.words()), where);
  RequireEmptyPadding(soft.mask, where);
  if (levels_zstd) {
    const std::size_t boundary_px = core::BoundaryPixels(soft.mask).CountObjectPixels();
    soft.levels = DecompressAs<std::uint8_t>(*levels_zstd, boundary_px, where + ", levels of its boundary");
  }
  if (!std::ranges::equal(HashOf(soft), content_hash))
    FailAsDamaged(where, "its pixels and levels don't match their checksum");
  if (const auto rule = soft.BrokenRule()) FailAsDamaged(where, fmt::format("wrong levels: {}", *rule));
  return soft;
}

Bytes Pack(std::span<const float> numbers, Compressor& compressor) {
  return compressor.Compress(std::as_bytes(numbers));
}

std::vector<float> UnpackFloats(std::span<const std::byte> packed, std::size_t count,
                                const std::string& where) {
  return DecompressAs<float>(packed, count, where);
}

std::string JsonFrom(std::span<const std::string> texts) {
  return nlohmann::json(std::vector<std::string>(texts.begin(), texts.end())).dump();
}
std::string JsonFrom(std::span<const double> numbers) {
  return nlohmann::json(std::vector<double>(numbers.begin(), numbers.end())).dump();
}
std::string JsonFrom(const Eigen::Vector3d& vector) { return JsonFrom(std::span(vector.data(), 3)); }
std::string JsonFrom(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_row = matrix;
  return JsonFrom(std::span(by_row.data(), 9));
}

std::vector<std::string> TextsFromJson(const std::string& json, const std::string& where) {
  return ArrayFromJson<std::string>(json, where);
}
std::vector<double> NumbersFromJson(const std::string& json, const std::string& where) {
  return ArrayFromJson<double>(json, where);
}
Eigen::Vector3d VectorFromJson(const std::string& json, const std::string& where) {
  return Eigen::Vector3d(CountedNumbersFromJson(json, 3, where).data());
}
Eigen::Matrix3d MatrixFromJson(const std::string& json, const std::string& where) {
  const std::vector<double> by_row = CountedNumbersFromJson(json, 9, where);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(by_row.data());
}

}  // namespace elbowroom::sessions
