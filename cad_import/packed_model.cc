#include "cad_import/packed_model.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <Eigen/LU>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <type_traits>
#include <utility>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

static_assert(std::endian::native == std::endian::little, "packed models are little-endian");
static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double), "vertices are packed without gaps");

constexpr std::array<char, 8> kMagic = {'E', 'L', 'B', 'O', 'W', 'C', 'A', 'D'};
constexpr std::size_t kHeaderBytes = kMagic.size() + sizeof(std::uint32_t) + sizeof(std::uint64_t);
// The sizes of entries in which every list and text is empty.
constexpr std::size_t kLeastShapeBytes = 105, kLeastInstanceBytes = 125, kLeastPieceBytes = 24;
constexpr double kRigidTolerance = 1e-9;

class Writer {
 public:
  template <typename Value>
  requires std::is_arithmetic_v<Value>
  void Add(Value value) { AddBytes(&value, sizeof value); }
  void Add(const std::string& text) { AddArray(std::span(text)); }
  template <typename Value, std::size_t kExtent>
  void AddArray(std::span<Value, kExtent> values) {
    Add(static_cast<std::uint64_t>(values.size()));
    AddBytes(values.data(), values.size_bytes());
  }
  // Writes how many there are, then each.
  template <typename Values>
  void AddAll(const Values& values, auto add) {
    Add(static_cast<std::uint64_t>(values.size()));
    for (const auto& value : values) add(value);
  }
  void AddBytes(const void* from, std::size_t size) {
    const auto* bytes = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }
  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& where) : rest_(bytes), where_(where) {}

  [[noreturn]] void Fail(const std::string& what) const {
    throw core::Error(core::ErrorKind::kFormat, fmt::format("{}: {}; import it again", where_, what));
  }
  void Check(bool holds, const char* otherwise) const {
    if (!holds) Fail(otherwise);
  }
  template <typename Value>
  requires std::is_arithmetic_v<Value>
  [[nodiscard]] Value Take() {
    Value value;
    std::memcpy(&value, TakeBytes(sizeof value).data(), sizeof value);
    return value;
  }
  [[nodiscard]] double TakeFinite() {
    const auto value = Take<double>();
    Check(std::isfinite(value), "a figure isn't finite");
    return value;
  }
  [[nodiscard]] std::int64_t TakeCount() {
    const auto value = Take<std::int64_t>();
    Check(value >= 0, "a count is negative");
    return value;
  }
  [[nodiscard]] bool TakeFlag() {
    const auto value = Take<std::uint8_t>();
    Check(value <= 1, "a flag is neither set nor clear");
    return value == 1;
  }
  // A count of things that take at least so many bytes each: a false count can't ask for memory.
  [[nodiscard]] std::size_t TakeSize(std::size_t bytes_each) {
    const auto size = Take<std::uint64_t>();
    Check(size <= rest_.size() / bytes_each, "it is cut off");
    return static_cast<std::size_t>(size);
  }
  template <typename Value>
  [[nodiscard]] std::vector<Value> TakeArray() {
    std::vector<Value> values(TakeSize(sizeof(Value)));
    const std::span<const std::byte> from = TakeBytes(values.size() * sizeof(Value));
    if (!from.empty()) std::memcpy(static_cast<void*>(values.data()), from.data(), from.size());
    return values;
  }
  [[nodiscard]] std::string TakeText() {
    const std::size_t size = TakeSize(1);
    const std::span<const std::byte> from = TakeBytes(size);
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  void CheckEnd() const { Check(rest_.empty(), "it holds more than belongs there"); }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  std::span<const std::byte> TakeBytes(std::size_t size) {
    Check(size <= rest_.size(), "it is cut off");
    const std::span<const std::byte> taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  std::span<const std::byte> rest_;
  const std::string& where_;
};

void Add(Writer& writer, const SurfaceReport& surface) {
  writer.Add(static_cast<std::uint8_t>(surface.watertight));
  for (const std::int64_t count : {surface.dropped_flat, surface.kept_flat, surface.dropped_duplicates,
                                   surface.turned, surface.open_edges, surface.non_manifold_edges,
                                   surface.inconsistent_edges, surface.self_intersections.value_or(0)}) {
    writer.Add(count);
  }
  writer.Add(static_cast<std::uint8_t>(surface.self_intersections.has_value()));
}

SurfaceReport TakeSurface(Reader& reader) {
  SurfaceReport surface;
  surface.watertight = reader.TakeFlag();
  for (std::int64_t* count :
       {&surface.dropped_flat, &surface.kept_flat, &surface.dropped_duplicates, &surface.turned,
        &surface.open_edges, &surface.non_manifold_edges, &surface.inconsistent_edges}) {
    *count = reader.TakeCount();
  }
  const std::int64_t self_intersections = reader.TakeCount();
  surface.self_intersections = reader.TakeFlag() ? std::optional(self_intersections) : std::nullopt;
  return surface;
}

void Add(Writer& writer, const CadShape& shape) {
  writer.Add(shape.name);
  writer.AddArray(std::span(shape.mesh->vertices_mm));
  writer.AddArray(std::span(shape.mesh->triangles));
  writer.Add(shape.mesh->deviation_mm);
  writer.AddAll(shape.pieces, [&](const ImportedPart& piece) {
    writer.Add(piece.name);
    writer.Add(piece.first_triangle);
    writer.Add(piece.triangles);
  });
  Add(writer, shape.surface);
}

std::vector<ImportedPart> TakePieces(Reader& reader, std::int64_t triangles) {
  std::vector<ImportedPart> pieces(reader.TakeSize(kLeastPieceBytes));
  std::int64_t next = 0;
  for (ImportedPart& piece : pieces) {
    piece.name = reader.TakeText();
    piece.first_triangle = reader.TakeCount();
    piece.triangles = reader.TakeCount();
    reader.Check(piece.first_triangle == next && piece.triangles <= triangles - next,
                 "pieces don't cover their triangles");
    next += piece.triangles;
  }
  reader.Check(next == triangles && !pieces.empty(), "pieces don't cover their triangles");
  return pieces;
}

CadShape TakeShape(Reader& reader) {
  CadShape shape;
  shape.name = reader.TakeText();
  core::TriangleMesh mesh;
  mesh.vertices_mm = reader.TakeArray<Eigen::Vector3d>();
  mesh.triangles = reader.TakeArray<std::array<std::int32_t, 3>>();
  mesh.deviation_mm = reader.TakeFinite();
  core::ValidateMesh(mesh, reader.where());
  shape.mesh = std::make_shared<const core::TriangleMesh>(std::move(mesh));
  shape.pieces = TakePieces(reader, static_cast<std::int64_t>(shape.mesh->triangles.size()));
  shape.surface = TakeSurface(reader);
  return shape;
}

void Add(Writer& writer, const CadInstance& instance) {
  writer.Add(instance.path);
  writer.Add(static_cast<std::uint64_t>(instance.shape));
  for (const double number : instance.model_from_shape.rotation.reshaped()) writer.Add(number);
  for (const double number : instance.model_from_shape.translation_mm) writer.Add(number);
  writer.Add(static_cast<std::uint8_t>(instance.color.has_value()));
  for (const float channel : instance.color.value_or(ColorRgb{})) writer.Add(channel);
}

CadInstance TakeInstance(Reader& reader, std::size_t shapes) {
  CadInstance instance;
  instance.path = reader.TakeText();
  instance.shape = static_cast<std::size_t>(reader.Take<std::uint64_t>());
  reader.Check(instance.shape < shapes, "an instance names no shape");
  Eigen::Matrix3d& rotation = instance.model_from_shape.rotation;
  for (double& number : rotation.reshaped()) number = reader.TakeFinite();
  for (double& number : instance.model_from_shape.translation_mm) number = reader.TakeFinite();
  reader.Check((rotation.transpose() * rotation).isIdentity(kRigidTolerance) && rotation.determinant() > 0.0,
               "an instance isn't a rigid motion");
  const bool has_color = reader.TakeFlag();
  ColorRgb color{};
  for (float& channel : color) {
    channel = reader.Take<float>();
    reader.Check(channel >= 0.0F && channel <= 1.0F, "a colour is out of range");
  }
  if (has_color) instance.color = color;
  return instance;
}

void Add(Writer& writer, const ImportReport& report) {
  writer.Add(report.parts);
  writer.Add(report.triangles);
  writer.Add(report.unit);
  writer.Add(static_cast<std::uint8_t>(report.is_unit_stated));
  for (const double number : report.bounds_mm.min()) writer.Add(number);
  for (const double number : report.bounds_mm.max()) writer.Add(number);
  writer.Add(static_cast<std::uint8_t>(report.watertight));
  writer.Add(static_cast<std::uint8_t>(report.repaired));
  writer.Add(report.dropped_triangles);
  writer.Add(report.deviation_mm);
  writer.AddAll(report.warnings, [&](const std::string& warning) { writer.Add(warning); });
}

ImportReport TakeReport(Reader& reader) {
  ImportReport report;
  report.parts = reader.TakeCount();
  report.triangles = reader.TakeCount();
  report.unit = reader.TakeText();
  report.is_unit_stated = reader.TakeFlag();
  for (double& number : report.bounds_mm.min()) number = reader.TakeFinite();
  for (double& number : report.bounds_mm.max()) number = reader.TakeFinite();
  reader.Check(!report.bounds_mm.isEmpty(), "its bounds are empty");
  report.watertight = reader.TakeFlag();
  report.repaired = reader.TakeFlag();
  report.dropped_triangles = reader.TakeCount();
  report.deviation_mm = reader.TakeFinite();
  report.warnings.resize(reader.TakeSize(sizeof(std::uint64_t)));
  for (std::string& warning : report.warnings) warning = reader.TakeText();
  return report;
}

// Compares the model with the counts of its report.
void CheckCounts(const Reader& reader, const CadModel& model) {
  std::int64_t parts = 0, triangles = 0;
  for (const CadInstance& instance : model.instances) {
    const CadShape& shape = model.shapes[instance.shape];
    parts += static_cast<std::int64_t>(shape.pieces.size());
    triangles += static_cast<std::int64_t>(shape.mesh->triangles.size());
  }
  reader.Check(parts == model.report.parts && triangles == model.report.triangles && parts > 0,
               "its report counts other parts than it holds");
}

std::string ToText(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string HashOf(std::span<const std::byte> bytes) {
  return ToText(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string HashOfFile(const std::filesystem::path& file) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  XXH3_128bits_reset(state.get());
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> chunk(std::size_t{1} << 20U);
  while (stream) {
    stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    XXH3_128bits_update(state.get(), chunk.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("{}: can't be read; check the path and its permissions", file.string()));
  }
  return ToText(XXH3_128bits_digest(state.get()));
}

std::uint64_t ChecksumOf(std::span<const std::byte> payload) {
  return XXH3_64bits(payload.data(), payload.size());
}

std::vector<std::byte> Pack(const CadModel& model, std::span<const ReferredFile> referred) {
  Writer writer;
  writer.AddBytes(kMagic.data(), kMagic.size());
  writer.Add(kPackedModelVersion);
  writer.Add(std::uint64_t{0});  // the checksum's place
  writer.AddAll(model.shapes, [&](const CadShape& shape) { Add(writer, shape); });
  writer.AddAll(model.instances, [&](const CadInstance& instance) { Add(writer, instance); });
  Add(writer, model.report);
  writer.AddAll(referred, [&](const ReferredFile& file) {
    writer.Add(file.path);
    writer.Add(file.hash);
  });
  std::vector<std::byte>& bytes = writer.bytes();
  const std::uint64_t checksum = ChecksumOf(std::span(bytes).subspan(kHeaderBytes));
  std::memcpy(bytes.data() + kHeaderBytes - sizeof checksum, &checksum, sizeof checksum);
  return std::move(bytes);
}

PackedModel Unpack(std::span<const std::byte> bytes, const std::string& where) {
  Reader reader(bytes, where);
  for (const char letter : kMagic) reader.Check(reader.Take<char>() == letter, "it is no packed model");
  reader.Check(reader.Take<std::uint32_t>() == kPackedModelVersion, "it is of another version");
  const auto checksum = reader.Take<std::uint64_t>();
  reader.Check(checksum == ChecksumOf(reader.rest()), "it doesn't match its checksum");
  PackedModel packed;
  CadModel& model = packed.model;
  model.shapes.resize(reader.TakeSize(kLeastShapeBytes));
  for (CadShape& shape : model.shapes) shape = TakeShape(reader);
  model.instances.resize(reader.TakeSize(kLeastInstanceBytes));
  for (CadInstance& instance : model.instances) instance = TakeInstance(reader, model.shapes.size());
  model.report = TakeReport(reader);
  packed.referred.resize(reader.TakeSize(2 * sizeof(std::uint64_t)));
  for (ReferredFile& file : packed.referred) file = {reader.TakeText(), reader.TakeText()};
  reader.CheckEnd();
  CheckCounts(reader, model);
  return packed;
}

}  // namespace elbowroom::cad_import
