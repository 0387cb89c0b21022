#include "core/gives_way.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/error.h"

namespace elbowroom::core {
namespace {

constexpr std::array<std::string_view, 6> kSides{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

struct Range {
  double least;
  double most;
};

void RequireWithin(const std::string& who, std::string_view key, double value, Range range) {
  if (value >= range.least && value <= range.most) return;
  throw Error(ErrorKind::kRange,
              fmt::format("{}: {} must be from {} to {}, not {}", who, key, range.least, range.most, value));
}

void RequireDirection(const std::string& who, std::string_view key, const Eigen::Vector3d& direction) {
  constexpr double kLeastLength = 1e-9;
  if (direction.allFinite() && direction.norm() >= kLeastLength) return;
  throw Error(ErrorKind::kRange, fmt::format("{}: {} needs a length; give a direction", who, key));
}

void Validate(const ClothRule& rule, const std::string& who) {
  RequireWithin(who, "stretch_stiffness_n_per_m", rule.stretch_stiffness_n_per_m, {1.0, 1e7});
  RequireWithin(who, "bending_stiffness_n_per_m", rule.bending_stiffness_n_per_m, {1e-3, 1e5});
  RequireWithin(who, "mass_per_area_kg_per_m2", rule.mass_per_area_kg_per_m2, {1e-3, 1e3});
  RequireWithin(who, "damping_per_s", rule.damping_per_s, {0.0, 100.0});
  RequireWithin(who, "friction", rule.friction, {0.0, 1.0});
  if (rule.pins.empty()) {
    throw Error(ErrorKind::kRange,
                who + ": a cloth without pins falls off the table; name a side, pins = [\"z_max\"]");
  }
}

void Validate(const PushRule& rule, const std::string& who) {
  RequireWithin(who, "max_speed_mm_per_s", rule.max_speed_mm_per_s, {1e-3, 1e4});
}

}  // namespace

std::optional<BoundsSide> ParseBoundsSide(std::string_view text) {
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    if (kSides[i] == text) return static_cast<BoundsSide>(i);
  }
  return std::nullopt;
}

std::string_view ToString(BoundsSide side) { return kSides[static_cast<std::size_t>(side)]; }

std::string_view ToString(const GivesWay& gives_way) {
  constexpr std::string_view kNames[] = {"none", "cloth", "pushed"};
  return kNames[gives_way.index()];
}

void ValidateGivesWay(const GivesWay& gives_way, const std::string& who) {
  if (const auto* cloth = std::get_if<ClothRule>(&gives_way)) Validate(*cloth, who);
  if (const auto* push = std::get_if<PushRule>(&gives_way)) Validate(*push, who);
}

void ValidateStream(const Stream& stream) {
  const std::string who = fmt::format("stream '{}'", stream.name);
  if (stream.name.empty())
    throw Error(ErrorKind::kRange, "a [[stream]] has no name; give each one a name of its own");
  if (!stream.position_mm.allFinite())
    throw Error(ErrorKind::kRange, who + ": position_mm must be finite numbers");
  RequireDirection(who, "direction", stream.direction);
  RequireWithin(who, "rate_per_s", stream.rate_per_s, {1e-3, 1e4});
  RequireWithin(who, "speed_mm_per_s", stream.speed_mm_per_s, {0.0, 5e3});
  RequireWithin(who, "radius_mm", stream.radius_mm, {0.1, 50.0});
}

}  // namespace elbowroom::core
