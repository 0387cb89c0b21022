#include "sessions/rig_quality_rows.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "sessions/database/damage.h"
#include "sessions/database/statement.h"
#include "sessions/packing.h"
#include "sessions/row_rules.h"

namespace elbowroom::sessions {
namespace {

static_assert(std::endian::native == std::endian::little, "a covariance is kept as the memory has it");

Bytes LowerTriangle(const Eigen::MatrixXd& matrix) {
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index column = 0; column <= row; ++column) numbers.push_back(matrix(row, column));
  Bytes bytes(numbers.size() * sizeof(double));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

// As many rows as the cameras have parameters: 4 and the distortion, 6 of the pose, 1 of time.
Eigen::Index ParametersOf(const core::Rig& rig) {
  std::size_t parameters = 0;
  for (const core::CameraModel& camera : rig.cameras)
    parameters += 11 + camera.calibration().distortion_coefficients.size();
  return static_cast<Eigen::Index>(parameters);
}

Eigen::MatrixXd CovarianceFrom(std::span<const std::byte> bytes, const core::Rig& rig,
                               const std::string& where) {
  const Eigen::Index size = ParametersOf(rig);
  std::vector<double> numbers(static_cast<std::size_t>(size * (size + 1) / 2));
  if (bytes.size() != numbers.size() * sizeof(double))
    FailAsDamaged(where, "the covariance isn't that of its cameras");
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  Eigen::MatrixXd covariance(size, size);
  auto number = numbers.begin();
  for (Eigen::Index row = 0; row < size; ++row) {
    for (Eigen::Index column = 0; column <= row; ++column, ++number) {
      if (!std::isfinite(*number)) FailAsDamaged(where, "the covariance has a number that isn't finite");
      covariance(row, column) = covariance(column, row) = *number;
    }
    if (covariance(row, row) < 0.0) FailAsDamaged(where, "the covariance has a negative variance");
  }
  return covariance;
}

core::RigGauge GaugeFrom(const Statement& row, const std::string& where) {
  core::RigGauge gauge;
  gauge.made = row.Text(2);
  gauge.true_diameter_mm = Magnitude(row.Real(3), where, "the gauge's diameter");
  gauge.diameter_mm = Magnitude(row.Real(4), where, "the gauge's diameter");
  gauge.error_mm = GapMm(row.Real(5), where, "the gauge's error");
  gauge.bound_mm = Magnitude(row.Real(6), where, "the gauge's bound");
  gauge.places = static_cast<int>(CountFrom(1, row.Integer(7), where, "the gauge's places"));
  gauge.passed = row.Integer(8) != 0;
  return gauge;
}

}  // namespace

void InsertRigQuality(Database& database, const core::RigQuality& quality) {
  if (!quality.errors && !quality.gauge) return;
  const Bytes covariance = quality.errors ? LowerTriangle(quality.errors->covariance) : Bytes();
  using Number = std::optional<double>;
  const auto& gauge = quality.gauge;
  Statement(database, "INSERT INTO rig_quality VALUES (1, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .With(quality.errors ? std::optional(std::span<const std::byte>(covariance)) : std::nullopt,
            quality.errors ? Number(quality.errors->boundary_sigma_px) : Number(),
            gauge ? std::optional<std::string_view>(gauge->made) : std::nullopt,
            gauge ? Number(gauge->true_diameter_mm) : Number(), gauge ? Number(gauge->diameter_mm) : Number(),
            gauge ? Number(gauge->error_mm) : Number(), gauge ? Number(gauge->bound_mm) : Number(),
            gauge ? std::optional(gauge->places) : std::nullopt,
            gauge ? std::optional(gauge->passed ? 1 : 0) : std::nullopt)
      .Run();
}

core::RigQuality ReadRigQuality(Database& database, const core::Rig& rig) {
  const std::string where = fmt::format("session '{}', the rig's quality", database.path().string());
  Statement row(database,
                "SELECT covariance, boundary_sigma_px, gauge_made, gauge_true_diameter_mm, "
                "gauge_diameter_mm, gauge_error_mm, gauge_bound_mm, gauge_places, gauge_passed "
                "FROM rig_quality");
  core::RigQuality quality;
  if (!row.Next()) return quality;
  if (!row.IsNull(0)) {
    quality.errors = core::RigErrors{CovarianceFrom(row.Bytes(0), rig, where),
                                     Magnitude(row.Real(1), where, "the error of a boundary")};
  }
  if (!row.IsNull(2)) quality.gauge = GaugeFrom(row, where);
  return quality;
}

}  // namespace elbowroom::sessions
