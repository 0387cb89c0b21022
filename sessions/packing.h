// Meshes, masks and matrices in the form in which a session file keeps them: exact to the last bit.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/soft_mask.h"
#include "core/triangle_mesh.h"

struct ZSTD_CCtx_s;

namespace elbowroom::sessions {

using Bytes = std::vector<std::byte>;

// Zstandard with a context that is kept from call to call. Thread: one.
class Compressor {
 public:
  Compressor();
  [[nodiscard]] Bytes Compress(std::span<const std::byte> bytes);

 private:
  std::shared_ptr<ZSTD_CCtx_s> context_;
};

// Whether packed bytes may unpack to so many: always up to 64 MiB, above that at 1024 : 1 at most. Large
// meshes pack 2 : 1, large masks 30 : 1, a decompression bomb 30,000 : 1.
[[nodiscard]] bool IsPlausible(std::size_t packed_bytes, std::size_t unpacked_bytes);

// Throws: Error{kFormat} naming `where` unless `packed` unpacks to exactly `size` bytes, and IsPlausible().
[[nodiscard]] Bytes Decompress(std::span<const std::byte> packed, std::size_t size, const std::string& where);

struct PackedMesh {
  Bytes vertices_mm_zstd;
  Bytes triangles_zstd;
};
[[nodiscard]] PackedMesh Pack(const core::TriangleMesh& mesh, Compressor& compressor);
// Throws: Error{kFormat} naming `where` unless sizes and indices are right.
[[nodiscard]] core::TriangleMesh UnpackMesh(std::span<const std::byte> vertices_mm_zstd,
                                            std::size_t vertex_count,
                                            std::span<const std::byte> triangles_zstd,
                                            std::size_t triangle_count, const std::string& where);

using MaskHash = std::array<std::byte, 16>;
[[nodiscard]] MaskHash HashOf(const core::SoftMask& mask);  // 128-bit XXH3 of size, pixels, levels if any
struct PackedMask {
  Bytes words_zstd;
  std::optional<Bytes> levels_zstd;  // nothing: the mask has none
};
[[nodiscard]] PackedMask Pack(const core::SoftMask& mask, Compressor& compressor);
// Throws: Error{kFormat} naming `where` unless it unpacks to that size and hash, and its levels fit its
// pixels.
[[nodiscard]] core::SoftMask UnpackMask(std::span<const std::byte> words_zstd,
                                        std::optional<std::span<const std::byte>> levels_zstd, int width_px,
                                        int height_px, std::span<const std::byte> content_hash,
                                        const std::string& where);

[[nodiscard]] Bytes Pack(std::span<const float> numbers, Compressor& compressor);
// Throws: Error{kFormat} naming `where` unless it unpacks to that many.
[[nodiscard]] std::vector<float> UnpackFloats(std::span<const std::byte> packed, std::size_t count,
                                              const std::string& where);

// JSON arrays. A double is written in the fewest digits that read back as the same double; a matrix is
// written row by row.
[[nodiscard]] std::string JsonFrom(std::span<const std::string> texts);
[[nodiscard]] std::string JsonFrom(std::span<const double> numbers);
[[nodiscard]] std::string JsonFrom(const Eigen::Vector3d& vector);
[[nodiscard]] std::string JsonFrom(const Eigen::Matrix3d& matrix);
// Throws: Error{kFormat} naming `where`.
[[nodiscard]] std::vector<std::string> TextsFromJson(const std::string& json, const std::string& where);
[[nodiscard]] std::vector<double> NumbersFromJson(const std::string& json, const std::string& where);
[[nodiscard]] Eigen::Vector3d VectorFromJson(const std::string& json, const std::string& where);
[[nodiscard]] Eigen::Matrix3d MatrixFromJson(const std::string& json, const std::string& where);

}  // namespace elbowroom::sessions
